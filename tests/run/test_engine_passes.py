"""Engines draw the passes of a material themselves: pictures of the body alone, seen from the eye and from lights."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import mesh_of, through
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import PLAYCANVAS, THREE
from sssgen.run.render import page_values
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from torus_cases import SEVERAL, inner_pixels, torus_mesh, torus_scene

RENDERERS = {f"{engine.target} {name}": (engine, name) for engine in (THREE, PLAYCANVAS) for name in engine.renderers}
BLACK: dict[str, dict[str, Any]] = {
    "threejs": {"color": 0.0, "specularIntensity": 0.0},
    "playcanvas": {"diffuse": 0.0, "useMetalness": False, "specular": 0.0, "enableGGXSpecular": False},
}
"""Without the engine's own reflection."""


@pytest.fixture(scope="module", params=RENDERERS)
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    engine, name = RENDERERS[request.param]
    renderer: EnginePage = or_skip(partial(EnginePage, engine), name)
    yield renderer
    renderer.page.close()


@pytest.fixture(scope="session", params=["one light", "several lights"])
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, PlacedMesh, Array]:
    """A scene with the mesh of its points, and the light that comes through by the oracle."""
    path = torus_scene(tmp_path_factory.mktemp("torus"), SEVERAL if request.param == "several lights" else "")
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
    inner = inner_pixels(mesh.hit)
    difference = np.abs(drawn - expected)[..., :3][inner].max(axis=-1)
    # the oracle's depths are half floats, so that every back end has the same
    assert np.quantile(difference, 0.98) < 1.0 / 255.0 and expected[..., :3][inner].mean() > 0.05


def test_values_of_the_object_come_from_its_matrix(three: EnginePage) -> None:
    """wax_mouse half as large and in another place: the page sets no scale."""
    mesh, compiled = mesh_of("wax_mouse"), sssgen.compile("wax_mouse", "threejs")
    moved = np.diag([0.5, 0.5, 0.5, 1.0])
    moved[:3, 3] = [0.3, -0.2, 0.1]
    own = mesh.shell
    shell = dataclasses.replace(
        own,
        model=moved @ own.model,
        camera_position=tuple(moved[:3, :3] @ own.camera_position + moved[:3, 3]),
        view_projection=own.view_projection @ np.linalg.inv(moved),
        parameters={**own.parameters, "object_scale": (0.5 * own.parameters["object_scale"][0],)},
        ambient=(0.0, 0.0, 0.0),
    )
    assert shell.unplaced(compiled.reflection["uniforms"])["object_scale"] == pytest.approx([1.0])
    drawn = page_values.shade(compiled, shell, three, mesh.size, mesh.points, BLACK)
    expected, whole = (through("wax_mouse", mesh._replace(shell=one)) for one in (shell, own))
    assert np.abs(drawn - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert np.abs(whole - expected)[..., :3][mesh.hit].max() > 0.02, "the size matters"
