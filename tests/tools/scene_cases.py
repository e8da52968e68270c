"""Examples under two lamps with shadows and a sky, as meshes that engines draw, and our own pictures of them."""

from __future__ import annotations

import dataclasses
import math
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import trimesh

import sssgen
from engine_cases import HEAD, without_reflection
from folders import ROOT
from sssgen.ir.frame_passes import BACK_FACES
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render import shade_numpy
from sssgen.run.render.scene_render import PlacedMesh, place_mesh
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shell_values import Shell
from sssgen.scene import scene_loading
from sssgen.scene.drawn_views import eye_layers, light_depth
from sssgen.scene.geometry import Mesh
from sssgen.scene.geometry_base import unit
from sssgen.scene.geometry_mesh import mesh_of
from sssgen.scene.scene import Light
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

_SCENES = {
    "jade_ring": ((320, 240), (-0.5, 0.62, -0.66), (2.3, 2.2, 2.0), (2.4, -0.6, -2.1), (8.0, 4.0, 2.0)),
    "skin_ear": ((160, 120), (0.62, 0.25, -0.75), (2.0, 1.7, 1.4), (-3.6, 2.8, -2.4), (3.0, 5.0, 20.0)),
    "marble_idol": ((240, 450), (0.72, 0.42, -0.55), (1.2, 1.0, 0.8), (-1.9, 0.7, -1.6), (1.0, 2.0, 4.0)),
    "candle": ((224, 360), (-0.8, 0.5, -0.5), (0.4, 0.5, 0.9), (0.012, 0.9, 0.0), (0.9, 0.6, 0.34)),
}
"""Example → size of the picture, direction to a light from afar, its colour, place of a lamp, its colour. The
candle's lamp is its flame."""
EXAMPLES = tuple(_SCENES)
Sky = tuple[tuple[float, float, float], tuple[float, float, float]]
ABOVE, BELOW = (0.22, 0.25, 0.3), (0.18, 0.16, 0.18)
"""The light of the sky on a white matte surface that faces up or down; it is linear in the normal between them.

They differ little, as Godot's filter flattens what differs, by 4 to 16 %."""
MIDDLE = (0.2, 0.205, 0.24)
"""Its mean."""
_SKY = (
    "vec3 sky_surroundings(world_direction N) {{ return mix(vec3{1}, vec3{0}, 0.5 + 0.5 * N.y); }}\n"
    + HEAD.format("environment")
    + "vec3 sky(world_direction N) {{ return vec3(0.0) * N.y; }}\n"
)
"""In NumPy: without what the surface reflects of it."""
_BLACK = '\n[[surface]]\ntechnique = "specular_level"\ndielectric_specular = 0.0\n'
"""Reflected light is the engine's own: the surfaces are black and without highlights."""


class SceneCase(NamedTuple):
    """A body as engines draw it."""

    material: str
    """The path of the example's material with a black surface."""
    opaque: str
    """That of this material without its translucency."""
    mesh: PlacedMesh
    vertices: Array
    """As `EngineDrawing` takes them."""
    triangles: Array
    box: tuple[Array, Array]
    """Its lowest and highest corner in the world."""
    emission: Array
    """In NumPy's float64."""
    lights: tuple[Array, ...]
    """The light that comes through from the sky, from the sun and from the lamp."""

    @property
    def expected(self) -> Array:
        """All of it."""
        total: Array = self.emission + sum(self.lights)
        return total


def scene_case(
    name: str, folder: Path, sky: Sky = (ABOVE, BELOW), halves: bool = False, powers: bool = False
) -> SceneCase:
    """One of EXAMPLES; `folder` gets its files. `halves`: passes have 16-bit floats, as Godot's have.
    `powers`: the sides of the picture are powers of two.
    """
    example = Path(shutil.copytree(ROOT / "examples" / name, folder / name))
    shutil.copytree(ROOT / "examples" / "surroundings", folder / "surroundings", dirs_exist_ok=True)
    text, count = re.subn(
        r"tint = \[.*\]", "tint = [0.0, 0.0, 0.0, 1.0]", (example / f"{name}.toml").read_text("utf-8")
    )
    assert count == 1
    black = text.replace("\n[translucency]", f"{_BLACK}\n[translucency]")
    (example / "black.toml").write_text(black, "utf-8")
    (example / "opaque.toml").write_text(black[: black.index("[translucency]")], "utf-8")
    (example / "sky.sss").write_text(_SKY.format(*sky), "utf-8")
    (example / "under_sky.toml").write_text(f'{black}\n[environment]\ntechnique = "sky.sss"\n', "utf-8")
    (width, height), *lamps = _SCENES[name]
    size = (2 ** round(math.log2(width)), 2 ** round(math.log2(height))) if powers else (width, height)
    scene = scene_loading.load(str(example / "scene.toml"))
    scene = dataclasses.replace(
        scene, material=str(example / "under_sky.toml"), lights=_lights(*lamps), size=size, samples=1,
        ambient=(0.0, 0.0, 0.0),
    )  # fmt: skip
    compiled, opaque = (sssgen.compile(one, "numpy") for one in (scene.material, str(example / "opaque.toml")))
    body = _as_mesh(scene.geometry)
    shell = shell_of(scene, load_material(scene.material), compiled.reflection)
    mesh = place_mesh(dataclasses.replace(scene, geometry=body), compiled, shell, registry.load("numpy"), size)
    mesh = mesh._replace(shell=_with_passes(mesh, body, half if halves else lambda texture: texture))

    def shaded(program: Compiled, *lights: int) -> Array:
        shown = mesh.shell.light_positions[[*lights]], mesh.shell.light_colors[[*lights]]
        shell = dataclasses.replace(mesh.shell, light_positions=shown[0], light_colors=shown[1])
        return shade_numpy.shade(without_reflection(program), shell, mesh.size, mesh.points, "float64")

    emission, dark = shaded(opaque), shaded(compiled)
    lights = dark - emission, *(shaded(compiled, number) - dark for number in range(2))
    triangles = body.triangles
    vertices = np.zeros((len(triangles.places), VERTEX_SIZE), np.float32)
    vertices[:, :3], vertices[:, 3:6] = triangles.places, triangles.normals
    materials = str(example / "black.toml"), str(example / "opaque.toml")
    box = _box(triangles.places, shell.model)
    return SceneCase(*materials, mesh, vertices, triangles.corners, box, emission, lights)


def _lights(towards: Any, distant: Any, place: Any, near: Any) -> tuple[Light, Light]:
    return Light(None, tuple(unit(np.array([towards]))[0]), distant), Light(place, None, near)


def _with_passes(placed: PlacedMesh, body: Mesh, stored: Callable[[Texture], Texture]) -> Shell:
    """The shell with the passes of the mesh."""
    shell, (width, height) = placed.shell, placed.size
    view, depth = light_depth(body, shell.light_positions[0])
    places = placed.points[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3]
    backs = eye_layers(body, np.array(shell.camera_position), unit(places - shell.camera_position), BACK_FACES)[:, 0]
    return dataclasses.replace(
        shell,
        parameters={**shell.parameters, "light_matrix": view.matrix.T.ravel()},
        textures={**shell.textures, "light_depth_map": stored(Texture(depth, wrap="clamp"))},
        screens={"back_face_map": stored(Texture(backs.reshape(height, width, 1), wrap="clamp"))},
    )


def _box(places: Array, model: Array) -> tuple[Array, Array]:
    world = places @ model[:3, :3].T + model[:3, 3]
    return world.min(axis=0), world.max(axis=0)


def _as_mesh(geometry: Any) -> Mesh:
    """The triangles of a body, where it is in the scene."""
    place = {name: getattr(geometry, name) for name in ("position", "rotation", "scale")}
    plain = dataclasses.replace(geometry, position=(0.0,) * 3, rotation=(0.0,) * 3, scale=1.0)
    return Mesh(path="body.ply", data=trimesh.Trimesh(*mesh_of(plain), process=False).export(file_type="ply"), **place)


def check_light(picture: Array, case: SceneCase, title: str, expected: Array | None = None, bound: float = 1.0) -> None:
    """The picture is that of the oracle on 99 % of the pixels of the body; `bound` is in 255ths."""
    expected = case.expected if expected is None else expected
    differences = np.abs(np.clip(picture, 0.0, 1.0) - np.clip(expected, 0.0, 1.0))[..., :3].max(axis=-1)
    reached = 255.0 * float(np.quantile(differences[case.mesh.hit], 0.99))
    print(f"{title}: {reached:.2f}/255 on 99 % of the pixels")
    assert reached <= bound
