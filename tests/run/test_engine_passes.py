"""Engines draw the passes of a material themselves: pictures of the body alone, seen from the eye and from lights."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import sssgen
from engine_cases import mesh_of, through
from folders import ROOT
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import BABYLON, THREE
from sssgen.run.render import page_values
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus

BLACK = {
    "threejs": {"color": 0.0, "specularIntensity": 0.0},
    "babylonjs": {"albedoColor": 0.0, "metallicF0Factor": 0.0},
}
"""Without the engine's own reflection."""


@pytest.fixture(scope="module", params=[(engine, name) for engine in (THREE, BABYLON) for name in engine.renderers])
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    renderer: EnginePage = or_skip(partial(EnginePage, request.param[0]), request.param[1])
    yield renderer
    renderer.page.close()


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


def torus_scene(folder: Path, several: bool) -> str:
    """The material of the scene of jade_ring in `folder`; with several lights it has a map for each."""
    example = ROOT / "examples/jade_ring"
    material = (example / "jade_ring.toml").read_text(encoding="utf-8")
    scene = (example / "scene.toml").read_text(encoding="utf-8").replace('"jade_ring"', '"jade.toml"')
    if several:
        material, scene = material.replace("depth_map_path", "light_layers_path"), scene + SEVERAL
    (folder / "jade.toml").write_text(material, encoding="utf-8")
    (folder / "scene.toml").write_text(scene[: scene.index("[shell]")] + scene[scene.index("[geometry]") :])
    return str(folder / "scene.toml")


@pytest.fixture(scope="module", params=["one light", "several lights"])
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, PlacedMesh, Array]:
    """A scene with the mesh of its points, and the light that comes through by the oracle."""
    path = torus_scene(tmp_path_factory.mktemp("torus"), request.param == "several lights")
    mesh = mesh_of(path)
    return path, mesh, through(str(Path(path).with_name("jade.toml")), mesh)


def test_the_engine_draws_the_passes(page: EnginePage, case: tuple[str, PlacedMesh, Array]) -> None:
    """Without textures from the page, the light that comes through is that of the oracle."""
    path, mesh, expected = case
    scene = scene_loading.load(path)
    assert isinstance(scene.geometry, Torus)
    vertices, triangles = torus_mesh(scene.geometry)
    compiled = sssgen.compile(scene.material, page.engine.target)
    drawing = EngineDrawing(
        page_values.modules_of(compiled), mesh.size, vertices, triangles, mesh.shell.view_projection,
        mesh.shell.camera_position, mesh.shell.model, mesh.shell.light_positions, mesh.shell.light_colors,
        properties=BLACK[page.engine.target],
    )  # fmt: skip
    drawn = page.draw(drawing)
    inner = mesh.hit.copy()  # without the pixels at the edge, where triangles replace the round body
    for axis, step in ((0, -1), (0, 1), (1, -1), (1, 1)):
        inner &= np.roll(mesh.hit, step, axis)
    difference = np.abs(drawn - expected)[..., :3][inner].max(axis=-1)
    print(page.name, np.quantile(difference, [0.5, 0.9, 0.98, 1.0]) * 255)
    # the oracle's depths are half floats, so that every back end has the same
    assert np.quantile(difference, 0.98) < 1.0 / 255.0 and expected[..., :3][inner].mean() > 0.05
