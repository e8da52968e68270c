"""Programs whose time is that of a material or of one technique, for `gpu_cost.measure`.

    ball = surface_points(scene_loading.load("ball.toml"), (1920, 1080))
    program = of_technique("lobe_exp2", ball)

A full-screen pass reads the surface's points from three float textures, a place a pixel, and computes there what the
fragment stage of the emitted shader computes; its floor reads the same and adds it up. Where one evaluation is too
little to be seen beside the reading, each pixel has several, at places moved a little, so that none can be left out.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.evaluate import probes
from sssgen.harness.evaluate import random_inputs as samples
from sssgen.harness.render.scene_values import shell_of
from sssgen.harness.render.shell_values import drawing
from sssgen.harness.scenes.camera import Camera
from sssgen.harness.scenes.geometry import Ball, Geometry
from sssgen.harness.scenes.scene import Scene
from sssgen.ir.types import Sampler
from sssgen.lab.gpu.gpu_timing import ROUNDS, SIZE, Measured, Program, measure
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import compile, transpile
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets.numpy_textures import Texture

EYE, LIGHT = (0.0, 0.0, 1.8), (2.5, 1.0, 0.3)
"""Where the eye and the light of a single technique are: half of what is seen of a ball at the origin is lit."""

MOST_RAYS = 500_000
"""Cast on the CPU for one picture."""


class Points(NamedTuple):
    """What a fragment stage is given at each pixel, as (height, width, 4) float32."""

    place: Array
    """Position in world space (or the ray, where a material makes its own geometry), and u."""
    normal: Array
    """Normal, and v."""
    tangent: Array
    """Tangent with its handedness."""


TARGET = "glsl-330"
"""The target whose text is timed."""

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

    A large picture has several smaller ones side by side, so that the CPU need not cast millions of rays. Of a scene
    without geometry, the rays. Raises SssgenError where the camera sees nothing.
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
    return _points(rays, np.zeros((height, width, 3)), np.zeros((height, width, 4)), np.dstack([u, v]))


def _seen(geometry: Geometry, camera: Camera, size: tuple[int, int]) -> Points | None:
    """The rows of what is hit, one after the other, each drawn out to the whole width."""
    tiles = math.ceil(math.sqrt(size[0] * size[1] / MOST_RAYS))
    width, height = (math.ceil(side / tiles) for side in size)
    origin, directions = camera.rays(width, height)
    hits = geometry.hits(origin, directions)
    hit = hits.hit.reshape(height, width)
    rows = np.flatnonzero(hit.any(axis=1))
    if not len(rows):
        return None
    index = np.empty((height, width), np.int64)
    for y in range(height):
        row = rows[y * len(rows) // height]
        columns = np.flatnonzero(hit[row])
        index[y] = row * width + columns[np.arange(width) * len(columns) // width]
    index = np.tile(index, (tiles, tiles))[: size[1], : size[0]]
    return _points(hits.position[index], hits.normal[index], hits.tangent[index], hits.uv[index])


def _points(place: Array, normal: Array, tangent: Array, uv: Array) -> Points:
    parts = np.dstack([place, uv[..., :1]]), np.dstack([normal, uv[..., 1:]]), tangent
    return Points(*(np.ascontiguousarray(part, np.float32) for part in parts))


def of_material(
    name: str, material: Material | str, scene: Scene, points: Points, evaluations: int = 1, guards: str = "auto"
) -> Program:
    """The fragment stage of a material's emitted shader (glsl-330), lit as in a scene, at points of its surface.

    The text is the emitted one; only its varyings are variables and its `main` a function. Parameters are uniforms
    with the scene's values. Raises SssgenError for a scene that does not fit the material.
    """
    material = material if isinstance(material, Material) else load_material(material)
    compiled = compile(material, TARGET, guards=guards)
    height, width = points.place.shape[:2]
    drawn = drawing(compiled, shell_of(scene, material, compiled.reflection), (width, height), None, None)
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
    values: Mapping[str, Any] | None = None,
) -> Program:
    """One technique (as `sssgen eval` takes it, with functions bound to its slots) at points of a surface.

    Its uniforms have their defaults, or what `values` says; whole numbers among them, which are counts, are constants,
    as materials fix them. Textures are those of `samples`. With `text`, GLSL that has a function of the technique's
    name with its inputs, that is timed instead: `text` declares the uniforms that it reads. Raises SssgenError.
    """
    subject = probes.subject(name, bind)
    label = function = subject.probes[0].function.partition("_shows_")[0]
    renamed: dict[str, str] = {}
    if text:
        label = f"{function} by hand"
    else:
        compiled = transpile(subject.module, TARGET, "timed", guards, subject.called, chained=subject.chained)
        text, renamed = next(iter(compiled.files.values())), compiled.reflection["renames"]
    known = {key: one.default for key, one in subject.uniforms.items() if not isinstance(one.type, Sampler)}
    for key in values or {}:
        if key not in known:
            raise failure(
                f"{function} has no parameter '{key}'", did_you_mean(key, known) or f"it has: {', '.join(known)}"
            )
    numbers: dict[str, Any] = {**known, **(values or {})}
    shade = _shade(_signature(text, function, renamed), subject, numbers)
    bound = {**numbers, **{f"value_{key}": value for key, value in numbers.items()}}
    bound |= {"timing_eye": EYE, "timing_light": LIGHT, "timing_time": 1.5, "timing_evaluations": evaluations}
    head, main = "#version 330 core\n", _main(shade.varyings)
    fragment, floor = f"{head}{text}\n{shade.text}{main}", f"{head}{shade.floor}{main}"
    return Program(label, fragment, bound, {**_textures(subject), **_bound(points)}, floor, evaluations)


class _Input(NamedTuple):
    """A parameter of a function: in GLSL's words, and what the technique calls it."""

    direction: str
    type: str
    name: str


class _Signature(NamedTuple):
    result: str
    function: str
    params: list[_Input]


class _Shade(NamedTuple):
    """The function that shades a pixel with a technique, and the one that only reads its inputs."""

    text: str
    floor: str
    varyings: list[str]


def _signature(text: str, function: str, renamed: Mapping[str, str]) -> _Signature:
    """How a function of a text is declared; `renamed` as in a reflection."""
    shown = renamed.get(function, function)
    match = re.search(rf"^(\w+) {shown}\(([^)]*)\)\s*\{{", text, re.MULTILINE)
    if match is None:
        raise failure(f"the text has no function '{function}'", "give it the technique's name")
    known = {new: old.removeprefix(f"{function}.") for old, new in renamed.items() if old.startswith(f"{function}.")}
    words = [param.split() for param in match[2].split(",") if param.strip()]
    params = [_Input(word[0] if len(word) == 3 else "in", word[-2], known.get(word[-1], word[-1])) for word in words]
    return _Signature(match[1], shown, params)


def _shade(called: _Signature, subject: probes.Subject, numbers: Mapping[str, Any]) -> _Shade:
    """A call with the values of a pixel and the technique's uniforms."""
    declared = [_declaration(one, numbers) for one in called.params if one.name in subject.uniforms]
    own = [one for one in called.params if one.name not in subject.uniforms]
    read = {varying for one in own if one.direction != "out" for varying in _given(one)[1]}
    varyings = [varying for varying in _VARYINGS if varying in read]
    prologue = "".join(
        f"    {one.type} given_{one.name}{'' if one.direction == 'out' else f' = {_given(one)[0]}'};\n" for one in own
    )
    args = [("value_" if one.name in subject.uniforms else "given_") + one.name for one in called.params]
    call = f"{called.function}({', '.join(args)})"
    outputs = [(one.type, f"given_{one.name}") for one in own if one.direction != "in"]
    if called.result != "void":
        call, outputs = f"{called.result} given_result = {call}", [(called.result, "given_result"), *outputs]
    inputs = [(one.type, f"given_{one.name}") for one in own if one.direction != "out"]
    shared = "uniform vec3 timing_eye;\nuniform vec3 timing_light;\nuniform float timing_time;\n" + _declared(varyings)
    text = f"{''.join(declared)}{shared}void shade() {{\n{prologue}    {call};\n"
    return _Shade(
        f"{text}    fragment_color = {_sum(outputs)};\n}}\n",
        f"{shared}void shade() {{\n{prologue}    fragment_color = {_sum(inputs)};\n}}\n",
        varyings,
    )


def _declaration(one: _Input, numbers: Mapping[str, Any]) -> str:
    """A technique's uniform; a count is a constant."""
    if one.type in ("int", "uint"):
        return f"const {one.type} value_{one.name} = {one.type}({np.ravel(numbers[one.name])[0]});\n"
    return f"uniform {one.type} value_{one.name};\n"


def _textures(subject: probes.Subject) -> dict[str, Texture]:
    found: dict[str, Texture] = {}
    for key, one in subject.uniforms.items():
        if isinstance(one.type, Sampler):
            made = samples.texture(one.type.dim, np.random.default_rng(1))
            found |= {key: made, f"value_{key}": made}
    return found


def _given(one: _Input) -> tuple[str, Sequence[str]]:
    """What an input is at a pixel, and the varyings that it is made of."""
    name = one.name.removesuffix("_object")
    if name in _GIVEN:
        return _GIVEN[name]
    if one.type not in _AMOUNTS:
        raise failure(f"an input of type {one.type} has no values to be timed with: '{one.name}'")
    return _AMOUNTS[one.type], ("v_uv",)


def _sum(values: Iterable[tuple[str, str]]) -> str:
    return " + ".join(_AS_VEC4[type_].format(name) for type_, name in values) or "vec4(0.0)"


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


class Point(NamedTuple):
    """A chain of techniques to be timed."""

    name: str
    material: Material | str
    """A checked material, a path, or an example's name."""
    scene: Scene
    """Where it is shaded: its geometry, camera, lights, parameters and textures."""


def costs(
    points: Sequence[Point], size: tuple[int, int] = SIZE, rounds: int = ROUNDS, evaluations: int = 1
) -> Measured:
    """What whole materials cost: `costs(...).net(name).median` is ms of shading at every pixel of a picture.

    All lights of the scene, the standard light among what is timed; reading the surface's points is not. Raises
    SssgenError where there is no OpenGL, and for a material that does not fit its scene.
    """
    surfaces = {id(point.scene): surface_points(point.scene, size) for point in points}
    return measure(
        [of_material(one.name, one.material, one.scene, surfaces[id(one.scene)], evaluations) for one in points],
        size,
        rounds,
    )
