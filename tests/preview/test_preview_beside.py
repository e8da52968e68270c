"""Two pictures on one page, and pictures of plain GLSL."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preview_page import NEEDS, Shown, browser

pytest.importorskip("aiohttp")
pytest.importorskip("playwright.sync_api")
Image = pytest.importorskip("PIL.Image")

__all__ = ["browser"]
pytestmark = NEEDS

MATERIAL = '[material]\nname = "{}"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\ntint = [{}, 0.1, 1.0]\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "red.toml").write_text(MATERIAL.format("red", "0.8, 0.1"), encoding="utf-8")
    (tmp_path / "green.toml").write_text(MATERIAL.format("green", "0.1, 0.8"), encoding="utf-8")
    return tmp_path


@pytest.fixture
def red(browser: Any, folder: Path) -> Iterator[Shown]:
    shown = Shown(browser, str(folder / "red.toml"))
    yield shown
    shown.close()


def panes(shown: Shown, count: int) -> list[Any]:
    """The mean colours of the middles of the panes."""
    shown.page.wait_for_timeout(100)
    sharp = f"preview.panes.filter((one) => one.stage?.drafts.sharp).length === {count}"
    shown.until(lambda: shown.page.evaluate(sharp))
    pictures = []
    for canvas in shown.page.locator(".place canvas").all():
        picture = np.asarray(Image.open(BytesIO(canvas.screenshot())).convert("RGB"), float)
        height, width = picture.shape[:2]
        pictures.append(picture[height // 2 - 15 : height // 2 + 15, width // 2 - 15 : width // 2 + 15].mean((0, 1)))
    assert len(pictures) == count
    return pictures


def test_two_materials_have_one_camera_and_their_own_controls(browser: Any, folder: Path) -> None:
    shown = Shown(browser, str(folder / "red.toml"), str(folder / "green.toml"))
    try:
        left, right = panes(shown, 2)
        assert left[0] > 1.5 * left[1] and right[1] > 1.5 * right[0]
        box = shown.page.locator(".place canvas").nth(1).bounding_box()
        mouse = shown.page.mouse
        mouse.move(box["x"] + 20, box["y"] + 200), mouse.down(), mouse.move(box["x"] + 90, box["y"] + 190, steps=4)
        mouse.up()
        eyes = shown.page.evaluate("preview.panes.map((one) => one.stage.camera.position.toArray())")
        assert eyes[0] == pytest.approx(eyes[1]) and eyes[0] != pytest.approx([0.0, 0.5, 4.2], abs=0.1)
        shown.page.click("#tabs button:nth-child(2)")
        assert shown.page.inner_text("#title") == "Green"
        alpha = shown.page.locator("[data-property=tint] input[type=color]")
        alpha.evaluate("(field) => { field.value = '#2020ff'; field.dispatchEvent(new Event('input')); }")
        left, right = panes(shown, 2)
        assert left[0] > 1.5 * left[2] and right[2] > 1.5 * right[1]
        shown.page.click("#save")
        shown.until(lambda: "0.1, 0.8" not in (folder / "green.toml").read_text(encoding="utf-8"))
        assert "0.8, 0.1, 0.1" in (folder / "red.toml").read_text(encoding="utf-8") and not shown.faults
    finally:
        shown.close()


def test_now_stands_beside_the_start(red: Shown, folder: Path) -> None:
    text = (folder / "red.toml").read_text(encoding="utf-8")
    (folder / "red.toml").write_text(text.replace("0.8, 0.1", "0.1, 0.1"), encoding="utf-8")
    red.until(lambda: red.version() == 2)
    red.page.select_option("#beside", "start")
    now, then = panes(red, 2)
    assert then[0] > 1.5 * then[1] and now[0] < 1.2 * now[2]
    assert red.page.locator(".caption").all_inner_texts() == ["Red", "Red, at the start"]
    red.page.select_option("#beside", "")
    panes(red, 1)
    assert not red.faults and not red.error()


def test_without_guards_has_the_values_that_were_changed_by_hand(red: Shown) -> None:
    red.page.select_option("#beside", "guards")
    left, right = panes(red, 2)
    assert left == pytest.approx(right, abs=2.0)
    field = red.page.locator("[data-property=tint] input[type=color]")
    field.evaluate("(field) => { field.value = '#2020ff'; field.dispatchEvent(new Event('input')); }")
    left, right = panes(red, 2)
    assert left[2] > 1.5 * left[0] and left == pytest.approx(right, abs=2.0) and not red.faults


def test_plain_glsl_is_drawn_at_each_save(browser: Any, tmp_path: Path) -> None:
    file = tmp_path / "toy.glsl"
    file.write_text("void mainImage(out vec4 c, in vec2 p) { c = vec4(step(2.0, iTime), 0.5, 0.0, 1.0); }", "utf-8")
    shown = Shown(browser, str(file))
    try:
        shown.page.evaluate("preview.stage.run(false); preview.stage.time = 0; preview.stage.ask()")
        assert shown.picture()[250, 30] == pytest.approx([0, 128, 0], abs=2)
        shown.page.evaluate("preview.stage.time = 3; preview.stage.ask()")
        assert shown.picture()[250, 30] == pytest.approx([255, 128, 0], abs=2)
        file.write_text("float grey(vec2 p) { return 0.2; }", encoding="utf-8")
        shown.until(lambda: shown.version() == 2)
        assert shown.picture()[250, 30] == pytest.approx([51, 51, 51], abs=2)
        file.write_text("float grey(vec2 p) { return p; }", encoding="utf-8")
        shown.until(lambda: "toy.glsl:1" in shown.error())
        assert shown.picture()[250, 30] == pytest.approx([51, 51, 51], abs=2) and not shown.faults
    finally:
        shown.close()
