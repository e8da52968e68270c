"""Bodies whose light inside is computed from a bake, under two lamps and ambient light: a ring, and examples."""

from __future__ import annotations

import dataclasses
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import without_reflection
from folders import ROOT
from sssgen.bake import baked_files, relit
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.material.material_loading import load_material
from sssgen.run.render import shade_numpy
from sssgen.run.render.scene_render import PlacedMesh, place_mesh
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from sssgen.scene.arrays import Array
from sssgen.scene.geometry_base import unit
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.light_response import harmonics
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene import Light, Scene
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


EXAMPLES = {"marble_idol": (128, 256), "skin_ear": (256, 256)}
"""The examples with such a material → the size of their picture: Forward+ filters the picture of the eye's layers, and
Mesa's software driver mixes neighbours where sides are no powers of two."""
Sky = tuple[tuple[float, float, float], tuple[float, float, float]]
"""What a white matt surface shows that faces up, and one that faces down; it is linear in the normal between them."""


def write_body(folder: Path, ior: float = 1.0) -> None:
    """The body with its material, its bake and its scene; with another index than 1, its surface refracts."""
    material = MATERIAL if ior == 1.0 else MATERIAL.replace("fluence_relit", "fluence_relit_refracted")
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    (folder / "relit.toml").write_text(material, "utf-8")
    (folder / "scene.toml").write_text(SCENE + f"ior = {ior}\n", "utf-8")
    trimesh.creation.torus(0.5, 0.22, 32, 16).export(folder / "body.ply")
    _bake(folder, Settings(voxels=12, side=6, photons=2000))


def write_example(name: str, folder: Path) -> None:
    """One of EXAMPLES as a mesh with a coarse bake; its surface is black, and the material's name is `relit`."""
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
    example = ROOT / "examples" / name
    shutil.copytree(example, folder, dirs_exist_ok=True)
    material = (example / f"{name}_relit.toml").read_text("utf-8")
    material = re.sub(r'inner_light = ".*"', 'inner_light = "body.bin"', material.replace(f"{name}_relit", "relit"))
    black = '[[surface]]\ntechnique = "specular_level"\ndielectric_specular = 0.0\n'
    (folder / "relit.toml").write_text(f"{material}\n{black}", "utf-8")
    body = scene_loading.load(str(example / "scene_relit.toml")).geometry
    assert body is not None
    plain = dataclasses.replace(body, position=(0.0,) * 3, rotation=(0.0,) * 3, scale=1.0)
    trimesh.Trimesh(*mesh_of(plain), process=False).export(folder / "body.ply")
    text = (example / "scene_relit.toml").read_text("utf-8").replace(f"{name}_relit.toml", "relit.toml")
    mesh = '[geometry]\nkind = "mesh"\nfile = "body.ply"\n'
    text, count = re.subn(r"\[geometry\]\nkind = .*\ntechnique = .*\nreach = .*\n", mesh, text)
    assert count == 1
    (folder / "scene.toml").write_text(text, "utf-8")
    _bake(folder, Settings(voxels=24, side=8, photons=4000))


def _bake(folder: Path, settings: Settings) -> None:
    body = measured_scene.load(str(folder / "scene.toml")).body_alone()
    data, facts = relit.bake(body, 8, settings, processes=0)
    baked_files.write_response(str(folder / "body.bin"), data, facts)


def turned(lights: tuple[Light, ...], angle: float) -> tuple[Light, ...]:
    """Lights that have gone around the vertical axis."""
    cosine, sine = np.cos(angle), np.sin(angle)
    turn = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])

    def moved(way: tuple[float, float, float] | None) -> Any:
        return None if way is None else tuple(map(float, turn @ way))

    return tuple(
        dataclasses.replace(light, position=moved(light.position), direction=moved(light.direction)) for light in lights
    )


def linear_sky(sky: Sky) -> Callable[..., Array]:
    """In place of `inner_light.surroundings`: the harmonics of a sky."""
    above, below = np.array(sky)

    def surroundings(_: object, to_object: Array) -> Array:
        count = np.arange(20000) + 0.5
        height, around = 1.0 - 2.0 * count / len(count), np.pi * (3.0 - np.sqrt(5.0)) * count
        across = np.sqrt(1.0 - height**2)
        ways = unit(np.stack([across * np.cos(around), height, across * np.sin(around)], axis=1) @ to_object[:3, :3].T)
        # a matt surface leaves 2/3 of what is linear in the direction
        light = 0.5 * (above + below) + 0.75 * height[:, None] * (above - below)
        result: Array = harmonics(ways).T @ light * (4.0 / len(count))
        return result

    return surroundings


def drawn_by_numpy(
    folder: Path, file: str = "scene.toml", size: tuple[int, int] = SIZE, **changes: Any
) -> tuple[Scene, PlacedMesh, Array]:
    """The scene of a file with some changes, its points, and the light that comes out of the body."""
    scene = dataclasses.replace(scene_loading.load(str(folder / file)), samples=1, size=size, **changes)
    oracle = sssgen.compile(scene.material, "numpy")
    shell = shell_of(scene, load_material(scene.material), oracle.reflection)
    placed = place_mesh(scene, oracle, shell, registry.load("numpy"), size)
    picture = shade_numpy.shade(without_reflection(oracle), placed.shell, placed.size, placed.points, "float64")
    return scene, placed, picture
