"""The menus and the look of media on the page, in a headless Chromium."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from preview_page import NEEDS, Shown, browser
from sssgen.material.material_loading import load_material
from sssgen.material.scatter_color import albedo_of_color
from sssgen.support.paths import folder

pytest.importorskip("aiohttp")
pytest.importorskip("watchfiles")
pytest.importorskip("playwright.sync_api")

__all__ = ["browser"]
pytestmark = NEEDS


@pytest.fixture
def ring(in_folder: Path) -> Path:
    shutil.copytree(folder("examples") / "jade_ring", "ring")
    shutil.copytree(folder("examples") / "surroundings", "surroundings")
    return in_folder / "ring" / "jade_ring.toml"


@pytest.fixture
def shown(browser: Any, ring: Path) -> Iterator[Shown]:
    shown = Shown(browser, "ring/scene.toml", renderer="webgl")
    yield shown
    shown.close()


def names(path: Path) -> list[str]:
    return [stage.technique.name for stage in load_material(str(path)).stages]


def test_the_look_on_the_page_is_that_of_python(shown: Shown) -> None:
    steps = [number / 16 for number in range(17)]
    script = "async (steps) => { const look = await import('./page/medium_look.js'); return steps.map(look.albedoOf); }"
    assert shown.page.evaluate(script, steps) == pytest.approx([albedo_of_color(step) for step in steps], abs=1e-12)
    back = script.replace("steps.map(look.albedoOf)", "steps.map((one) => look.colorOf(look.albedoOf(one)))")
    assert shown.page.evaluate(back, steps) == pytest.approx(steps, abs=1e-4)


def test_color_and_depth_are_saved_as_they_were_edited(shown: Shown, ring: Path) -> None:
    page = shown.page
    page.fill("[data-key=depth] [data-channel=R] input", "0.5")
    page.fill("[data-key=color] [data-channel=G] input", "0.25")
    albedo = page.evaluate("preview.panel.values.get('scatteringAlbedo')")
    assert albedo[1] == pytest.approx(albedo_of_color(0.25)) and albedo[0] == pytest.approx(0.5, abs=1e-4)
    assert page.evaluate("preview.panel.values.get('extinction')")[0] == pytest.approx(2.0)
    page.click("[data-mode=physical]")
    assert page.input_value("[data-property=extinction] [data-channel=R] input") == "2"
    assert "absorption σa" in page.inner_text(".derived")
    page.click("#save")
    shown.until(lambda: "depth = [0.5, " in ring.read_text(encoding="utf-8"))
    text = ring.read_text(encoding="utf-8")
    assert "0.25, " in text[text.index("color = [") :] and "extinction" not in text and "mean_free_path" not in text
    shown.until(lambda: page.is_disabled("#save"))
    page.click("#undo")
    shown.until(lambda: "extinction = [15.0" in ring.read_text(encoding="utf-8"))
    assert not shown.faults


def test_a_preset_and_a_stage_from_the_menus(shown: Shown, ring: Path) -> None:
    page, chain = shown.page, names(ring)
    page.click("#open-presets")
    page.click("#presets [data-name=leaf]")
    page.click("#use-preset")
    shown.until(lambda: names(ring) != chain)
    assert load_material(str(ring)).two_sided
    shown.until(lambda: page.is_enabled("#undo"))
    page.click("#undo")
    shown.until(lambda: names(ring) == chain)
    page.click("#add-stage")
    page.fill("#search-techniques", "clear coat")
    page.click(".technique[data-name=clearcoat_constants]")
    shown.until(lambda: "clearcoat_constants" in names(ring))
    shown.until(lambda: "clearcoat_constants" in page.inner_text("#chain"))
    assert not shown.faults and not shown.error()


def test_a_technique_that_does_not_link_says_why(shown: Shown) -> None:
    shown.page.click("#add-stage")
    refused = ".technique[data-name=absorption_tint]"
    assert "takes a thickness" in shown.page.inner_text(refused) and shown.page.is_disabled(refused)


def test_a_medium_fills_the_controls(shown: Shown) -> None:
    page = shown.page
    page.click("#open-media")
    page.click("#media [data-name=skin1]")
    page.click("#use-medium")
    shown.until(lambda: page.evaluate("preview.panel.values.has('extinction')"))
    assert page.is_enabled("#save") and "skin1" in page.inner_text("#status")


def test_save_as_asks_before_it_replaces_and_the_page_follows(shown: Shown, in_folder: Path) -> None:
    page = shown.page
    (in_folder / "own").mkdir()
    (in_folder / "own" / "scene.toml").write_text("# mine\n", encoding="utf-8")
    page.click("#save-as")
    page.fill("#save-as-name", "../own")
    page.click("#save-as-save")
    shown.until(lambda: "no folder below" in page.inner_text("#save-as-dialog"))
    page.fill("#save-as-name", "own")
    page.click("#save-as-save")
    shown.until(lambda: "has these files already" in page.inner_text("#save-as-dialog"))
    assert (in_folder / "own" / "scene.toml").read_text(encoding="utf-8") == "# mine\n"
    page.click("#save-as-save")
    shown.until(lambda: page.inner_text("#title") == "Own")
    assert "own/own.toml" in page.inner_text("#saved-in")


def test_the_time_of_a_frame_says_what_measured_it(shown: Shown) -> None:
    page = shown.page
    shown.until(lambda: "…" not in page.inner_text("#frame-time"))
    if page.is_visible("#frame-time button"):
        page.click("#frame-time button")
    shown.until(lambda: " ms (" in page.inner_text("#frame-time"))
    text = page.inner_text("#frame-time")
    assert float(text.split()[0]) > 0.0 and text.split("(")[1] in ("GPU)", "clock)")
