"""The ring of jade_ring as a mesh, and its scene with one light or several, for engines that draw the passes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine_cases import HEAD
from folders import ROOT
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.scene.solids import Torus


def torus_mesh(torus: Torus, around: int = 192, across: int = 96) -> tuple[Array, Array]:
    """The vertices and triangles of a torus in object space, as `EngineDrawing` takes them."""
    u, v = np.meshgrid(*(np.arange(n) * 2 * np.pi / n for n in (around, across)), indexing="ij")
    outwards = np.stack([np.cos(u), np.zeros_like(u), -np.sin(u)], axis=-1)
    normal = np.cos(v)[..., None] * outwards + np.sin(v)[..., None] * np.array([0.0, 1.0, 0.0])
    vertices = np.zeros((around, across, VERTEX_SIZE), np.float32)
    vertices[..., :3] = torus.major * outwards + torus.minor * normal
    vertices[..., 3:6] = normal
    index = np.arange(around * across).reshape(around, across)
    a, b, c, d = (np.roll(index, (-i, -j), (0, 1)).ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return vertices.reshape(-1, VERTEX_SIZE), np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


SEVERAL = """
[[light]]
position = [1.6, -0.4, -1.4]
color = [4.0, 2.0, 1.0]

[[light]]
direction = [0.5, -0.62, 0.66]
color = [0.2, 0.3, 0.6]
"""
"""Lights for jade_ring: a second one near it, and a third one opposite to the first."""


def torus_scene(folder: Path, lights: str) -> str:
    """The scene and material of jade_ring in `folder`; with more `lights`, such as SEVERAL, it has a map for each."""
    example = ROOT / "examples/jade_ring"
    material = (example / "jade_ring.toml").read_text(encoding="utf-8")
    scene = (example / "scene.toml").read_text(encoding="utf-8").replace('"jade_ring"', '"jade.toml"')
    if lights:
        material, scene = material.replace("depth_map_path", "light_layers_path"), scene + lights
    (folder / "jade.toml").write_text(material, encoding="utf-8")
    (folder / "scene.toml").write_text(scene[: scene.index("[shell]")] + scene[scene.index("[geometry]") :])
    return str(folder / "scene.toml")


PICTURES = """
[material]
name = "made"

[[thickness]]
technique = "back_face_thickness"

[translucency]
technique = "interior_octaves"
bind = { light_path = "light_layers_path" }

[[surface]]
technique = "screen_diffusion"
"""
"""A material with a pass of the eye, one of the lights and one that shows light."""
LENGTHS = f"""#include "common/eye_layers.sss"
{HEAD.format("surface")}void shown(vec2 screen_uv, float eye_distance, out vec3 emission)
{{ emission = min(0.4 * eye_lengths(screen_uv, eye_distance), 1.0); }}
"""


def lengths_scene(folder: Path) -> str:
    """The ring seen from the side. It shows the lengths inside its near side, in the gap and inside its far side."""
    path = Path(torus_scene(folder, ""))
    scene = path.read_text(encoding="utf-8").replace("rotation = [116.0,", "rotation = [0.0,")
    path.write_text(scene, encoding="utf-8")
    (folder / "shown.sss").write_text(LENGTHS, encoding="utf-8")
    material = '[material]\nname = "jade"\n[[surface]]\ntechnique = "./shown.sss"\n'
    (folder / "jade.toml").write_text(material, encoding="utf-8")
    return str(path)


def inner_pixels(hit: Array) -> Array:
    """The pixels of a body without those at its edge, where triangles replace the round body."""
    inner = hit.copy()
    for axis, step in ((0, -1), (0, 1), (1, -1), (1, 1)):
        inner &= np.roll(hit, step, axis)
    return inner
