"""Engines draw what a white matt body reflects of their own light, and the material spreads it under its surface."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import BLACK, mesh_of, through
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.run.render import page_values
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from torus_cases import inner_pixels, torus_mesh

MATERIAL = """
[material]
name = "skin"

[[surface]]
technique = "base_color"
tint = [0.8, 0.6, 0.5, 1.0]

[[surface]]
technique = "screen_diffusion"
spread_length = [0.06, 0.03, 0.02]
"""
SCENE = """
material = "skin.toml"

[geometry]
kind = "torus"
major = 0.8
minor = 0.35
rotation = [65, 0, 0]

[camera]
position = [0.2, 0.5, 4.0]

# along the axis of the ring: the part that faces the light has no shadow
[[light]]
direction = [0.0, 0.42261826, 0.90630779]
color = [0.9, 0.8, 0.7]
"""
ENGINES = {engine.target: engine for engine in (THREE, BABYLON, PLAYCANVAS)}
RENDERERS = [(target, name) for target, engine in ENGINES.items() for name in engine.renderers]


@pytest.fixture(scope="module", params=RENDERERS, ids="-".join)
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target]), name)
    yield renderer
    renderer.page.close()


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("diffusion")
    (folder / "skin.toml").write_text(MATERIAL, encoding="utf-8")
    (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
    return str(folder / "scene.toml")


def drawn(page: EnginePage, path: str, **properties: Any) -> tuple[Array, Array, Array]:
    """What the engine draws, what NumPy does, and the body's pixels but those at its edge."""
    scene = scene_loading.load(path)
    assert isinstance(scene.geometry, Torus)
    vertices, triangles = torus_mesh(scene.geometry)
    compiled = sssgen.compile(scene.material, page.engine.target)
    mesh = mesh_of(path)
    shell = mesh.shell
    drawing = EngineDrawing(
        page_values.modules_of(compiled), mesh.size, vertices, triangles, shell.view_projection, shell.camera_position,
        shell.model, shell.light_positions, shell.light_colors, properties=BLACK[page.engine.target] | properties,
    )  # fmt: skip
    expected = through(str(Path(path).with_name("skin.toml")), mesh)
    return page.draw(drawing)[..., :3], expected[..., :3], inner_pixels(mesh.hit)


def test_the_engine_draws_the_light_that_spreads(page: EnginePage, scene: str) -> None:
    picture, expected, inner = drawn(page, scene)
    assert expected[inner].mean() > 0.05
    for _ in range(3):  # the edges of bodies have other texels on each side
        inner = inner_pixels(inner)
    difference = np.abs(picture - expected)[inner].max(axis=-1)
    print(np.quantile(difference, [0.5, 0.9, 0.98, 1.0]) * 255)
    assert np.quantile(difference, 0.98) < 1.0 / 255.0
