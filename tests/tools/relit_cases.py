"""A bent body whose light inside is computed from a bake, under two lamps and ambient light."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import pytest

import sssgen
from engine_cases import without_reflection
from sssgen.bake import baked_files, relit
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.material.material_loading import load_material
from sssgen.run.render import shade_numpy
from sssgen.run.render.scene_render import PlacedMesh, place_mesh
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from sssgen.scene.arrays import Array
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene import Scene
from sssgen.targets import registry

SIZE = (96, 72)
MATERIAL = """[material]
name = "relit"
[translucency]
technique = "fluence_relit"
inner_light = "body.bin"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[[surface]]
technique = "specular_level"
dielectric_specular = 0.0
"""
SCENE = """material = "relit.toml"
size = [96, 72]
ambient = [0.2, 0.1, 0.3]
[camera]
position = [0.4, 0.8, 3.0]
[geometry]
kind = "mesh"
file = "body.ply"
rotation = [20.0, 50.0, 0.0]
[[light]]
direction = [-0.6, 0.3, -0.8]
color = [2.0, 1.6, 1.2]
[[light]]
position = [0.9, -0.2, 0.7]
color = [0.2, 0.4, 0.8]
[medium]
absorption = [0.2, 0.4, 0.8]
scattering = [3.0, 4.0, 5.0]
"""


def write_body(folder: Path, ior: float = 1.0) -> None:
    """The body with its material, its bake and its scene; with another index than 1, its surface refracts."""
    material = MATERIAL if ior == 1.0 else MATERIAL.replace("fluence_relit", "fluence_relit_refracted")
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    (folder / "relit.toml").write_text(material, "utf-8")
    (folder / "scene.toml").write_text(SCENE + f"ior = {ior}\n", "utf-8")
    trimesh.creation.torus(0.5, 0.22, 32, 16).export(folder / "body.ply")
    body = measured_scene.load(str(folder / "scene.toml")).body_alone()
    data, facts = relit.bake(body, 8, Settings(voxels=12, side=6, photons=2000), processes=0)
    baked_files.write_response(str(folder / "body.bin"), data, facts)


def drawn_by_numpy(folder: Path, file: str = "scene.toml", **changes: Any) -> tuple[Scene, PlacedMesh, Array]:
    """The scene of a file with some changes, its points, and the light that comes out of the body."""
    scene = dataclasses.replace(scene_loading.load(str(folder / file)), samples=1, **changes)
    oracle = sssgen.compile(scene.material, "numpy")
    shell = shell_of(scene, load_material(scene.material), oracle.reflection)
    placed = place_mesh(scene, oracle, shell, registry.load("numpy"), SIZE)
    picture = shade_numpy.shade(without_reflection(oracle), placed.shell, placed.size, placed.points, "float64")
    return scene, placed, picture
