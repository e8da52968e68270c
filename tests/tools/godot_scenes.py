"""Example scenes as Godot draws them, and the oracle's pictures of the same points."""

from __future__ import annotations

import dataclasses
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import sssgen
from folders import ROOT
from sssgen.pipeline.compiler import Compiled
from sssgen.run import backends
from sssgen.run.backends import VERTEX_SIZE, Array
from sssgen.run.backends.godot_drawing import Godot, View
from sssgen.run.render import godot_values, scene_render, shade_numpy
from sssgen.run.render.shell_values import Shell
from sssgen.scene import scene_loading
from sssgen.scene.pictures.images import encode_srgb
from sssgen.scene.scene import Scene

MESHES = ["ice", "ice_inlay", "jade_ring", "marble_idol", "paper_lantern", "resin_inlay", "wax_mouse"]
"""The examples that are on a mesh."""
WHOLE, THROUGH = "whole", "through"
"""All light of a file whose light is ours; the light alone that comes through, of the file with Godot's light."""
SIZE = (160, 120)
_NO_LIGHTING = "def evaluate_lighting(*_):\n    return np.zeros((3, 1))\n"
_OWN = "    // Godot's own reflected"
_THROUGH = "    // Light that comes through"


def scene_of(name: str) -> Scene:
    """An example, small and without ambient light: Godot counts that in another way. Time stands still at 0."""
    scene = scene_loading.load(str(ROOT / "examples" / name / "scene.toml"))
    return dataclasses.replace(scene, size=SIZE, samples=1, time=0.0, ambient=(0.0, 0.0, 0.0), shell={})


def text_of(compiled: Compiled, part: str) -> str:
    """The shader of a part; reflected light is cut from Godot's light to leave the light that comes through."""
    name = compiled.reflection["material"]
    if part == WHOLE:
        return compiled.files.get(f"{name}.own_light.gdshader") or compiled.files[f"{name}.gdshader"]
    text = compiled.files[f"{name}.gdshader"]
    assert text.count(_OWN) == text.count(_THROUGH) == 1
    return text[: text.index(_OWN)] + text[text.index(_THROUGH) :]


def deviation(name: str, renderer: str, part: str) -> Array:
    """The largest difference of a channel in each pixel, of linear light clamped to 0..1."""
    reference, picture = (np.clip(_picture(name, engine, part), 0.0, 1.0) for engine in ("numpy", renderer))
    difference: Array = np.abs(reference - picture).max(axis=2)
    return difference


@cache
def _picture(name: str, engine: str, part: str) -> Array:
    backend: Any = backends.get("numpy") if engine == "numpy" else Godot(engine)

    def shade(_: object, compiled: Compiled, shell: Shell, size: tuple[int, int], points: Array | None) -> Array:
        reflection = compiled.reflection
        if points is not None:
            points = as_godot_stores(points)
        if isinstance(backend, Godot):
            return godot_values.shade(text_of(compiled, part), reflection, shell, backend, size, points)
        if part == THROUGH:
            file = next(file for file in compiled.files if file.endswith(".py"))
            text = f"{compiled.files[file]}\n{_NO_LIGHTING}"
            compiled = compiled._replace(files={**compiled.files, file: text})
        return shade_numpy.shade(compiled, shell, size, points, "float64")

    usual, scene_render.shade = scene_render.shade, shade
    try:
        return scene_render.render(scene_of(name), backend).linear
    finally:
        scene_render.shade = usual


def raymarched_deviation(renderer: str) -> Array:
    """A raymarched scene on Godot's own quad, beside the oracle, whose output encodes with 2.2 and clamps near 0.9."""
    expected = encode_srgb(_picture("jelly_cubes", "numpy", WHOLE)[..., :3]) ** 2.2
    drawn = _picture("jelly_cubes", renderer, WHOLE)[..., :3]
    assert np.ptp(expected) > 0.3
    difference: Array = np.abs(np.clip(expected, 0.0, 0.9) - np.clip(drawn, 0.0, 0.9)).max(axis=2)
    return difference


def as_godot_stores(points: Array) -> Array:
    """The vertices with the normals and tangents that Godot's meshes have: two numbers of 16 bits each."""
    stored = points.copy()
    stored[:, 3:6], stored[:, 6:9] = _rounded(points[:, 3:6]), _rounded(points[:, 6:9])
    return stored


def _rounded(directions: Array) -> Array:
    """Unit directions on the octahedron that is unfolded to a square of 65536 × 65536 places."""
    sums = np.maximum(np.abs(directions).sum(axis=1, keepdims=True), 1e-20)
    x, y, z = (directions / sums).T
    folded = z < 0.0
    u = np.where(folded, (1.0 - np.abs(y)) * np.where(x >= 0.0, 1.0, -1.0), x)
    v = np.where(folded, (1.0 - np.abs(x)) * np.where(y >= 0.0, 1.0, -1.0), y)
    u, v = (np.round((0.5 * axis + 0.5) * 65535.0) / 65535.0 * 2.0 - 1.0 for axis in (u, v))
    z = 1.0 - np.abs(u) - np.abs(v)
    back = np.maximum(-z, 0.0)
    x, y = u + np.where(u >= 0.0, -back, back), v + np.where(v >= 0.0, -back, back)
    result: Array = np.stack([x, y, z], axis=1)
    return result / np.maximum(np.linalg.norm(result, axis=1, keepdims=True), 1e-20)


_DULL = """
[material]
name = "dull"
[[thickness]]
technique = "constant_thickness"
[[thickness]]
technique = "beer_lambert"
[[surface]]
technique = "base_color"
tint = [0.6, 0.3, 0.1, 1.0]
[[surface]]
technique = "pbr_constants"
metalness = 0.0
surface_roughness = {roughness}
[translucency]
technique = "lobe_normalized"
attenuation = 0.0
"""


def standard_material_deviation(renderer: str, roughness: float) -> Array:
    """A ball of a material that transmits no light, beside Godot's own standard material, under two lights."""
    text = _emitted(_DULL.format(roughness=roughness), "dull.gdshader")
    color = [*map(float, encode_srgb(np.array([0.6, 0.3, 0.1])))]
    values = {
        "albedo_color": {"kind": "color", "value": color},
        "metallic": {"kind": "float", "value": [0.0]},
        "roughness": {"kind": "float", "value": [roughness]},
    }
    godot, view = Godot(renderer), _view(*_ball(48))
    ours, theirs = (np.clip(godot.draw(shader, view, own, {}), 0.0, 1.0) for shader, own in ((text, {}), ("", values)))
    assert theirs[..., :3].max() > 0.5
    return np.abs(ours - theirs)


_SHEET = """
[material]
name = "sheet"
two_sided = {two_sided}
[[surface]]
technique = "base_color"
tint = [0.6, 0.3, 0.1, 1.0]
[translucency]
technique = "wrap_lighting"
"""


def back_face_deviation(renderer: str) -> Array:
    """The inside of a two-sided ball, beside that of a ball whose front faces are inside."""
    vertices, triangles = _ball(48)
    inside = vertices.copy()
    inside[:, 3:6] *= -1.0
    godot = Godot(renderer)
    back, front = (
        np.clip(godot.draw(_emitted(_SHEET.format(two_sided=sides), "sheet.gdshader"), view, {}, {}), 0.0, 1.0)
        for sides, view in (
            ("true", _view(vertices, triangles, 0.5)),
            ("false", _view(inside, triangles[:, [0, 2, 1]], 0.5)),
        )
    )
    assert front[..., :3].max() > 0.2
    return np.abs(back - front)


_PAINTED = """
[material]
name = "painted"
shading = "{shading}"
[[{role}]]
technique = "shown.sss"
"""
_SHOWN = """
/** Shows values of the mesh.
role: {role}
*/
vec3 shown(vec4 vertex_color, uv_position uv2, object_position P_object, world_direction N, world_direction L)
{{
    vec3 p = vec3(P_object);
    return 0.6 * ({value}) * (0.5 + 0.2 * dot(N, L));
}}
"""
_VALUES = ("vertex_color.rgb * vertex_color.a + vec3(0.4 * uv2, 0.0)",
           "(0.5 + 0.4 * p) * (0.7 + 0.2 * p.x) + vec3(0.2 + 0.12 * p.xy, 0.0)")  # fmt: skip


def vertex_deviation(renderer: str, role: str) -> Array:
    """Colours and second coordinates of a ball's vertices, beside the same numbers computed from the position."""
    shading = "unlit" if role == "lighting" else "lit"
    godot, view = Godot(renderer), _view(*_ball(96))
    read, computed = (
        np.clip(godot.draw(_emitted(
            _PAINTED.format(shading=shading, role=role), "painted.gdshader", _SHOWN.format(role=role, value=value)
        ), view, {}, {}), 0.0, 1.0)
        for value in _VALUES
    )  # fmt: skip
    assert read[..., :3].max() > 0.3
    return np.abs(read - computed)


_LAYERED = """
[material]
name = "layered"
[[surface]]
technique = "base_color"
tint = [0.6, 0.3, 0.1, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.7
[[surface]]
technique = "specular_level"
dielectric_specular = 0.9
[[surface]]
technique = "clearcoat_constants"
coat_weight = 0.8
coat_roughness = 0.5
"""


def layered_deviation(renderer: str) -> Array:
    """A ball with a clear coat, beside Godot's own standard material with its properties."""
    values = {
        "albedo_color": {"kind": "color", "value": [*map(float, encode_srgb(np.array([0.6, 0.3, 0.1])))]},
        "metallic": {"kind": "float", "value": [0.0]},
        "roughness": {"kind": "float", "value": [0.7]},
        "metallic_specular": {"kind": "float", "value": [float(np.sqrt(0.08 * 0.9 / 0.16))]},
        "clearcoat_enabled": {"kind": "float", "value": [1.0]},
        "clearcoat": {"kind": "float", "value": [0.8]},
        "clearcoat_roughness": {"kind": "float", "value": [0.5]},
    }
    godot, view = Godot(renderer), _view(*_ball(48))
    text = _emitted(_LAYERED, "layered.gdshader")
    ours, theirs = (np.clip(godot.draw(shader, view, own, {}), 0.0, 1.0) for shader, own in ((text, {}), ("", values)))
    bare = np.clip(
        godot.draw("", view, {**values, "clearcoat_enabled": {"kind": "float", "value": [0.0]}}, {}), 0.0, 1.0
    )
    assert np.abs(theirs - bare).max() > 4.0 / 255.0
    return np.abs(ours - theirs)


def _emitted(material: str, file: str, technique: str = "") -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "made.toml"
        (Path(folder) / "shown.sss").write_text(technique, encoding="utf-8")
        path.write_text(material, encoding="utf-8")
        return sssgen.compile(path, "godot").files[file]


def _view(vertices: Array, triangles: Array, distance: float = 3.0) -> View:
    """A mesh at the origin with a light from afar and a lamp, and a camera at a distance."""
    lights: list[dict[str, Any]] = [
        {"towards": [0.5, 0.6, 0.62], "color": [1.0, 0.8, 0.6], "energy": 1.5},
        {"place": [-1.5, 0.5, 1.5], "color": [0.4, 0.6, 1.0], "energy": 2.0},
    ]
    camera = np.eye(4)
    camera[2, 3] = distance
    return View((96, 96), camera, 45.0, lights, np.eye(4), vertices, triangles)


def _ball(rows: int) -> tuple[Array, Array]:
    """The vertices and the triangles of a ball of radius 1; second uv and colours are linear in the position."""
    polar, around = np.meshgrid(np.linspace(0, np.pi, rows), np.linspace(0, 2 * np.pi, 2 * rows), indexing="ij")
    normal = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], -1)
    tangent = np.stack([-np.sin(around), 0 * around, np.cos(around), np.ones_like(around)], -1)
    uv = np.stack([around / (2 * np.pi), polar / np.pi], -1)
    color = np.concatenate([0.5 + 0.4 * normal, 0.7 + 0.2 * normal[..., :1]], axis=-1)
    parts = [normal, normal, tangent, uv, 0.5 + 0.3 * normal[..., :2], color]
    vertices = np.concatenate(parts, axis=-1).reshape(-1, VERTEX_SIZE)
    width = 2 * rows
    corner = (np.arange(rows - 1)[:, None] * width + np.arange(width - 1)).ravel()
    halves = [[corner, corner + 1, corner + width], [corner + 1, corner + width + 1, corner + width]]
    return vertices, np.concatenate([np.stack(half, axis=1) for half in halves])
