"""GPU programs that time a material or a single technique, for `gpu_timing.measure`.

    ball = surface_points(scene_loading.load("ball.toml"), (1920, 1080))
    program = of_technique("lobe_exp2", ball)

A full-screen pass reads one surface point per pixel from three float textures, and runs the code of the emitted
fragment stage there. Its floor, which is subtracted, reads the same textures and adds the values. If one evaluation
takes too little time compared with the reads, each pixel runs several, at slightly different points, so that the
compiler cannot merge them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.frame_passes import EYE_PICTURES
from sssgen.ir.types import Sampler
from sssgen.lab.gpu.gpu_timing import ROUNDS, SIZE, Program, ProgramTimes, measure
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import compile, transpile
from sssgen.run.backends import Array
from sssgen.run.evaluate import probes
from sssgen.run.evaluate import random_inputs as samples
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shell_values import drawing
from sssgen.scene.camera import Camera
from sssgen.scene.drawn_views import eye_layers
from sssgen.scene.geometry import Ball, Geometry
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets.runtime.numpy_textures import Texture

EYE, LIGHT = (0.0, 0.0, 1.8), (2.5, 1.0, 0.3)
"""Positions of the eye and of the light for single techniques: half of the visible part of a unit ball is lit."""

MOST_RAYS = 500_000
"""The limit of rays that the CPU casts for a picture."""


Numbers = Mapping[str, float | Sequence[float]]
"""The values of uniforms by name"""


class Points(NamedTuple):
    """The inputs of a fragment stage at each pixel, as (height, width, 4) float32."""

    position: Array
    """Position in world space (or the ray, for a material that has its own geometry), and u."""
    normal: Array
    """Normal, and v."""
    tangent: Array
    """Tangent with its handedness."""


TARGET = "glsl-330"
"""The target whose emitted text is timed."""

_VARYINGS = {
    "v_position": ("vec3", "timing_place.xyz + offset"),
    "v_ray": ("vec3", "timing_place.xyz + offset"),
    "v_normal": ("vec3", "timing_normal.xyz + offset"),
    "v_tangent": ("vec4", "timing_tangent + vec4(vec3(offset), 0.0)"),
    "v_uv": ("vec2", "vec2(timing_place.w, timing_normal.w) + offset"),
    "v_clip": ("vec3", "vec3(2.0 * gl_FragCoord.xy / vec2(textureSize(timing_places, 0)) - 1.0 + offset, 1.0)"),
}
"""The varyings of emitted fragment stages: type, and GLSL expression in the timing pass."""

_INPUTS = {
    "P": ("v_position", ("v_position",)),
    "p": ("v_position", ("v_position",)),
    "uv": ("v_uv", ("v_uv",)),
    "N": ("normalize(v_normal)", ("v_normal",)),
    "V": ("normalize(timing_eye - v_position)", ("v_position",)),
    "L": ("normalize(timing_light - v_position)", ("v_position",)),
    "T": ("v_tangent.xyz", ("v_tangent",)),
    "B": ("cross(v_normal, v_tangent.xyz)", ("v_normal", "v_tangent")),
    "time": ("timing_time", ()),
    "screen_uv": ("0.5 * v_clip.xy + 0.5", ("v_clip",)),
    "eye_distance": ("distance(timing_eye, v_position)", ("v_position",)),
    "light_nearness": ("1.0 / distance(timing_light, v_position)", ("v_position",)),
    "ray_origin": ("timing_eye", ()),
    "ray_direction": ("normalize(v_position - timing_eye)", ("v_position",)),
}
"""A technique's inputs by name, without the suffix of the space: GLSL expression, and the varyings in it."""

_OTHER_INPUTS = {
    "float": "fract(dot(v_uv, vec2(3.0, 5.0)))",
    "vec2": "fract(v_uv * 3.0)",
    "vec3": "fract(vec3(v_uv, 0.5) * 3.0)",
    "vec4": "fract(v_uv.xyxy * 3.0)",
    "int": "int(v_uv.x * 8.0)",
    "uint": "uint(v_uv.x * 8.0)",
    "bool": "v_uv.x > 0.5",
}
"""The expressions of all other inputs, by type; they vary over the picture."""

_AS_VEC4 = {"float": "vec4({})", "bool": "vec4(float({}))", "int": "vec4(float({}))", "uint": "vec4(float({}))"}
_AS_VEC4 |= {"vec2": "vec4({}, 0.0, 0.0)", "vec3": "vec4({}, 0.0)", "vec4": "{}"}


@lru_cache(4)
def ball_points(size: tuple[int, int]) -> Points:
    """The points of a ball that fills the picture."""
    points = _visible_points(Ball(), Camera(EYE, field_of_view=30.0), size)
    assert points is not None
    return points


def surface_points(scene: Scene, size: tuple[int, int]) -> Points:
    """The surface points that a scene's camera sees, stretched until they fill the picture.

    A large picture consists of tiles of a smaller one, because the CPU casts the rays. A scene without geometry gives
    the rays instead. Raises SssgenError where the camera sees nothing.
    """
    if scene.geometry is None:
        return _rays(scene.camera, size)
    points = _visible_points(scene.geometry, scene.camera, size)
    if points is None:
        raise failure("the camera sees nothing of the scene's geometry", file=scene.document.reporter.file)
    return points


def _rays(camera: Camera, size: tuple[int, int]) -> Points:
    width, height = size
    v, u = (np.mgrid[0:height, 0:width] + 0.5) / np.array([height, width])[:, None, None]
    rays = camera.rays(*size)[1].reshape(height, width, 3)
    return _points(rays, np.zeros((height, width, 3)), np.zeros((height, width, 4)), np.dstack([u, v]))


def _visible_points(geometry: Geometry, camera: Camera, size: tuple[int, int]) -> Points | None:
    """The hit points by rows, each resampled to the full width; None without a hit."""
    tiles = _tiles(size)
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


def _tiles(size: tuple[int, int]) -> int:
    """The number of equal tiles along each side of a picture."""
    return math.ceil(math.sqrt(size[0] * size[1] / MOST_RAYS))


def _points(position: Array, normal: Array, tangent: Array, uv: Array) -> Points:
    parts = np.dstack([position, uv[..., :1]]), np.dstack([normal, uv[..., 1:]]), tangent
    return Points(*(np.ascontiguousarray(part, np.float32) for part in parts))


def of_material(
    name: str, material: Material | str, scene: Scene, points: Points, evaluations: int = 1, guards: str = "auto"
) -> Program:
    """The program of a material's emitted fragment stage (glsl-330), with a scene's lights, at surface points.

    The text is the emitted one, except that its varyings become variables and its `main` a function. Parameters are
    uniforms with the scene's values. Raises SssgenError for a scene that does not fit the material.
    """
    material = material if isinstance(material, Material) else load_material(material)
    compiled = compile(material, TARGET, guards=guards)
    height, width = points.position.shape[:2]
    shell = shell_of(scene, material, compiled.reflection)
    missing = _usual_textures(compiled.reflection["textures"])
    screens = _screens(scene, compiled.reflection, points)
    shell = replace(shell, textures={**missing, **shell.textures}, screens=screens)
    program = drawing(compiled, shell, (width, height), None, None)
    text = program.fragment.text.text
    varyings = [varying for varying in _VARYINGS if re.search(rf"^in \w+ {varying};$", text, re.MULTILINE)]
    text = re.sub(r"^(?:in|out) (\w+ (?:v_\w+|fragment_color);)$", r"\1", text, flags=re.MULTILINE)
    text = re.sub(r"^void main\(\)", "void shade()", text, flags=re.MULTILINE)
    text = text.replace("discard;", "return;")  # discarding would shorten the time
    textures = {name: bound.data for name, bound in program.textures.items()}
    sum_of_reads = _sum((_VARYINGS[varying][0], varying) for varying in varyings)
    floor = f"#version 330 core\n{_declarations(varyings)}void shade() {{\n    fragment_color = {sum_of_reads};\n}}\n"
    uniforms = {**program.values, "timing_evaluations": evaluations}
    main = _main(varyings)
    return Program(name, text + main, uniforms, {**textures, **_bound(points)}, floor + main, evaluations)


def _usual_textures(declared: Sequence[Mapping[str, Any]]) -> dict[str, Texture]:
    """Random textures as large as usual ones: the time of a read depends on the size, not on the values."""
    random = np.random.default_rng(1)
    sides = {"sampler2D": (512, 512), "sampler3D": (24, 24, 24)}
    return {
        entry["source_name"]: half(Texture(random.random((*sides[entry["type"]], 4)), wrap="clamp"))
        for entry in declared
        if entry["type"] in sides and entry["drawn"] not in EYE_PICTURES
    }


def _screens(scene: Scene, reflection: Mapping[str, Any], points: Points) -> dict[str, Texture]:
    """The textures that the program draws over the screen, for the points in it: as large as a real one."""
    drawn = {entry["source_name"]: entry["drawn"] for entry in reflection["textures"] if entry["drawn"] in EYE_PICTURES}
    if not drawn or scene.geometry is None:
        return {}
    height, width = points.position.shape[:2]
    tiles = _tiles((width, height))
    tile = points.position[: math.ceil(height / tiles), : math.ceil(width / tiles), :3].astype(np.float64)
    eye = np.array(scene.camera.position)
    rays = tile.reshape(-1, 3) - eye
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    screens = {}
    for name, kind in drawn.items():
        layers = eye_layers(scene.geometry, eye, rays, kind).reshape(*tile.shape[:2], -1)
        screens[name] = half(Texture(np.tile(layers, (tiles, tiles, 1))[:height, :width], wrap="clamp"))
    return screens


def of_technique(
    name: str,
    points: Points,
    bind: Mapping[str, str] | None = None,
    evaluations: int = 1,
    guards: str = "auto",
    text: str = "",
    values: Numbers | None = None,
) -> Program:
    """The program of one technique (named as for `sssgen eval`, with functions bound to its slots) at surface points.

    Its uniforms have their defaults or those of `values`; integers, which are counts, are constants, as in materials.
    Textures are random. `text` replaces the emitted GLSL by other GLSL with a function of the technique's name and
    inputs, which declares its own uniforms. Raises SssgenError.
    """
    subject = probes.subject(name, bind)
    label = function = subject.probes[0].function.partition("_shows_")[0]
    renamed: dict[str, str] = {}
    if text:
        label = f"{function} by hand"
    else:
        compiled = transpile(subject.module, TARGET, "timed", guards, subject.called, chained=subject.chained)
        text, renamed = next(iter(compiled.files.values())), compiled.reflection["renames"]
    defaults = {
        key: uniform.default for key, uniform in subject.uniforms.items() if not isinstance(uniform.type, Sampler)
    }
    for key in values or {}:
        if key not in defaults:
            raise failure(
                f"{function} has no parameter '{key}'",
                did_you_mean(key, defaults) or f"parameters: {', '.join(defaults)}",
            )
    numbers: Numbers = {**defaults, **(values or {})}
    shade = _shade(_signature(text, function, renamed), subject, numbers)
    uniforms = {**numbers, **{f"value_{key}": value for key, value in numbers.items()}}
    uniforms |= {"timing_eye": EYE, "timing_light": LIGHT, "timing_time": 1.5, "timing_evaluations": evaluations}
    head, main = "#version 330 core\n", _main(shade.varyings)
    fragment, floor = f"{head}{text}\n{shade.text}{main}", f"{head}{shade.floor}{main}"
    return Program(label, fragment, uniforms, {**_textures(subject), **_bound(points)}, floor, evaluations)


class _Input(NamedTuple):
    """A parameter of a GLSL function."""

    direction: str
    """in, out or inout"""
    type: str
    name: str
    """As in the technique"""


class _Signature(NamedTuple):
    result: str
    function: str
    params: list[_Input]


class _Shade(NamedTuple):
    """The function that evaluates a technique at a pixel, and its floor, which only reads the inputs."""

    text: str
    floor: str
    varyings: list[str]


def _signature(text: str, function: str, renamed: Mapping[str, str]) -> _Signature:
    """The declaration of a function in a text; `renamed` as in a reflection."""
    emitted = renamed.get(function, function)
    match = re.search(rf"^(\w+) {emitted}\(([^)]*)\)\s*\{{", text, re.MULTILINE)
    if match is None:
        raise failure(f"the text has no function '{function}'", "its function must have the technique's name")
    names = {new: old.removeprefix(f"{function}.") for old, new in renamed.items() if old.startswith(f"{function}.")}
    declarations = [param.split() for param in match[2].split(",") if param.strip()]
    params = [
        _Input(part[0] if len(part) == 3 else "in", part[-2], names.get(part[-1], part[-1])) for part in declarations
    ]
    return _Signature(match[1], emitted, params)


def _shade(called: _Signature, subject: probes.Subject, numbers: Numbers) -> _Shade:
    """The functions that call a technique with a pixel's inputs and the technique's uniforms."""
    uniforms = [param for param in called.params if param.name in subject.uniforms]
    inputs = [param for param in called.params if param.name not in subject.uniforms and param.direction != "out"]
    outputs = [param for param in called.params if param.name not in subject.uniforms and param.direction == "out"]
    read = {varying for param in inputs for varying in _input(param)[1]}
    varyings = [varying for varying in _VARYINGS if varying in read]
    locals_ = [f"    {param.type} argument_{param.name} = {_input(param)[0]};\n" for param in inputs]
    locals_ += [f"    {param.type} argument_{param.name};\n" for param in outputs]
    arguments = [("value_" if param in uniforms else "argument_") + param.name for param in called.params]
    call = f"{called.function}({', '.join(arguments)})"
    results = [
        (param.type, f"argument_{param.name}")
        for param in called.params
        if param not in uniforms and param.direction != "in"
    ]
    if called.result != "void":
        call, results = f"{called.result} argument_result = {call}", [(called.result, "argument_result"), *results]
    shared = "uniform vec3 timing_eye;\nuniform vec3 timing_light;\nuniform float timing_time;\n" + _declarations(
        varyings
    )
    start = f"{shared}void shade() {{\n{''.join(locals_)}"
    declarations = "".join(_declaration(param, numbers) for param in uniforms)
    sum_of_inputs = _sum((param.type, f"argument_{param.name}") for param in inputs)
    return _Shade(
        f"{declarations}{start}    {call};\n    fragment_color = {_sum(results)};\n}}\n",
        f"{start}    fragment_color = {sum_of_inputs};\n}}\n",
        varyings,
    )


def _declaration(uniform: _Input, numbers: Numbers) -> str:
    """The declaration of a technique's uniform; a count is a constant."""
    if uniform.type in ("int", "uint"):
        value = np.ravel(numbers[uniform.name])[0]
        return f"const {uniform.type} value_{uniform.name} = {uniform.type}({value});\n"
    return f"uniform {uniform.type} value_{uniform.name};\n"


def _textures(subject: probes.Subject) -> dict[str, Texture]:
    textures: dict[str, Texture] = {}
    for key, uniform in subject.uniforms.items():
        if isinstance(uniform.type, Sampler):
            textures[key] = samples.texture(uniform.type.dim, np.random.default_rng(1))
            textures[f"value_{key}"] = textures[key]
    return textures


def _input(param: _Input) -> tuple[str, Sequence[str]]:
    """The GLSL expression of an input at a pixel, and the varyings in it."""
    name = param.name.removesuffix("_object")
    if name in _INPUTS:
        return _INPUTS[name]
    if param.type not in _OTHER_INPUTS:
        raise failure(f"an input of type {param.type} has no values for timing: '{param.name}'")
    return _OTHER_INPUTS[param.type], ("v_uv",)


def _sum(values: Iterable[tuple[str, str]]) -> str:
    return " + ".join(_AS_VEC4[type_].format(name) for type_, name in values) or "vec4(0.0)"


def _declarations(varyings: Sequence[str]) -> str:
    lines = [f"{_VARYINGS[varying][0]} {varying};\n" for varying in varyings]
    return "".join([*lines, "vec4 fragment_color;\n"])


_SOURCES = {"timing_place": "timing_places", "timing_normal": "timing_normals", "timing_tangent": "timing_tangents"}


def _main(varyings: Sequence[str]) -> str:
    """The `main` of the pass: it reads a point and evaluates `shade` there and at points nearby."""
    assignments = [f"        {varying} = {_VARYINGS[varying][1]};\n" for varying in varyings]
    used = [local for local in _SOURCES if any(local in line for line in assignments)]
    samplers = "".join(f"uniform sampler2D {_SOURCES[local]};\n" for local in used)
    reads = "".join(f"    vec4 {local} = texelFetch({_SOURCES[local]}, pixel, 0);\n" for local in used)
    return f"""
{samplers}uniform int timing_evaluations;
out vec4 timing_color;

void main() {{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
{reads}    timing_color = vec4(0.0);
    for (int i = 0; i < timing_evaluations; i++) {{
        float offset = 1.0e-4 * float(i);
{"".join(assignments)}        shade();
        timing_color += fragment_color;
    }}
}}
"""


def _bound(points: Points) -> dict[str, Array]:
    return dict(zip(_SOURCES.values(), points, strict=True))


class TimedMaterial(NamedTuple):
    """A material with the scene for its timing."""

    name: str
    material: Material | str
    """A checked material, a path, or an example's name."""
    scene: Scene
    """Geometry, camera, lights, parameters and textures."""


def costs(
    materials: Sequence[TimedMaterial], size: tuple[int, int] = SIZE, rounds: int = ROUNDS, evaluations: int = 1
) -> ProgramTimes:
    """The times of complete materials: `costs(...).net(name).median` is the time of shading a picture, in ms.

    The time includes the standard light, for all lights of the scene, and excludes the reads of the points. Raises
    SssgenError without OpenGL, and for a material that does not fit its scene.
    """
    surfaces = {id(timed.scene): surface_points(timed.scene, size) for timed in materials}
    return measure(
        [
            of_material(timed.name, timed.material, timed.scene, surfaces[id(timed.scene)], evaluations)
            for timed in materials
        ],
        size,
        rounds,
    )
