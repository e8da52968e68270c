"""The shadows of light that comes through a body in Godot: those of other bodies, not its own. With a Godot: slow."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest

import shadow_cases
from godot_stage import Stage
from shadow_cases import LAMP, LAMPS, LEVEL, Scene, ball, change, check_shadows, sheet, wall
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.godot_drawing import RENDERERS

pytestmark = pytest.mark.slow
BETWEEN = wall(0.4 * LAMP, 3.0)
TOWARDS = LAMP / np.linalg.norm(LAMP)
KINDS = [lamp for lamp in LAMPS if lamp != "cascades"]
OFF, SHADOWS_ONLY = 0, 3
"""Of GeometryInstance3D.ShadowCastingSetting."""


@pytest.fixture(scope="module", params=RENDERERS)
def stage(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    opened: Stage = or_skip(partial(Stage, request.param), tmp_path_factory.mktemp("stage"))
    with opened:
        yield opened


def lit(stage: Stage, lamp: str = "point", **others: Any) -> Array:
    """The light through a sheet whose lamp casts shadows; without those in the background of other bodies."""
    return Scene(stage, {}, {}, lamp).light(sheet(), **{"shadows": True, **others})


def share_left(stage: Stage, lamp: str = "point", **others: Any) -> float:
    """The share of the light that a wall before the lamp leaves."""
    free = lit(stage, lamp, shadows=False)
    seen = np.isfinite(free)
    return float(lit(stage, lamp, walls=[BETWEEN], **others)[seen].mean() / free[seen].mean())


@pytest.mark.parametrize("lamp", KINDS)
def test_other_bodies_shadow_the_light_that_comes_through(stage: Stage, lamp: str) -> None:
    """A wall does, wherever it is; the body does not, nor one of another scale, nor an instance."""
    check_shadows(Scene(stage, {}, {}, lamp))


def test_without_the_node_the_light_is_godots(stage: Stage) -> None:
    """A directional light has no shadow then, and the body darkens itself under the others."""
    assert share_left(stage, "direction", passes=False) == 1.0
    assert share_left(stage, "point", passes=False) < 0.1
    free = lit(stage, shadows=False)
    assert change(lit(stage, passes=False), free, np.isfinite(free)) > 50.0 * LEVEL


@pytest.mark.parametrize(
    ("left", "scene"),
    [
        (1.0, {"wall": {"cast_shadow": OFF}}),
        (0.0, {"wall": {"cast_shadow": SHADOWS_ONLY}}),
        (0.0, {"wall": {"layers": 2}}),
        (1.0, {"wall": {"layers": 2}, "properties": {"shadow_caster_mask": 1}}),
        (1.0, {"wall": {"visible": False}}),
        (1.0, {"surface": {"transparency": 1}}),
        (0.0, {"surface": {"transparency": 2}}),
        (0.3, {"properties": {"shadow_opacity": 0.7}}),
    ],
)
def test_settings_of_casters_and_lights(stage: Stage, left: float, scene: dict[str, Any]) -> None:
    assert share_left(stage, **scene) == pytest.approx(left, abs=0.01)


@pytest.mark.parametrize("lamp", KINDS)
def test_a_body_that_touches_another_one(stage: Stage, lamp: str) -> None:
    """On the side of the lamp it takes all, on the other side nothing."""
    scene = Scene(stage, {}, {}, lamp)
    free = scene.light(ball())
    seen = np.isfinite(free)
    before, behind = (
        scene.light(ball(), shadows=True, walls=[wall(side * 0.725 * TOWARDS, 3.0)], wall={"cast_shadow": SHADOWS_ONLY})
        for side in (1.0, -1.0)
    )
    assert before[seen].mean() < 0.01 * free[seen].mean()
    assert change(behind, free, seen) < LEVEL


def test_an_edge_is_smooth(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    """The pixels of this picture are about as large as those of the shadow."""
    monkeypatch.setattr(shadow_cases, "SIZE", (1024, 768))
    free = lit(stage, shadows=False)
    seen = np.isfinite(free)
    share = lit(stage, walls=[wall(0.4 * LAMP + 0.5 * np.array([0.9, 0.1, 0.2]), 1.0)])[seen] / free[seen]
    assert share.min() < 0.01 and share.max() > 0.99
    assert ((share > 0.05) & (share < 0.95)).sum() > 150


def test_each_of_several_lamps_has_its_own_shadow(stage: Stage) -> None:
    """The wall is before the first lamp. In Compatibility, lights with shadows add up in encoded colours."""
    if stage.godot.encodes:
        pytest.skip("Compatibility adds lights with shadows in encoded colours (docs/engines/godot.md)")
    other = [-1.6, 0.2, -2.0, 1.0]
    small = [wall(0.5 * LAMP, 0.9)]
    free = lit(stage, shadows=False)
    seen = np.isfinite(free)
    first = lit(stage, walls=small)
    both, both_free = lit(stage, walls=small, lamps=[other]), lit(stage, lamps=[other], shadows=False)
    assert first[seen].mean() < 0.5 * free[seen].mean()
    assert change(both - first, both_free - free, seen) < LEVEL


def test_a_fifth_lamp_has_godots_shadow(stage: Stage) -> None:
    """Four lamps from afar are brighter at the body; of the fifth, the body's own shadow stays."""
    if stage.godot.encodes:
        pytest.skip("Compatibility adds lights with shadows in encoded colours (docs/engines/godot.md)")
    dim = {"light_energy": 0.3}
    distant = [[x, 0.8, -3.0, 0.0] for x in (-2.0, -1.0, 1.6, 2.6)]
    alone = lit(stage, properties=dim, passes=False)
    seen = np.isfinite(alone)
    others = 4.0 * lit(stage, "direction", properties=dim)
    assert change(lit(stage, lamps=distant, properties=dim), others + alone, seen) < LEVEL
    assert change(alone, lit(stage, properties=dim), seen) > 5.0 * LEVEL
