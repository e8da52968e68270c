"""The page in a headless Chromium: it shows the examples, changes with the files and by hand, and saves."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folders import ROOT
from preview_page import NEEDS, Shown, browser
from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene.scene_loading import load
from torus_cases import SEVERAL, torus_scene

pytest.importorskip("aiohttp")
pytest.importorskip("watchfiles")
pytest.importorskip("playwright.sync_api")
Image = pytest.importorskip("PIL.Image")

__all__ = ["browser"]
pytestmark = NEEDS


@pytest.fixture
def stone(tmp_path: Path) -> Path:
    path = tmp_path / "stone.toml"
    path.write_text(
        '# a stone\n[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'
        'tint = [0.8, 0.1, 0.1, 1.0]\n[[surface]]\ntechnique = "pbr_constants"\nsurface_roughness = 0.5\n',
        encoding="utf-8",
    )
    return path


@pytest.fixture
def shown(browser: Any, stone: Path) -> Iterator[Shown]:
    shown = Shown(browser, str(stone))
    yield shown
    shown.close()


def color(picture: Any) -> Any:
    """The mean colour below the middle, where no message covers the body."""
    height, width = picture.shape[:2]
    return picture[height // 2 + 10 : height // 2 + 50, width // 2 - 20 : width // 2 + 20].mean(axis=(0, 1))


def test_a_save_shows_the_new_picture_and_an_error_keeps_it(shown: Shown, stone: Path) -> None:
    red = color(shown.picture())
    assert red[0] > 1.5 * red[1]
    text = stone.read_text(encoding="utf-8")
    stone.write_text(text.replace("[0.8, 0.1, 0.1", "[0.1, 0.8, 0.1"), encoding="utf-8")
    shown.until(lambda: shown.version() == 2)
    green = color(shown.picture())
    assert green[1] > 1.5 * green[0]
    stone.write_text(text.replace("base_color", "base_colour"), encoding="utf-8")
    shown.until(shown.error)
    assert "stone.toml:6" in shown.error() and "did you mean" in shown.error()
    assert color(shown.picture()) == pytest.approx(green, abs=1.0)
    stone.write_text(text, encoding="utf-8")
    shown.until(lambda: not shown.error() and shown.version() == 3)
    assert color(shown.picture()) == pytest.approx(red, abs=1.0)
    assert not shown.faults


def test_a_control_changes_the_picture_and_save_writes_the_file(shown: Shown, stone: Path) -> None:
    before = color(shown.picture())
    assert shown.page.inner_text("#saved-in") == f"Save writes {stone}."
    shown.page.evaluate(
        "const field = document.querySelector('[data-property=tint] input[type=color]');"
        "field.value = '#2020ff'; field.dispatchEvent(new Event('input'))"
    )
    after = color(shown.picture())
    assert after[2] > 1.5 * after[0] and before[2] < before[0]
    assert "tint = [0.8" in stone.read_text(encoding="utf-8")
    shown.page.click("#save")
    shown.until(lambda: "tint = [0.8" not in stone.read_text(encoding="utf-8"))
    shown.until(lambda: shown.page.is_disabled("#save"))
    shown.until(lambda: f"Saved: tint in {stone}." in shown.page.inner_text("body"))
    assert stone.read_text(encoding="utf-8").startswith("# a stone\n[material]\n")
    assert color(shown.picture()) == pytest.approx(after, abs=2.0)


def test_a_body_of_millimetres_is_seen(browser: Any, stone: Path) -> None:
    scene = stone.with_name("scene.toml")
    text = '[geometry]\nkind = "ball"\nradius = 0.003\n[camera]\nposition = [0.0, 0.0, 0.012]\n[[light]]\n'
    scene.write_text(f'material = "stone.toml"\n{text}direction = [0.0, 0.0, 1.0]\n', encoding="utf-8")
    shown = Shown(browser, str(scene))
    red = color(shown.picture())
    shown.close()
    assert red[0] > 1.5 * red[1]


def test_undo_gives_the_values_of_the_file(shown: Shown) -> None:
    before = color(shown.picture())
    shown.page.fill("[data-property=tint] input[type=number]", "0.5")
    shown.page.evaluate("preview.panel.reset()")
    assert shown.page.is_disabled("#save")
    assert color(shown.picture()) == pytest.approx(before, abs=1.0)


def test_lamps_and_the_eye_are_dragged(shown: Shown) -> None:
    before = shown.picture()
    box = shown.page.locator("main canvas").bounding_box()
    place = shown.page.evaluate(
        "(() => { const { lamps, camera } = preview.stage;"
        " const at = lamps.handles[1].position.clone().project(camera);"
        " return [at.x, at.y]; })()"
    )
    x, y = box["x"] + (place[0] + 1) / 2 * box["width"], box["y"] + (1 - place[1]) / 2 * box["height"]
    mouse = shown.page.mouse
    lamp = "preview.stage.lamps.all[1].position.toArray()"
    was, eye = shown.page.evaluate(lamp), shown.page.evaluate("preview.stage.camera.position.toArray()")
    mouse.move(x, y), mouse.down(), mouse.move(x - 60, y + 20, steps=4), mouse.up()
    assert shown.page.evaluate(lamp) != pytest.approx(was)
    assert shown.page.evaluate("preview.stage.camera.position.toArray()") == pytest.approx(eye)
    assert np.abs(shown.picture() - before).mean() > 0.3
    (
        mouse.move(box["x"] + 20, box["y"] + 200),
        mouse.down(),
        mouse.move(box["x"] + 120, box["y"] + 200, steps=4),
        mouse.up(),
    )
    assert shown.page.evaluate("preview.stage.camera.position.toArray()") != pytest.approx(eye)


def test_without_webgpu_the_fallback_is_used_and_named(browser: Any, stone: Path) -> None:
    shown = Shown(browser, str(stone), renderer="webgpu")
    try:
        if shown.page.evaluate("preview.stage.kind") != "webgpu":
            assert "WebGL 2" in shown.page.inner_text("#status")
            assert shown.page.input_value("#renderer") == "webgl2"
        assert color(shown.picture())[0] > 20.0
    finally:
        shown.close()


def test_a_file_that_vanishes_and_a_page_that_closes(browser: Any, shown: Shown, stone: Path) -> None:
    text = stone.read_text(encoding="utf-8")
    other = browser.new_page()
    other.goto(shown.server.url)
    other.close()
    stone.unlink()
    shown.until(shown.error)
    stone.write_text(text.replace("0.8", "0.7"), encoding="utf-8")
    shown.until(lambda: not shown.error())
    assert color(shown.picture())[0] > 20.0


def test_many_saves_end_on_the_newest(shown: Shown, stone: Path) -> None:
    text = stone.read_text(encoding="utf-8")
    for number in range(100):
        stone.write_text(
            text.replace("surface_roughness = 0.5", f"surface_roughness = {number / 200}"), encoding="utf-8"
        )
    value = "preview.panel.controls.find((one) => one.property === 'surfaceRoughness').value[0]"
    shown.until(lambda: abs(shown.page.evaluate(value) - 99 / 200) < 1e-6)


@pytest.mark.parametrize("size", [(1280, 720), (900, 600)])
def test_nothing_is_cut_off(browser: Any, size: tuple[int, int]) -> None:
    shown = Shown(browser, "ice")
    try:
        shown.page.set_viewport_size({"width": size[0], "height": size[1]})
        wider = "(one) => one.scrollWidth > one.clientWidth"
        assert not shown.page.evaluate(
            f"[document.documentElement, ...document.querySelectorAll('aside, #controls')].some({wider})"
        )
        controls = "[...document.querySelectorAll('.row input, .row select, .row button')]"
        ends = shown.page.evaluate(f"{controls}.map((one) => one.getBoundingClientRect().right)")
        assert max(ends) <= size[0]
        box = shown.page.locator("#save").bounding_box()
        assert box["y"] + box["height"] < size[1]
        numbers = "[...document.querySelectorAll('.number')]"
        narrow = f"{numbers}.filter({wider}).map((one) => one.value)"
        assert shown.page.evaluate(narrow) == []
    finally:
        shown.close()


EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/scene.toml"))


@pytest.mark.parametrize("renderer", ["webgl", "webgl2"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_is_as_in_the_gallery(browser: Any, name: str, renderer: str, tmp_path: Path) -> None:
    """The lights and their units are three's, so that the pictures are near, not equal."""
    shown = Shown(browser, name, renderer=renderer)
    try:
        picture = shown.picture()
        assert not shown.error() and not shown.faults
        gallery = Image.open(ROOT / "docs" / "gallery" / f"{name}.png").convert("RGB")
        height, width = picture.shape[:2]
        shape = (width, round(width * gallery.height / gallery.width))
        scaled = gallery.resize((round(gallery.width * height / gallery.height), height))
        middle = np.asarray(scaled, float)
        common = min(middle.shape[1], width)
        cut = [array[:, (array.shape[1] - common) // 2 :][:, :common] for array in (picture, middle)]
        assert shape[1] > 0
        assert np.abs(cut[0] - cut[1]).mean() < 24.0
    finally:
        shown.close()


@pytest.mark.parametrize("renderer", ["webgl", "webgl2"])
def test_light_of_several_lamps_comes_through_as_in_a_render(browser: Any, renderer: str, tmp_path: Path) -> None:
    """The page runs the passes of the list that `sssgen render` runs; the surface reflects nothing."""
    path = Path(torus_scene(tmp_path, SEVERAL))
    material = path.with_name("jade.toml")
    dark = material.read_text("utf-8").replace("tint = [0.035, 0.06, 0.045, 1.0]", "tint = [0.0, 0.0, 0.0, 1.0]")
    dark = dark.replace("surface_roughness = 0.12", "surface_roughness = 1.0")
    level = '\n[[surface]]\ntechnique = "specular_level"\ndielectric_specular = 0.0\n\n[translucency]'
    material.write_text(dark.replace("\n[translucency]", level), "utf-8")
    shown = Shown(browser, str(path), renderer=renderer)
    try:
        picture = shown.picture()
        assert not shown.error() and not shown.faults
    finally:
        shown.close()
    height, width = picture.shape[:2]
    scene = dataclasses.replace(load(str(path)), samples=1, size=(width, height))
    rendered = render(scene, backends.require("numpy"))
    inner = rendered.covered > 0.0
    for axis, step in ((0, -2), (0, 2), (1, -2), (1, 2)):
        inner &= np.roll(inner, step, axis)
    apart = np.abs(picture[..., :3] - 255.0 * rendered.encoded)[inner].max(axis=-1)
    assert inner.sum() > 5000 and rendered.encoded[inner].mean() > 0.2
    assert np.quantile(apart, 0.9) < 4.0
