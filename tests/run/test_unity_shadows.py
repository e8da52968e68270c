"""In URP the shadows of other bodies take the light that comes through a body, and its own does not.

The shadow map of the stand-in headers has the body, a ball or two boxes, as Unity's own has it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.run.backends import Array, Backend
from sssgen.scene.scene_loading import parse_scene
from unity_engine import drawing

NEWEST = 60000100
WITH_BOX = [NEWEST, pytest.param(202220, marks=pytest.mark.slow)]
"""UNITY_VERSION of versions with the box of a renderer, and with each keyword of lists of lights."""
LISTED = {NEWEST: "_CLUSTER_LIGHT_LOOP=1", 202220: "_FORWARD_PLUS=1"}
SUN = "[[light]]\ndirection = [0.3, 0.1, -1.0]\ncolor = [0.9, 0.8, 0.7]\n"
LAMP = "[[light]]\nposition = [0.6, 0.2, -3.0]\ncolor = [9.0, 8.0, 7.0]\n"
LIGHTS = {"sun": SUN, "lamp": LAMP}
Wall = tuple[list[float], list[float]]
WALL: Wall = ([-4.0, -4.0, -2.2], [4.0, 4.0, -2.0])
BEHIND_LAMP: Wall = ([-4.0, -4.0, -3.4], [4.0, 4.0, -3.2])
AT_SIDE: Wall = ([2.0, -4.0, -2.5], [2.2, 4.0, 4.0])
IN_FRONT: Wall = ([-4.0, -4.0, 1.5], [4.0, 4.0, 1.7])
NO_WALL: Wall = ([0.0] * 3, [0.0] * 3)
BALL: dict[str, Any] = {
    "geometry": '[geometry]\nkind = "ball"\n',
    "caster": {"standin_ball": [0.0, 0.0, 0.0, 1.0]},
    "box": ([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]),
}
THIN: dict[str, Any] = {
    "geometry": '[geometry]\nkind = "slab"\n',
    "caster": {},
    "box": ([-1.0, -1.0, -0.05], [1.0, 1.0, 0.05]),
}
BODIES = {"ball": BALL, "thin body": THIN}
LET_THROUGH = """/** Half of it.
role: translucency
*/
vec3 let_through(world_direction L) {
    return vec3(0.5) + 0.0 * L;
}
"""


@pytest.fixture
def through(backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., Array]:
    """`through(body, lights, version, wall, …)`: the light that comes through a body, which casts a shadow, too."""
    draw = drawing(backend("unity-urp"), monkeypatch)
    (tmp_path / "let_through.sss").write_text(LET_THROUGH, encoding="utf-8")
    material = '[material]\nname = "let_through"\nshading = "lit"\n[translucency]\ntechnique = "let_through.sss"\n'
    (tmp_path / "let_through.toml").write_text(material, encoding="utf-8")

    def picture(
        body: dict[str, Any], lights: str, version: int, wall: Wall = NO_WALL, strength: float = 1.0,
        box: Wall | None = None, keywords: tuple[str, ...] = (), **values: Any,
    ) -> Array:  # fmt: skip
        text = f'material = "let_through.toml"\nsamples = 1\nambient = [0, 0, 0]\n{body["geometry"]}{lights}'
        low, high = body["box"] if box is None else box
        own = body["box"] if not body["caster"] else NO_WALL
        engine = {
            "unity_RendererBounds_Min": [*low, 0.0],
            "unity_RendererBounds_Max": [*high, 0.0],
            "_MainLightShadowParams": [strength, 0.0, 0.0, 0.0],
            "_AdditionalShadowParams": [[strength, 0.0, 0.0, 0.0]] * 2,
            "standin_box_min": [[*wall[0], 0.0], [*own[0], 0.0]],
            "standin_box_max": [[*wall[1], 0.0], [*own[1], 0.0]],
        }
        described = parse_scene(text, tmp_path / "scene.toml")
        return draw(described, version, keywords, **{**engine, **body["caster"], **values})

    return picture


@pytest.mark.parametrize("version", WITH_BOX)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("lights", LIGHTS.values(), ids=LIGHTS)
def test_a_wall_before_the_body(through: Callable[..., Array], body: dict[str, Any], lights: str, version: int) -> None:
    lit, behind_wall = through(body, lights, version), through(body, lights, version, WALL)
    assert lit.max() > 0.2
    assert behind_wall.sum() <= 0.1 * lit.sum()


@pytest.mark.parametrize("version", WITH_BOX)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_a_body_alone_and_a_wall_elsewhere(through: Callable[..., Array], body: dict[str, Any], version: int) -> None:
    """They are as bright as without shadows; at the surface itself the body's shadow takes all, which is the reason."""
    unshadowed = through(body, SUN + LAMP, version, strength=0.0)
    for wall in (NO_WALL, AT_SIDE, IN_FRONT):
        assert np.abs(through(body, SUN + LAMP, version, wall) - unshadowed).max() < 1.0 / 255.0
    at_the_surface = through(body, SUN + LAMP, version, _TransmissionShadowOffset=1e-3)
    assert at_the_surface.sum() < 0.1 * unshadowed.sum()


@pytest.mark.parametrize("version", WITH_BOX)
def test_each_light_has_its_own_shadow(through: Callable[..., Array], version: int) -> None:
    """With lists of lights per part of the screen, too: there the directional ones, here the second sun, come first."""
    lights, none, full = SUN + SUN.replace("0.3", "-0.3") + LAMP, [0.0] * 4, [1.0, 0.0, 0.0, 0.0]
    for keywords in ((), (LISTED[version],)):
        given: dict[str, Any] = {"keywords": keywords, "_FPParams0": [0, 0, 0, 1]}
        pictures = [
            through(
                BALL,
                lights,
                version,
                WALL,
                _MainLightShadowParams=main,
                _AdditionalShadowParams=[second, lamp],
                **given,
            )
            for main, second, lamp in ((full, none, none), (none, full, none), (none, none, full))
        ]
        unshadowed = through(BALL, lights, version, WALL, 0.0, **given)
        taken = [unshadowed - picture for picture in pictures]
        np.testing.assert_allclose(sum(taken), unshadowed, atol=1e-4)
        assert min(part.max() for part in taken) > 0.1


def test_a_lamp_in_the_box_is_not_passed(through: Callable[..., Array]) -> None:
    """A wall behind it is in the box, too, and takes nothing."""
    box: Wall = ([-5.0, -5.0, -5.0], [5.0, 5.0, 5.0])
    unshadowed = through(BALL, LAMP, NEWEST, strength=0.0)
    for wall in (NO_WALL, BEHIND_LAMP):
        assert np.abs(through(BALL, LAMP, NEWEST, wall, box=box) - unshadowed).max() < 1.0 / 255.0


@pytest.mark.parametrize("version", [202120, NEWEST])
def test_without_a_box_the_property_says_where(through: Callable[..., Array], version: int) -> None:
    """URP 12 and 13 have no box, and a renderer may have an empty one: shadows are read where the property says."""
    unshadowed = through(BALL, SUN, version, strength=0.0)
    assert np.array_equal(through(BALL, SUN, version, WALL, box=NO_WALL), unshadowed)
    given: dict[str, Any] = {"box": NO_WALL, "_TransmissionShadowOffset": 2.1}
    assert np.abs(through(BALL, SUN, version, **given) - unshadowed).max() < 1.0 / 255.0
    assert through(BALL, SUN, version, BEHIND_LAMP, **given).sum() <= 0.1 * unshadowed.sum()


def test_screen_space_shadows_say_nothing(through: Callable[..., Array]) -> None:
    unshadowed = through(BALL, SUN, NEWEST, strength=0.0)
    assert np.array_equal(through(BALL, SUN, NEWEST, WALL, keywords=("_MAIN_LIGHT_SHADOWS_SCREEN=1",)), unshadowed)
