"""The panel of emitted text in a headless Chromium."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from preview_page import NEEDS, Shown, browser

pytest.importorskip("aiohttp")
pytest.importorskip("playwright.sync_api")

__all__ = ["browser"]
pytestmark = NEEDS

MATERIAL = """[material]
name = "stone"
shading = "lit"
[[surface]]
technique = "base_color"
tint = [0.8, 0.1, 0.1, 1.0]
[[surface]]
technique = "pbr_constants"
surface_roughness = { value = 0.5, fixed = true }
"""


def test_text_changes_sources_and_copy(browser: Any, tmp_path: Path) -> None:
    stone = tmp_path / "stone.toml"
    stone.write_text(MATERIAL, encoding="utf-8")
    shown = Shown(browser, str(stone))
    page = shown.page
    try:
        page.set_viewport_size({"width": 1300, "height": 700})
        assert page.is_hidden("#emitted")
        page.click("#show-text")
        shown.until(lambda: page.locator("#text-lines .line").count() > 50)
        assert page.input_value("#text-target") == "glsl-330"
        assert page.locator("#text-lines .line.new").count() == 0
        stone.write_text(MATERIAL.replace("0.5", "0.625"), encoding="utf-8")
        shown.until(lambda: page.locator("#text-lines .line.new").count() > 0)
        marked = page.locator("#text-lines .line.new").all_inner_texts()
        assert len(marked) < 8 and any("0.625" in line for line in marked)
        page.select_option("#text-target", "wgsl")
        line = page.locator("#text-lines .line.linked", has_text="base_color(").first
        shown.until(lambda: page.input_value("#text-file").endswith(".wgsl") and line.count())
        line.click()
        shown.until(lambda: page.locator("#text-source .line.chosen").count() == 1)
        head = page.inner_text("#text-source strong")
        assert head.startswith("surface/base_color.sss:")
        chosen = page.locator("#text-source .line.chosen")
        assert chosen.locator(".number").inner_text() == head.rsplit(":", 1)[1]
        assert "base_color" in chosen.inner_text()
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        page.click("#text-copy")
        shown.until(lambda: page.inner_text("#text-copy") == "Copied")
        copied = page.evaluate("navigator.clipboard.readText()")
        assert "base_color(" in copied and copied.count("\n") == page.locator("#text-lines .line").count()
        page.click("#show-text")
        assert page.is_hidden("#emitted") and not shown.faults
    finally:
        shown.close()


def test_the_cost_and_how_to_measure_the_error(browser: Any, tmp_path: Path) -> None:
    stone = tmp_path / "stone.toml"
    stone.write_text(MATERIAL, encoding="utf-8")
    shown = Shown(browser, str(stone))
    try:
        rows = shown.page.locator("#cost tr").all_inner_texts()
        assert rows[0].split()[0] == "operations" and rows[1].split()[0] == "surface"
        assert int(rows[1].split()[1]) == shown.server.talk.panes[0].picture.head["cost"]["surface"]["operations"]
        shown.until(lambda: "not measured" in shown.page.inner_text("#measured"))
    finally:
        shown.close()


@pytest.mark.parametrize(
    ("before", "after", "changed"),
    [
        ("a b c", "a b c", []),
        ("a b c", "a x c", [1]),
        ("a b c", "a c", []),
        ("a c", "a b c", [1]),
        ("a b c d", "x b y d", [0, 2]),
        ("", "a", [0]),
        ("a b a b", "b a b a", [3]),
    ],
)
def test_changed_lines(browser: Any, tmp_path: Path, before: str, after: str, changed: list[int]) -> None:
    text = (Path(__file__).parents[2] / "src/sssgen/preview/page/emitted_text.js").read_text(encoding="utf-8")
    page = browser.new_page()
    module = re.sub(r"^import .*\n", "", text, flags=re.MULTILINE).replace("export ", "")
    lines = [before.split(" "), after.split(" ")]
    found = page.evaluate(f"() => {{ {module}; return [...changedLines(...{lines!r})]; }}")
    page.close()
    assert found == changed
