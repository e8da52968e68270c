"""Engines draw the passes of a material themselves: pictures of the body alone, seen from the eye and from lights."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

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


ENGINES = {engine.target: engine for engine in (THREE, BABYLON)}
RENDERERS = [(target, name) for target, engine in ENGINES.items() for name in engine.renderers]


@pytest.fixture(scope="module")
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target]), name)
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


class Case(NamedTuple):
    """A scene with the mesh of its points."""

    path: str
    mesh: PlacedMesh
    expected: Array
    """The light that comes through by the oracle."""


@pytest.fixture(scope="module")
def case_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[bool], Case]:
    """The scene with one light or with several."""

    @cache
    def case(several: bool) -> Case:
        path = torus_scene(tmp_path_factory.mktemp("torus"), several)
        mesh = mesh_of(path)
        return Case(path, mesh, through(str(Path(path).with_name("jade.toml")), mesh))

    return case


def differences(page: EnginePage, case: Case, **properties: Any) -> Array:
    """Of the light that comes through from that of the oracle, in each pixel but those at the edge."""
    scene = scene_loading.load(case.path)
    assert isinstance(scene.geometry, Torus)
    vertices, triangles = torus_mesh(scene.geometry)
    compiled = sssgen.compile(scene.material, page.engine.target)
    mesh, shell = case.mesh, case.mesh.shell
    drawing = EngineDrawing(
        page_values.modules_of(compiled), mesh.size, vertices, triangles, shell.view_projection, shell.camera_position,
        shell.model, shell.light_positions, shell.light_colors, properties=BLACK[page.engine.target] | properties,
    )  # fmt: skip
    drawn = page.draw(drawing)
    inner = mesh.hit.copy()  # at the edge, triangles replace the round body
    for axis, step in ((0, -1), (0, 1), (1, -1), (1, 1)):
        inner &= np.roll(mesh.hit, step, axis)
    assert case.expected[..., :3][inner].mean() > 0.05
    result: Array = np.abs(drawn - case.expected)[..., :3][inner].max(axis=-1)
    return result


@pytest.mark.parametrize("several", [False, True], ids=["one light", "several lights"])
@pytest.mark.parametrize("page", RENDERERS, ids="-".join, indirect=True)
def test_the_engine_draws_the_passes(page: EnginePage, several: bool, case_of: Callable[[bool], Case]) -> None:
    """Without textures from the page, the light that comes through is that of the oracle."""
    # the oracle's depths are half floats, so that every back end has the same
    assert np.quantile(differences(page, case_of(several)), 0.98) < 1.0 / 255.0


ELSEWHERE = {"size": 2.0, "model": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 3, -5, 1]}
"""A copy of the body."""


@pytest.mark.parametrize("page", [("babylonjs", name) for name in BABYLON.renderers], ids="-".join, indirect=True)
@pytest.mark.parametrize("stage", [{"leftHanded": True}, {"copies": [ELSEWHERE]}], ids=["left-handed", "two bodies"])
def test_other_scenes(page: EnginePage, stage: dict[str, Any], case_of: Callable[[bool], Case]) -> None:
    """A left-handed scene, which is Babylon's default; a second body of the material, with pictures of its own."""
    assert np.quantile(differences(page, case_of(False), stage=stage), 0.98) < 1.0 / 255.0
