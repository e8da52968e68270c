"""Programs whose time is that of a material or of one technique, for `gpu_cost.measure`.

    ball = surface_points(scene.load("ball.toml"), (1920, 1080))
    program = of_technique("lobe_exp2", ball)

A full-screen pass reads the surface's points from three float textures, a place a pixel, and computes there what the
fragment stage of the emitted shader computes; its floor reads the same and adds it up. Where one evaluation is too
little to be seen beside the reading, each pixel has several, at places moved a little, so that none can be left out.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..compiler import compile, transpile
from ..diagnostics import failure
from ..harness import probes, render, samples
from ..harness.backends import Array
from ..harness.scenes.camera import Camera
from ..harness.scenes.geometry import Ball
from ..harness.scenes.scene import Scene
from ..harness.shell import drawing
from ..ir.types import Sampler
from ..material import Material, load_material
from .gpu_cost import Program

EYE, LIGHT = (0.0, 0.0, 1.8), (2.5, 1.0, 0.3)
"""Where the eye and the light of a single technique are: half of what is seen of a ball at the origin is lit."""


class Points(NamedTuple):
    """What a fragment stage is given at each pixel, as (height, width, 4) float32."""

    place: Array
    """Position in world space (or the ray, where a material makes its own geometry), and u."""
    normal: Array
    """Normal, and v."""
    tangent: Array
    """Tangent with its handedness."""


_VARYINGS = {
    "v_position": ("vec3", "timing_place.xyz + moved"),
    "v_ray": ("vec3", "timing_place.xyz + moved"),
    "v_normal": ("vec3", "timing_normal.xyz + moved"),
    "v_tangent": ("vec4", "timing_tangent + vec4(vec3(moved), 0.0)"),
    "v_uv": ("vec2", "vec2(timing_place.w, timing_normal.w) + moved"),
}
"""What emitted fragment stages read: its type, and what it is in a pass over points."""

_GIVEN = {
    "P": ("v_position", ("v_position",)),
    "p": ("v_position", ("v_position",)),
    "uv": ("v_uv", ("v_uv",)),
    "N": ("normalize(v_normal)", ("v_normal",)),
    "V": ("normalize(timing_eye - v_position)", ("v_position",)),
    "L": ("normalize(timing_light - v_position)", ("v_position",)),
    "T": ("v_tangent.xyz", ("v_tangent",)),
    "B": ("cross(v_normal, v_tangent.xyz)", ("v_normal", "v_tangent")),
    "time": ("timing_time", ()),
    "ray_origin": ("timing_eye", ()),
    "ray_direction": ("normalize(v_position - timing_eye)", ("v_position",)),
}
"""A technique's input by its name, without its space: what it is, and the varyings that it is made of."""

_AMOUNTS = {
    "float": "fract(dot(v_uv, vec2(3.0, 5.0)))",
    "vec2": "fract(v_uv * 3.0)",
    "vec3": "fract(vec3(v_uv, 0.5) * 3.0)",
    "vec4": "fract(v_uv.xyxy * 3.0)",
    "int": "int(v_uv.x * 8.0)",
    "uint": "uint(v_uv.x * 8.0)",
    "bool": "v_uv.x > 0.5",
}
"""Any other input, by its type: it varies over the picture."""

_AS_VEC4 = {"float": "vec4({})", "bool": "vec4(float({}))", "int": "vec4(float({}))", "uint": "vec4(float({}))"}
_AS_VEC4 |= {"vec2": "vec4({}, 0.0, 0.0)", "vec3": "vec4({}, 0.0)", "vec4": "{}"}


@lru_cache(4)
def ball_points(size: tuple[int, int]) -> Points:
    """A ball that fills the picture."""
    found = _seen(Ball(), Camera(EYE, field_of_view=30.0), size)
    assert found is not None
    return found


def surface_points(scene: Scene, size: tuple[int, int]) -> Points:
    """The points of a scene's surface, those that its camera sees stretched until they fill the picture.

    Of a scene without geometry, the rays. Raises SssgenError where the camera sees nothing.
    """
    if scene.geometry is None:
        return _rays(scene.camera, size)
    found = _seen(scene.geometry, scene.camera, size)
    if found is None:
        raise failure("the camera sees nothing of the scene's geometry", file=scene.document.reporter.file)
    return found


def _rays(camera: Camera, size: tuple[int, int]) -> Points:
    width, height = size
    v, u = (np.mgrid[0:height, 0:width] + 0.5) / np.array([height, width])[:, None, None]
    rays = camera.rays(*size)[1].reshape(height, width, 3)
    return _points(rays, np.zeros((height, width, 3)), np.zeros((height, width, 4)), np.stack([u, v], axis=-1))


def _seen(geometry: object, camera: Camera, size: tuple[int, int]) -> Points | None:
    """The rows of what is hit, one after the other, each drawn out to the whole width."""
    width, height = size
    origin, directions = camera.rays(*size)
    hits = geometry.hits(origin, directions)  # type: ignore[attr-defined]  # every geometry has it
    hit = hits.hit.reshape(height, width)
    rows = np.flatnonzero(hit.any(axis=1))
    if not len(rows):
        return None
    index = np.empty((height, width), np.int64)
    for y in range(height):
        row = rows[y * len(rows) // height]
        columns = np.flatnonzero(hit[row])
        index[y] = row * width + columns[np.arange(width) * len(columns) // width]
    return _points(hits.position[index], hits.normal[index], hits.tangent[index], hits.uv[index])


def _points(place: Array, normal: Array, tangent: Array, uv: Array) -> Points:
    parts = np.concatenate([place, uv[..., :1]], axis=-1), np.concatenate([normal, uv[..., 1:]], axis=-1), tangent
    return Points(*(np.ascontiguousarray(part, np.float32) for part in parts))


def of_material(
    name: str, material: Material | str, scene: Scene, points: Points, evaluations: int = 1, guards: str = "auto"
) -> Program:
    """The fragment stage of a material's emitted shader (glsl-330), lit as in a scene, at points of its surface.

    The text is the emitted one; only its varyings are variables and its `main` a function. Parameters are uniforms
    with the scene's values. Raises SssgenError for a scene that does not fit the material.
    """
    material = material if isinstance(material, Material) else load_material(material)
    compiled = compile(material, "glsl-330", guards=guards)
    height, width = points.place.shape[:2]
    drawn = drawing(compiled, render._shell(scene, material, compiled.reflection), (width, height), None, None)
    text = drawn.fragment.text.text
    varyings = [varying for varying in _VARYINGS if re.search(rf"^in \w+ {varying};$", text, re.MULTILINE)]
    text = re.sub(r"^(?:in|out) (\w+ (?:v_\w+|fragment_color);)$", r"\1", text, flags=re.MULTILINE)
    text = re.sub(r"^void main\(\)", "void shade()", text, flags=re.MULTILINE)
    text = text.replace("discard;", "return;")  # a pass that ends early would be timed shorter
    textures = {name: bound.data for name, bound in drawn.textures.items()}
    read = _sum((_VARYINGS[varying][0], varying) for varying in varyings)
    floor = f"#version 330 core\n{_declared(varyings)}void shade() {{\n    fragment_color = {read};\n}}\n"
    uniforms = {**drawn.values, "timing_evaluations": evaluations}
    main = _main(varyings)
    return Program(name, text + main, uniforms, {**textures, **_bound(points)}, floor + main, evaluations)


def of_technique(
    name: str,
    points: Points,
    bind: Mapping[str, str] | None = None,
    evaluations: int = 1,
    guards: str = "auto",
    text: str = "",
) -> Program:
    """One technique (as `sssgen eval` takes it, with functions bound to its slots) at points of a surface.

    Its uniforms have their defaults; whole numbers among them, which are counts, are constants, as materials fix them.
    Textures are those of `samples`. With `text`, GLSL that has a function of the technique's name with its inputs,
    that is timed instead: `text` declares the uniforms that it reads. Raises SssgenError.
    """
    subject = probes.subject(name, bind)
    title = subject.probes[0].function.partition("_shows_")[0]
    label = title
    if text:
        label = f"{title} by hand"
    else:
        compiled = transpile(subject.module, "glsl-330", "timed", guards, subject.called, chained=subject.chained)
        text = next(iter(compiled.files.values()))
    uniforms = {key: one for key, one in subject.uniforms.items() if not isinstance(one.type, Sampler)}
    declarations, calls, varyings = [], [], set[str]()
    inputs: list[tuple[str, str, str]] = []
    outputs = []
    result, params = _signature(text, title)
    for direction, type_, param in params:
        if param in subject.uniforms:
            whole = type_ in ("int", "uint")
            value = f" = {type_}({uniforms[param].default[0]})" if whole else ""
            declarations.append(f"{'const' if whole else 'uniform'} {type_} timing_{param}{value};")
            calls.append(f"timing_{param}")
            continue
        given, read = _given(param, type_)
        varyings |= set(read)
        inputs.append((type_, param, "" if direction == "out" else f" = {given}"))
        calls.append(param)
        if direction != "in":
            outputs.append((type_, param))
    shown = [varying for varying in _VARYINGS if varying in varyings]
    prologue = "".join(f"    {type_} {param}{given};\n" for type_, param, given in inputs)
    call = f"{title}({', '.join(calls)})"
    if result == "void":
        prologue_and_call = f"{prologue}    {call};\n"
    else:
        prologue_and_call, outputs = f"{prologue}    {result} timing_result = {call};\n", [
            (result, "timing_result"), *outputs,
        ]  # fmt: skip
    shared = "uniform vec3 timing_eye;\nuniform vec3 timing_light;\nuniform float timing_time;\n" + _declared(shown)
    body = "\n".join([*declarations, f"{shared}void shade() {{\n{prologue_and_call}"])
    body += f"    fragment_color = {_sum(outputs)};\n}}\n"
    read_only = _sum((type_, param) for type_, param, given in inputs if given)
    floor = f"{shared}void shade() {{\n{prologue}    fragment_color = {read_only};\n}}\n"
    values = {key: np.array(one.default, np.float64) for key, one in uniforms.items()}
    values |= {f"timing_{key}": value for key, value in values.items()}
    values |= {"timing_eye": EYE, "timing_light": LIGHT, "timing_time": 1.5, "timing_evaluations": evaluations}
    main, head = _main(shown), "#version 330 core\n"
    textures = _textures(subject)
    return Program(
        label, f"{head}{text}{body}{main}", values, {**textures, **_bound(points)}, f"{head}{floor}{main}", evaluations
    )


def _textures(subject: probes.Subject) -> dict[str, Array]:
    found = {}
    for key, one in subject.uniforms.items():
        if isinstance(one.type, Sampler):
            made = samples.texture(one.type.dim, np.random.default_rng(1))
            found |= {key: made, f"timing_{key}": made}
    return found


def _signature(text: str, function: str) -> tuple[str, list[tuple[str, str, str]]]:
    """What a function of a text returns, and its parameters: direction, type, name."""
    match = re.search(rf"^(\w+) {function}\(([^)]*)\)\s*\{{", text, re.MULTILINE)
    if match is None:
        raise failure(f"the text has no function '{function}'", "give it the technique's name")
    words = [param.split() for param in match[2].split(",") if param.strip()]
    return match[1], [(word[0] if len(word) == 3 else "in", word[-2], word[-1]) for word in words]


def _given(param: str, type_: str) -> tuple[str, Sequence[str]]:
    name = param.removesuffix("_object")
    if name in _GIVEN:
        return _GIVEN[name]
    if type_ not in _AMOUNTS:
        raise failure(f"an input of type {type_} has no values to be timed with: '{param}'")
    return _AMOUNTS[type_], ("v_uv",)


def _sum(values: object) -> str:
    terms = [_AS_VEC4[type_].format(name) for type_, name in values]  # type: ignore[attr-defined]
    return " + ".join(terms) or "vec4(0.0)"


def _declared(varyings: Sequence[str]) -> str:
    lines = [f"{_VARYINGS[varying][0]} {varying};\n" for varying in varyings]
    return "".join([*lines, "vec4 fragment_color;\n"])


_SOURCES = {"timing_place": "timing_places", "timing_normal": "timing_normals", "timing_tangent": "timing_tangents"}


def _main(varyings: Sequence[str]) -> str:
    """The pass: it reads a point, and shades it and its neighbours."""
    moves = [f"        {varying} = {_VARYINGS[varying][1]};\n" for varying in varyings]
    used = [local for local in _SOURCES if any(local in move for move in moves)]
    samplers = "".join(f"uniform sampler2D {_SOURCES[local]};\n" for local in used)
    reads = "".join(f"    vec4 {local} = texelFetch({_SOURCES[local]}, at, 0);\n" for local in used)
    return f"""
{samplers}uniform int timing_evaluations;
out vec4 timing_color;

void main() {{
    ivec2 at = ivec2(gl_FragCoord.xy);
{reads}    timing_color = vec4(0.0);
    for (int i = 0; i < timing_evaluations; i++) {{
        float moved = 1.0e-4 * float(i);
{"".join(moves)}        shade();
        timing_color += fragment_color;
    }}
}}
"""


def _bound(points: Points) -> dict[str, Array]:
    return dict(zip(_SOURCES.values(), points, strict=True))
