"""Engines draw the passes of a material themselves: pictures of the body alone, seen from the eye and from lights."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from engine_cases import half_as_large, mesh_of, through
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.run.render import page_values
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from torus_cases import SEVERAL, inner_pixels, torus_mesh, torus_scene

BLACK: dict[str, dict[str, Any]] = {
    "threejs": {"color": 0.0, "specularIntensity": 0.0},
    "babylonjs": {"albedoColor": 0.0, "metallicF0Factor": 0.0},
    "playcanvas": {"diffuse": 0.0, "useMetalness": False, "specular": 0.0, "enableGGXSpecular": False},
}
"""Without the engine's own reflection."""


ENGINES = {engine.target: engine for engine in (THREE, BABYLON, PLAYCANVAS)}
RENDERERS = [(target, name) for target, engine in ENGINES.items() for name in engine.renderers]


@pytest.fixture(scope="module")
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target]), name)
    yield renderer
    renderer.page.close()


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
        path = torus_scene(tmp_path_factory.mktemp("torus"), SEVERAL if several else "")
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
    inner = inner_pixels(mesh.hit)
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


@pytest.mark.parametrize("page", [("threejs", name) for name in THREE.renderers], ids="-".join, indirect=True)
def test_values_of_the_object_come_from_its_matrix(page: EnginePage) -> None:
    """wax_mouse half as large and in another place: the page sets no scale."""
    (mesh, half), compiled = half_as_large("wax_mouse"), sssgen.compile("wax_mouse", "threejs")
    own, shell = mesh.shell, half.shell
    assert shell.unplaced(compiled.reflection["uniforms"])["object_scale"] == pytest.approx([1.0])
    drawn = page_values.shade(compiled, shell, page, mesh.size, mesh.points, BLACK["threejs"])
    expected, whole = (through("wax_mouse", mesh._replace(shell=one)) for one in (shell, own))
    assert np.abs(drawn - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert np.abs(whole - expected)[..., :3][mesh.hit].max() > 0.02, "the size matters"
