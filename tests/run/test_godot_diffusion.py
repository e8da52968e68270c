"""Godot's node draws what a white matt body reflects, and the material spreads it. With a Godot: slow."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from diffusion_cases import PLAIN, SCENE, SPREAD, WAY, wall
from engine_cases import mesh_of, through
from godot_stage import Stage
from shadow_cases import EYE, LEVEL, SIZE, ball, scaled, view_projection
from skips import or_skip
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import EngineDrawing
from sssgen.run.backends.godot_drawing import RENDERERS, Godot
from sssgen.run.compilers import Compiler
from sssgen.run.render import eye_pictures, godot_values
from sssgen.scene import scene_loading
from sssgen.scene.drawn_views import matt_light
from sssgen.scene.solids import Torus
from torus_cases import inner_pixels, torus_mesh

pytestmark = pytest.mark.slow
STILL, SPREADING = (PLAIN + SPREAD.format(lengths) for lengths in ("0.0, 0.0, 0.0", "0.06, 0.03, 0.02"))
OFF = {"cast_shadow": 0}
"""A wall without a shadow."""


@pytest.fixture(scope="module", params=RENDERERS)
def stage(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    opened: Stage = or_skip(partial(Stage, request.param), tmp_path_factory.mktemp("stage"))
    with opened:
        yield opened


@pytest.fixture
def picture(stage: Stage, tmp_path: Path) -> Callable[..., Array]:
    """A ball of a material's text under a lamp in a stage: (height, width, 3)."""

    def draw(text: str, lamp: str = "direction", energy: float = 1.0, **others: Any) -> Array:
        # the stage takes the script of a material m
        (tmp_path / "m.toml").write_text(text.replace('"skin"', '"m"'), encoding="utf-8")
        compiled = sssgen.compile(str(tmp_path / "m.toml"), "godot")
        stage.show(compiled, compiled.files["m.gdshader"])
        place = [*WAY, 0.0] if lamp == "direction" else [*(5.0 * WAY), 1.0]
        shown = {"passes": text != PLAIN, "properties": {"light_energy": energy}, **others}
        body = ball()
        drawing = EngineDrawing(
            {}, SIZE, body.vertices.astype(np.float32), body.triangles, view_projection(), EYE, body.model,
            np.array([place]), np.ones((1, 3)), properties={"stage": shown},
        )  # fmt: skip
        return stage.draw(drawing)[..., :3]

    return draw


@pytest.mark.parametrize(
    "shown",
    [
        {"sky": [0, 1, 0]},
        {"sky": "#808080"},
        {"shadows": True},
        {"shadows": True, "walls": [wall()]},
        {"shadows": True, "walls": [wall()], "lamp": "point", "energy": 9.0},
        {"shadows": True, "walls": [wall()], "lamp": "spot", "spot": 1.2, "energy": 9.0},
    ],
    ids=["sky", "ambient", "own shadow", "wall", "wall, point", "wall, spot"],
)
def test_light_that_does_not_spread_is_godots(picture: Callable[..., Array], shown: dict[str, Any]) -> None:
    """A spread of 0 leaves the diffuse reflection of Godot, with its shadows and surroundings."""
    own, spread = picture(PLAIN, **shown), picture(STILL, **shown)
    free = picture(PLAIN, **{**shown, "shadows": False, "walls": []})
    inner = inner_pixels(free.max(axis=-1) > 0.02)
    assert own[inner].mean() > 0.05
    if "walls" in shown:
        assert own[inner].mean() < 0.95 * free[inner].mean()
    difference = np.abs(spread - own)[inner].max(axis=-1)
    print(f"{255.0 * np.quantile(difference, 0.96):.2f}/255 on 96 % of the pixels")
    assert np.quantile(difference, 0.96) < 2.0 * LEVEL


def test_a_lamp_with_a_shadow_and_a_sky(picture: Callable[..., Array], stage: Stage) -> None:
    """Compatibility adds both in encoded colours, those of the white body otherwise than those of the body."""
    shown = {"sky": "#404040", "shadows": True, "walls": [wall()], "energy": 0.2}
    own, spread = picture(PLAIN, **shown), picture(STILL, **shown)
    inner = inner_pixels(picture(PLAIN).max(axis=-1) > 0.02)
    difference = np.abs(spread - own)[inner].max(axis=-1)
    print(f"{255.0 * np.quantile(difference, 0.96):.2f}/255 on 96 % of the pixels")
    assert own[inner].max() < 1.0
    assert np.quantile(difference, 0.96) < (8.0 if stage.godot.encodes else 1.0) * LEVEL


def test_without_the_node_the_reflection_is_godots(picture: Callable[..., Array]) -> None:
    assert np.abs(picture(SPREADING, passes=False) - picture(PLAIN)).max() < LEVEL


def test_other_bodies_are_not_in_the_picture(picture: Callable[..., Array]) -> None:
    """A body before the eye hides a part, and leaves the light on the rest; so does one with a node of its own."""
    alone = picture(SPREADING, passes=True)
    seen = inner_pixels(alone.max(axis=-1) > 0.02)
    before = np.diag([0.3, 3.0, 0.1, 1.0])
    before[:3, 3] = [-0.35, 0.0, 2.0]
    hidden = picture(SPREADING, walls=[[*map(float, before.T.ravel())]], wall=OFF)
    beside = scaled(1.0, np.array([-0.89, 0.0, 0.9]))
    pair = picture(SPREADING, copies=[{"size": 1.0, "model": [*map(float, beside.T.ravel())]}])
    for shown in (hidden, pair):
        changed = np.abs(shown - alone).max(axis=-1)
        free = seen & (np.arange(SIZE[0]) > 0.5 * SIZE[0] - 3)
        assert (changed[seen] > 20.0 * LEVEL).any(), "the other body is seen"
        print(f"{255.0 * changed[free].max():.2f}/255 of {free.sum()} pixels")
        assert free.sum() > 80 and changed[free].max() < LEVEL


@pytest.mark.parametrize("renderer", RENDERERS)
def test_godot_draws_the_light_that_spreads(
    renderer: str, tmp_path: Path, compiler: Callable[[str], Compiler], monkeypatch: pytest.MonkeyPatch
) -> None:
    """NumPy's light has the falloff of Godot's white body."""
    compiler("godot")
    (tmp_path / "skin.toml").write_text(SPREADING, encoding="utf-8")
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    monkeypatch.setattr(eye_pictures, "matt_light", _burley)
    scene, mesh = scene_loading.load(str(tmp_path / "scene.toml")), mesh_of(str(tmp_path / "scene.toml"))
    assert isinstance(scene.geometry, Torus)
    compiled = sssgen.compile(scene.material, "godot")
    view = godot_values.view_of(mesh.shell, mesh.size, *torus_mesh(scene.geometry))
    scripts = {name: text for name, text in compiled.files.items() if name.endswith(".gd")}
    values = godot_values.values_of(compiled.reflection, dataclasses.replace(mesh.shell, parameters={}))
    drawn = Godot(renderer).draw(compiled.files["skin.gdshader"], view, values, {}, scripts)[::-1]
    expected = through(str(tmp_path / "skin.toml"), mesh)
    inner = mesh.hit
    for _ in range(4):  # the edges of bodies have other texels on each side
        inner = inner_pixels(inner)
    assert expected[inner].mean() > 0.05
    difference = np.abs(drawn - expected)[inner][:, :3].max(axis=-1)
    print(f"{renderer}: {255.0 * np.quantile(difference, 0.98):.2f}/255 on 98 % of the pixels")
    assert np.quantile(difference, 0.98) < 2.0 * LEVEL


def _burley(geometry: Any, points: Array, normals: Array, lights: Array, colors: Array) -> Array:
    """`matt_light` with Burley's diffuse reflection of roughness 0.5, as Godot has it, under one light from afar."""
    ((x, y, z, w),) = lights
    assert w == 0.0
    towards, eye = np.array([x, y, z]), np.array([0.2, 0.5, 4.0]) - points
    eye /= np.linalg.norm(eye, axis=1, keepdims=True)
    half = eye + towards
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    grazing = (half @ towards) ** 2 - 0.5
    result = matt_light(geometry, points, normals, lights, colors)
    for cosines in (normals @ towards, np.einsum("nc,nc->n", normals, eye)):
        result *= (1.0 + grazing * np.clip(1.0 - cosines, 0.0, 1.0) ** 5)[:, None]
    return result
