"""The light of the surroundings that comes through a body in Godot. With a Godot: slow."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest

from godot_stage import Stage
from shadow_cases import EYE, SIZE, ball, view_projection
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing
from sssgen.run.backends.godot_drawing import RENDERERS
from surroundings_cases import BOTH_SIDES, normals

pytestmark = pytest.mark.slow
BLACK = '[[surface]]\ntechnique = "base_color"\ntint = [0.0, 0.0, 0.0, 1.0]\n'
"""So that the surface reflects none of the light."""


@pytest.fixture(scope="module", params=RENDERERS)
def stage(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    folder = tmp_path_factory.mktemp("sky")
    opened: Stage = or_skip(partial(Stage, request.param, technique=BOTH_SIDES, surface=BLACK), folder)
    with opened:
        yield opened


def picture(stage: Stage, **others: Any) -> Array:
    body, place = ball(), np.array([[0.0, 0.0, -3.0, 0.0]])
    properties = {"stage": {"properties": {"light_energy": 0.0}, **others}}
    drawn = stage.draw(
        EngineDrawing({}, SIZE, body.vertices.astype(np.float32), body.triangles, view_projection(), EYE, body.model,
                      place, np.zeros((1, 3)), properties=properties)
    )  # fmt: skip
    return drawn[::-1]  # row 0 at the bottom, as `normals` has it


def test_an_ambient_colour_comes_through(stage: Stage) -> None:
    """Red has the light in front of the surface, green the one behind it. Without the node there is none."""
    lit = picture(stage, sky="#ffffff")
    seen = lit[..., 3] > 0.5
    assert seen.sum() > 200
    assert np.abs(lit[seen][:, :3] - (1.0, 1.0, 0.0)).max() < 0.01
    assert np.abs(picture(stage, sky="#ffffff", passes=False)[seen][:, :3]).max() < 0.01


@pytest.mark.parametrize("way", [(0, 1, 0), (0, -1, 0), (1, 0, 0), (0, 0, 1), (0, 0, -1)])
def test_a_sky_comes_through(stage: Stage, way: tuple[int, int, int]) -> None:
    """Its half towards a direction is white: that of a matte surface is (1 + cos) / 2."""
    lit = picture(stage, sky=way)
    seen = lit[..., 3] > 0.5
    facing = np.array(way) @ normals(seen)
    front, behind = lit[seen][:, :2].T
    assert np.abs(front - (0.5 + 0.5 * facing)).max() < 0.1
    assert np.abs(behind - (0.5 - 0.5 * facing)).max() < 0.1


def test_passes_add_no_light_to_a_scene_without_an_environment(stage: Stage) -> None:
    """The Compatibility renderer would show the ambient light of the camera before, that of a pass."""
    wall = [9.0, 0.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -2.0, 1.0]
    lamp = {"shadows": True, "properties": {"light_energy": 1e-4}}
    assert picture(stage, bare=True, walls=[wall], **lamp)[..., :3].max() < 0.01
