"""The shadow of the light that comes through a body, in three.js: that of other objects, not its own."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from engine_cases import HEAD
from skips import or_skip
from slow_cases import some_slow
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EnginePage
from sssgen.run.backends.web_engines import THREE
from sssgen.run.render import page_values
from sssgen.support.diagnostics import SssgenError

SIZE = (64, 32)
LAMPS = ("directional", "point", "spot")
STEP = 1.0 / 255.0
BALL = {"shape": "ball", "position": [-0.65, 0.0, 0.0]}
SHEET = {"shape": "sheet", "position": [0.65, 0.0, 0.0], "turn": 0.3}
BETWEEN = {"position": [0.1, 0.1, -1.0], "scale": [3.0, 2.0, 1.0]}
ASIDE = {"position": [0.0, 2.4, -0.5]}
THROUGH = HEAD.format("translucency") + (
    "vec3 through(object_direction L_object, object_direction V_object) "
    "{ return 0.5 + 0.25 * abs(vec3(L_object)) + 0.25 * abs(vec3(V_object)); }\n"
)

THROUGH_MATERIAL = '[material]\nname = "made"\n[translucency]\ntechnique = "./through.sss"\n'
# it reads the pictures of all passes: back faces, and layers of the light
DRAWN_MATERIAL = """[material]
name = "drawn"
[thickness]
technique = "back_face_thickness"
[translucency]
technique = "interior_octaves"
bind = { light_path = "light_layers_path" }
extinction = [2.0, 3.0, 4.0]
"""
# it bends no ray and takes no light
CLEAR_MATERIAL = """[material]
name = "clear"
[thickness]
technique = "constant_thickness"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = 0.0
[translucency]
technique = "seen_through"
extinction = [0.0, 0.0, 0.0]
ior = 1.0
sky_below = [0.0, 0.0, 0.0]
sky_above = [0.0, 0.0, 0.0]
"""


class Scenes:
    """Pictures of scenes in one renderer, each drawn once."""

    def __init__(self, page: EnginePage, folder: Path) -> None:
        self.page = page
        (folder / "through.sss").write_text(THROUGH, encoding="utf-8")
        self.modules = {}
        for name, text in {"made": THROUGH_MATERIAL, "drawn": DRAWN_MATERIAL, "clear": CLEAR_MATERIAL}.items():
            (folder / f"{name}.toml").write_text(text, encoding="utf-8")
            self.modules[name] = page_values.modules_of(sssgen.compile(str(folder / f"{name}.toml"), "threejs"))
        self.picture = cache(self._picture)

    def draw(self, lamps: Any, *walls: Any, bodies: Any = (BALL, SHEET), shadows: bool = True, **others: Any) -> Array:
        """The light that came through; `others` are those of the page's plans."""
        lamps = [{"kind": lamps}] if isinstance(lamps, str) else lamps
        return self.picture(
            json.dumps({"lamps": lamps, "walls": walls, "bodies": bodies, "shadows": shadows, **others})
        )

    def _picture(self, scene: str) -> Array:
        plan = {"material": "made", **json.loads(scene), "renderer": self.page.name, "height": SIZE[1]}
        plan["modules"] = self.modules[plan["material"]]
        return self.page.ask(json.dumps(plan), b"", SIZE)[..., :3]


def _with_the_sun(packages: Path) -> Mapping[str, Path]:
    """What the page imports: three.js, and its light with cascades."""
    folder = packages / "three" / "examples" / "jsm" / "lights"
    sun = {f"./{name}": folder / name for name in ("SunLight.js", "SunLightShadow.js")}
    return {**THREE.modules(packages), **sun}


@pytest.fixture(scope="module", params=some_slow(THREE.renderers, "webgpu"))
def scenes(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Scenes]:
    engine = THREE._replace(script=str(Path(__file__).with_name("three_shadow_page.js")), modules=_with_the_sun)
    page: EnginePage = or_skip(partial(EnginePage, engine), request.param)
    yield Scenes(page, tmp_path_factory.mktemp("shadows"))
    page.page.close()


@pytest.mark.parametrize("lamp", LAMPS)
def test_a_wall_between_lamp_and_bodies_takes_their_light(scenes: Scenes, lamp: str) -> None:
    lit, dark = scenes.draw(lamp), scenes.draw(lamp, BETWEEN)
    assert (lit.max(axis=-1) > 0.5).sum() > 150
    assert dark.sum() < 0.1 * lit.sum()


@pytest.mark.parametrize("lamp", LAMPS)
def test_bodies_take_nothing_from_themselves(scenes: Scenes, lamp: str) -> None:
    """A ball and a sheet, which cast and receive shadows; of a two-sided body, the map has the lit side."""
    for side in ("FrontSide", "DoubleSide"):
        shadowed, free = (scenes.draw(lamp, shadows=shadows, side=side) for shadows in (True, False))
        assert np.abs(shadowed - free).max() < STEP


@pytest.mark.parametrize("lamp", LAMPS)
def test_shadow_maps_leave_the_pictures_of_passes(scenes: Scenes, lamp: str) -> None:
    """A shadow map has the colour of the body, but is drawn from the lamp; the second body starts with pictures."""
    shadowed, free = (scenes.draw(lamp, shadows=shadows, material="drawn") for shadows in (True, False))
    assert np.abs(shadowed - free).max() < STEP and (free.max(axis=-1) > 0.02).sum() > 150


@pytest.mark.parametrize("lamp", LAMPS)
def test_a_wall_elsewhere_takes_nothing(scenes: Scenes, lamp: str) -> None:
    assert np.abs(scenes.draw(lamp) - scenes.draw(lamp, ASIDE)).max() < STEP


def test_bodies_that_share_a_material_have_boxes_of_their_own(scenes: Scenes) -> None:
    """A wall close to the first of two peas, which would be inside the box of the ball that is drawn between them."""
    row = {-1.0: "pea", 0.0: "ball", 1.0: "pea"}
    bodies = [{"shape": shape, "position": [x, 0.0, 0.0]} for x, shape in row.items()]
    close = {"position": [-0.967, 0.044, -0.33], "scale": [0.5, 0.5, 1.0]}
    lit, shared, apart = (
        scenes.draw("directional", *walls, bodies=bodies, drawn=drawn)
        for walls, drawn in (([], "apart"), ([close], "shared"), ([close], "apart"))
    )
    assert np.abs(shared - apart).max() < STEP
    left, right = slice(0, SIZE[0] * 3 // 8), slice(SIZE[0] * 3 // 8, None)
    assert shared[:, left].sum() < 0.1 * lit[:, left].sum() and np.abs(shared - lit)[:, right].max() < STEP


@pytest.mark.parametrize("drawn", ["instanced", "batched"])
def test_instances_are_lit_as_bodies_of_their_own(scenes: Scenes, drawn: str) -> None:
    bodies = [
        {"shape": "sheet", "position": [-0.7, 0.0, 0.0], "scale": [0.5, 1.2, 3.0], "turn": 0.5},
        {"shape": "sheet", "position": [0.6, 0.1, 0.1], "scale": [1.1, 0.8, 1.0], "turn": -0.7},
    ]
    wall = {"position": [-0.4, 0.1, -1.0], "scale": [1.2, 2.0, 1.0]}
    own, instances = (scenes.draw("point", wall, bodies=bodies, drawn=kind) for kind in ("shared", drawn))
    half = SIZE[0] // 2
    assert own[:, :half].sum() < 0.1 * own[:, half:].sum() and own.max() > 0.5
    assert np.abs(own - instances).max() < STEP


def test_the_box_of_a_body_moves_with_its_bones(scenes: Scenes) -> None:
    own, moved = (
        scenes.draw("spot", bodies=[{"shape": "ball", "position": [x, 0.0, 0.0]}], drawn=drawn)
        for x, drawn in ((0.5, "shared"), (-0.5, "skinned"))
    )
    assert np.abs(own - moved).max() < STEP and own.max() > 0.5


def test_each_of_many_lamps_has_its_own_shadow(scenes: Scenes) -> None:
    lamps = [{"kind": kind, "position": [x, 0.4, -3.0]} for kind in LAMPS for x in (-1.0, 0.3)]
    wall = {"position": [-0.3, 0.1, -1.0], "scale": [1.0, 2.0, 1.0]}
    together, alone = scenes.draw(lamps, wall), [scenes.draw([lamp], wall) for lamp in lamps]
    assert np.abs(together - sum(alone)).max() < STEP
    assert all(0.1 < picture.sum() / scenes.draw(LAMPS[0]).sum() < 0.9 for picture in alone)


def test_a_lamp_inside_a_body_shines_through_it(scenes: Scenes) -> None:
    inside = [{"kind": "point", "position": [-0.65, 0.0, 0.1]}]
    lit, unshadowed = (scenes.draw(inside, bodies=[BALL], shadows=shadows) for shadows in (True, False))
    assert np.abs(lit - unshadowed).max() < STEP and lit.max() > 0.5


def test_a_body_that_receives_no_shadow_is_lit(scenes: Scenes) -> None:
    lit = scenes.draw("directional", shadows=False)
    assert np.abs(lit - scenes.draw("directional", BETWEEN, unreceived=True)).max() < STEP


def test_a_sun_with_cascades_in_webgl(scenes: Scenes) -> None:
    if scenes.page.name != "webgl":
        pytest.skip("WebGPURenderer's shadow of a SunLight cannot be read at a second place (docs/engines/threejs.md)")
    lit, dark = scenes.draw("sun"), scenes.draw("sun", BETWEEN)
    assert np.abs(lit - scenes.draw("sun", shadows=False)).max() < STEP and lit.max() > 0.5
    assert dark.sum() < 0.1 * lit.sum()


@pytest.mark.parametrize("kind", ["BasicShadowMap", "VSMShadowMap"])
def test_other_kinds_of_shadow_maps(scenes: Scenes, kind: str) -> None:
    lit, dark = scenes.draw("directional", shadowType=kind), scenes.draw("directional", BETWEEN, shadowType=kind)
    assert np.abs(lit - scenes.draw("directional", shadows=False)).max() < STEP
    assert dark.sum() < 0.1 * lit.sum()


def test_a_version_of_three_without_a_line_is_an_error(scenes: Scenes) -> None:
    if scenes.page.name != "webgl":
        pytest.skip("only WebGLRenderer's shader text is changed line by line; WebGPURenderer builds nodes")
    with pytest.raises(SssgenError, match=r"made: this version of three\.js has no .*vSpotLightCoord"):
        scenes.draw("directional", missing="vSpotLightCoord")
    scenes.page.restart()


def test_clear_bodies_show_what_is_behind_them(scenes: Scenes) -> None:
    """A wall whose corner is behind the middle of a ball. The clear ball behind the first is not shown."""
    wall = {"position": [-2.475, 1.5, -2.0], "scale": [3.0, 3.0, 1.0], "color": 0x40FF80}
    behind = {"shape": "pea", "position": [-0.81, 0.0, -1.0]}
    shown = scenes.draw([], wall, bodies=(BALL, behind), material="clear")
    scene = scenes.draw([], wall, bodies=({"shape": "pea", "position": [0.0, 0.0, 9.0]},), material="clear")
    middle = np.ix_((13, 18), (22, 27))
    assert np.abs(shown[middle] - scene[middle]).max() < 0.02
    assert (scene[middle].max(axis=-1) > 0.9).sum() == 1
