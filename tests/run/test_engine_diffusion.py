"""Engines draw what a white matt body reflects of their own light, and the material spreads it under its surface."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from diffusion_cases import MATERIAL, SCENE, WAY, wall
from engine_cases import BLACK, ENGINES, mesh_of, pages, through
from shadow_cases import EYE, LEVEL, SIZE, ball, view_projection
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import page_values
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from torus_cases import inner_pixels, torus_mesh

COLORS = ("color", "albedoColor", "diffuse")


@pytest.fixture(scope="module", params=pages(("babylonjs", "webgl")))
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


def compared_pictures(page: EnginePage, path: str, **properties: Any) -> tuple[Array, Array, Array]:
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
    picture, expected, inner = compared_pictures(page, scene)
    assert expected[inner].mean() > 0.05
    for _ in range(3):  # the edges of bodies have other texels on each side
        inner = inner_pixels(inner)
    difference = np.abs(picture - expected)[inner].max(axis=-1)
    # filters on the CPU place texels by fractions of 1 / 256
    assert np.quantile(difference, 0.98) < 2.0 * LEVEL


def ball_picture(page: EnginePage, text: str, folder: Path, **stage: Any) -> Array:
    """A ball of a material's text under a lamp, without highlights, in a stage: (height, width, 3)."""
    path = folder / "skin.toml"
    path.write_text(text, encoding="utf-8")
    compiled = sssgen.compile(str(path), page.engine.target)
    body = ball()
    matt = {name: value for name, value in BLACK[page.engine.target].items() if name not in COLORS}
    drawing = EngineDrawing(
        page_values.modules_of(compiled), SIZE, body.vertices.astype(np.float32), body.triangles, view_projection(),
        EYE, body.model, np.array([[*WAY, 0.0]]), np.ones((1, 3)), properties={**matt, "stage": stage},
    )  # fmt: skip
    return page.draw(drawing)[..., :3]


@pytest.mark.slow
@pytest.mark.parametrize("stage", [{"around": "environment"}, {"shadows": True}, {"shadows": True, "walls": [wall()]}],
                         ids=["environment", "own shadow", "wall"])  # fmt: skip
def test_light_that_does_not_spread_is_the_engines_own(page: EnginePage, stage: dict[str, Any], tmp_path: Path) -> None:
    """A spread of 0 leaves the diffuse reflection of the engine, with its shadows and surroundings."""
    plain = MATERIAL[: MATERIAL.rindex("[[surface]]")]
    own = ball_picture(page, plain, tmp_path, **stage)
    spread = ball_picture(page, MATERIAL.replace("[0.06, 0.03, 0.02]", "[0.0, 0.0, 0.0]"), tmp_path, **stage)
    unlit = ball_picture(page, plain, tmp_path)
    inner = inner_pixels(unlit.max(axis=-1) > 0.02)
    assert own[inner].mean() > 0.05
    if "walls" in stage:
        assert own[inner].mean() < 0.9 * unlit[inner].mean()
    # the picture is filtered: at the edge of a shadow a pixel has a little of its neighbours
    assert np.quantile(np.abs(spread - own)[inner].max(axis=-1), 0.96) < 2.0 * LEVEL
