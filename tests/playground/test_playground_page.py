"""The built playground in a headless Chromium, from a host of static files: text, picture, errors, links."""

from __future__ import annotations

import time
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
import pytest

import build_playground
from sssgen.pipeline.compiler import compile
from sssgen.run.machine_parts import chromium, node, node_modules
from static_host import serving

playwright = pytest.importorskip("playwright.sync_api")
Image = pytest.importorskip("PIL.Image")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not chromium() or not node(), reason="Chromium or Node.js is missing"),
    pytest.mark.skipif(not (node_modules() / "pyodide").is_dir(), reason="npm's pyodide is missing"),
]

SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SECONDS = 90.0
"""After which a page that does not answer has failed."""
BUILT = ("new_material", "ice", "jelly_cubes", "plain_glsl")


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("site") / "playground"
    assert build_playground.build(folder, BUILT) == len(BUILT)
    with serving(folder) as address:
        yield address


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        yield browser
        browser.close()


class Shown:
    """A page of the playground."""

    def __init__(self, browser: Any, address: str, fragment: str) -> None:
        self.page = browser.new_page(viewport={"width": 1280, "height": 720})
        self.faults: list[str] = []
        self.asked: list[str] = []
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(f"{address}#{fragment}")
        self.until(lambda: self.version() > 0)

    def until(self, holds: Any) -> None:
        end = time.monotonic() + SECONDS
        while not holds():
            state = self.page.inner_text("#python")
            assert time.monotonic() < end, f"{state} {self.page.inner_text('#errors')} {self.faults}"
            self.page.wait_for_timeout(20)

    def version(self) -> int:
        return int(self.page.evaluate("document.body.dataset.version ?? 0"))

    def replace(self, old: str, new: str) -> None:
        """Types in the open file, and waits for the answer."""
        version = self.version()
        place = self.page.evaluate("old => document.querySelector('textarea').value.indexOf(old)", old)
        assert place >= 0, old
        self.page.evaluate(
            "([from, to]) => { const field = document.querySelector('textarea'); field.focus();"
            " field.setSelectionRange(from, to); }",
            [place, place + len(old)],
        )
        self.page.keyboard.insert_text(new)
        self.until(lambda: self.version() > version)

    def color(self) -> Any:
        """The mean colour around the middle of the canvas, 0 to 255."""
        self.page.wait_for_timeout(300)
        picture = np.asarray(Image.open(BytesIO(self.page.locator("canvas").screenshot())).convert("RGB"), float)
        height, width = picture.shape[:2]
        return picture[height // 2 - 20 : height // 2 + 20, width // 2 - 20 : width // 2 + 20].mean(axis=(0, 1))

    def errors(self) -> str:
        return str(self.page.inner_text("#errors"))


@pytest.fixture
def shown(browser: Any, address: str) -> Iterator[Shown]:
    shown = Shown(browser, address, "new_material")
    yield shown
    shown.page.close()


def test_a_preset_replaces_the_chain_of_the_material(browser: Any, address: str) -> None:
    shown = Shown(browser, address, "new_material")
    version = shown.version()
    shown.page.click("#open-presets")
    shown.page.click("#presets [data-name=jade]")
    shown.until(lambda: shown.version() > version)
    text = shown.page.evaluate("playground.editor.files['new_material.toml']")
    assert 'name = "new_material"' in text and "interior_octaves" in text
    shown.until(lambda: "interior_octaves" in shown.page.inner_text("#text"))
    assert not shown.page.is_visible("#errors") and not shown.faults


def test_typing_changes_the_picture_and_the_text(shown: Shown) -> None:
    brown = shown.color()
    assert brown[0] > 1.2 * brown[2]
    shown.replace("[0.75, 0.42, 0.2, 1.0]", "[0.1, 0.3, 0.9, 1.0]")
    blue = shown.color()
    assert blue[2] > 1.2 * blue[0]
    shown.page.select_option("#target", "glsl-330")
    shown.until(lambda: "#version 330" in shown.page.inner_text("#text"))
    before = shown.page.inner_text("#text")
    shown.replace(
        'technique = "stripes.sss"', 'technique = "stripes.sss"\nstripe_count = { value = 4.0, fixed = true }'
    )
    shown.until(lambda: shown.page.inner_text("#text") != before)
    assert "uniform float stripe_count" in before and "uniform float stripe_count" not in shown.page.inner_text("#text")
    assert shown.page.locator("#text .new").count() > 0
    assert not shown.faults


def test_a_technique_is_edited(shown: Shown) -> None:
    before = shown.color()
    shown.page.click("#files button:has-text('stripes.sss')")
    shown.replace(
        "albedo = albedo * mix(vec3(1.0), stripe_color, smoothstep(0.4, 0.6, wave));", "albedo = vec3(0.0, wave, 0.0);"
    )
    assert not shown.errors()
    assert shown.color()[1] > 1.5 * shown.color()[0] and before[0] > before[1]


def test_an_error_has_its_place_and_the_picture_stays(shown: Shown) -> None:
    before = shown.color()
    shown.replace('"beer_lambert"', '"beer_lambart"')
    assert "new_material.toml:24:13" in shown.errors() and "^^^" in shown.errors() and "did you mean" in shown.errors()
    assert shown.page.inner_text("pre .fault") == '"beer_lambart"'
    assert shown.color() == pytest.approx(before, abs=1.0)
    shown.page.select_option("#target", "hlsl")
    shown.until(lambda: "beer_lambart" in shown.page.inner_text("#text.refused"))
    shown.replace('"beer_lambart"', '"beer_lambert"')
    assert not shown.errors()


def test_a_link_has_the_whole_state(browser: Any, shown: Shown, address: str) -> None:
    shown.replace("[0.75, 0.42, 0.2, 1.0]", "[0.1, 0.8, 0.1, 1.0]")
    shown.page.select_option("#target", "godot")
    shown.page.fill("[data-property=surfaceRoughness] input[type=number]", "0.9")
    shown.page.select_option("#shape", "cube")
    shown.page.wait_for_timeout(500)
    shown.page.click("#link")
    shown.until(lambda: "#s=" in shown.page.url)
    assert len(shown.page.url) < 4000
    green = shown.color()
    other = Shown(browser, address, shown.page.url.partition("#")[2])
    try:
        assert other.page.input_value("#target") == "godot" and other.page.input_value("#shape") == "cube"
        assert other.page.input_value("[data-property=surfaceRoughness] input[type=number]") == "0.9"
        assert "[0.1, 0.8, 0.1, 1.0]" in other.page.input_value("textarea")
        assert other.color() == pytest.approx(green, abs=2.0)
        assert not other.faults
    finally:
        other.page.close()


@pytest.mark.parametrize("fragment", ["s=nonsense", "s=", "nothing", "s=" + "A" * 5000])
def test_a_faulty_link_shows_the_first_example(browser: Any, address: str, fragment: str) -> None:
    shown = Shown(browser, address, fragment)
    try:
        assert fragment == "nothing" or "cannot be read" in shown.page.inner_text("#message")
        assert not shown.faults
    finally:
        shown.page.close()


def test_textures_are_there_and_nothing_is_fetched_from_elsewhere(browser: Any, address: str) -> None:
    shown = Shown(browser, address, "ice")
    try:
        shown.until(lambda: shown.page.evaluate("playground.emitted.text"))
        assert shown.page.evaluate("playground.emitted.text") == compile("ice", "wgsl").files["ice.wgsl"]
        color = shown.color()
        assert color[2] > color[0] > 10.0  # blue ice
        asked = [url for url in shown.asked if not url.startswith(("blob:", "data:"))]
        assert len(asked) > 10 and all(url.startswith(address) for url in asked), asked
        assert not shown.faults
    finally:
        shown.page.close()


def test_a_material_that_makes_its_own_rays_is_drawn_without_a_body(browser: Any, address: str) -> None:
    shown = Shown(browser, address, "jelly_cubes")
    try:
        shown.until(lambda: "fn " in shown.page.inner_text("#text"))
        assert not shown.page.is_visible("#note")
        assert shown.page.evaluate("playground.picture.stage.kind") == "flat"
        assert shown.page.locator("#controls .row").count() > 3 and not shown.page.is_visible("#shape")
        assert max(shown.color()) > 20.0
        shown.page.select_option("#start", "new_material")
        body = "(({ stage }) => stage && stage.kind !== 'flat' && stage.drawn > 0)(playground.picture)"
        shown.until(lambda: shown.page.evaluate(body))  # not the stage before it
        assert shown.color()[0] > 30.0
        assert not shown.faults
    finally:
        shown.page.close()


def test_plain_glsl_is_drawn_and_its_errors_are_shown(browser: Any, address: str) -> None:
    shown = Shown(browser, address, "plain_glsl")
    try:
        shown.replace(
            "color = vec4(mix(vec3(0.06, 0.05, 0.07), wax, inside), 1.0);", "color = vec4(0.0, 1.0, 0.5, 1.0);"
        )
        assert shown.color() == pytest.approx([0.0, 255.0, 128.0], abs=3.0)
        shown.replace("0.0, 1.0, 0.5, 1.0", "0.0, 1.0, 0.5")
        assert "plain_glsl.glsl:16:13" in shown.errors() and "^" in shown.errors()
        assert shown.color() == pytest.approx([0.0, 255.0, 128.0], abs=3.0)
        assert not shown.faults
    finally:
        shown.page.close()
