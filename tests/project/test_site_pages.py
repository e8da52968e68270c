"""The built site: its links and anchors, its search, and its first page, from a folder of a host of static files."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest

from folders import ROOT
from sssgen.run.machine_parts import chromium, node, node_modules
from static_host import serving

pytestmark = pytest.mark.slow
DRAWS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
DRAWS_NOT = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
SECONDS = 240.0
WRITTEN_BY_SCRIPTS = {"playground/index.html"}
"""Pages whose anchors name a state, not a place."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole site in a folder of a host, but the pictures of the techniques; $SITE names one that is built."""
    if built := os.environ.get("SITE"):
        return Path(built)
    pytest.importorskip("sphinx", reason="`make site` installs it")
    if not node() or not (node_modules() / "pyodide").is_dir():
        pytest.skip("npm's pyodide is missing")
    folder = tmp_path_factory.mktemp("host") / "below" / "site"
    command = [sys.executable, str(ROOT / "docs" / "site" / "build_site.py"), str(folder), "--without-pictures"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


class _Page(HTMLParser):
    """The links of a page, and the places to which links lead."""

    FETCHED = ("img", "script", "link", "iframe", "source")

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.places: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(value)
                if tag in self.FETCHED and not (tag == "link" and dict(attrs).get("rel") == "canonical"):
                    self.fetched.append(value)
            if (name == "id" or (name == "name" and tag == "a")) and value:
                self.places.add(value)


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, _Page]:
    return {path: _Page(path) for path in site.rglob("*.html") if path.relative_to(site).parts[0] != "_downloads"}


def test_every_link_and_anchor_leads_somewhere(site: Path, pages: dict[Path, _Page]) -> None:
    """A page of this site is below its folder, so that the site may be in any folder of a host."""
    checked, faults = 0, []
    for path, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            place, _, anchor = link.partition("#")
            target = (path.parent / unquote(place.partition("?")[0])).resolve() if place else path
            target = target / "index.html" if target.is_dir() else target
            named = f"{path.relative_to(site)}: {link}"
            checked += 1
            if link.startswith("/") or not target.is_relative_to(site.resolve()) or not target.exists():
                faults.append(named)
            elif anchor and target in pages and target.relative_to(site).as_posix() not in WRITTEN_BY_SCRIPTS:
                faults += [named] if unquote(anchor) not in pages[target].places else []
    assert not faults, "\n".join(faults[:40])
    assert checked > 10000


def test_no_page_fetches_anything_from_elsewhere(site: Path, pages: dict[Path, _Page]) -> None:
    for path, page in pages.items():
        others = [link for link in page.fetched if re.match(r"(https?:)?//", link)]
        assert not others, f"{path.relative_to(site)}: {others}"
    for style in site.rglob("*.css"):
        assert not re.search(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//", style.read_text(encoding="utf-8")), style


def test_links_of_llms_txt_lead_somewhere(site: Path) -> None:
    links = re.findall(r"\]\(([^)]+)\)", (site / "llms.txt").read_text(encoding="utf-8"))
    assert len(links) > 80 and [link for link in links if not (site / link).is_file()] == []


def test_pages_of_accuracy_load_fast(site: Path) -> None:
    """All pictures of a page of accuracy are loaded when they are seen, and are less than 1.3 MB."""
    for page in [site / "docs" / "accuracy.html", *(site / "docs" / "accuracy").glob("*.html")]:
        pictures = re.findall(r"<img [^>]*>", page.read_text(encoding="utf-8").partition("<article")[2])
        assert all('loading="lazy"' in picture for picture in pictures)
        files = [page.parent / match[1] for picture in pictures if (match := re.search(r'src="([^"]+)"', picture))]
        assert sum(file.stat().st_size for file in files) < 1.3e6, page.name


# In a browser


@pytest.fixture(scope="module")
def address(site: Path) -> Iterator[str]:
    """The address of the site, which is in a folder of the host."""
    with serving(site.parent) as host:
        yield f"{host}{site.name}/"


@pytest.fixture(scope="module")
def driver() -> Iterator[Any]:
    playwright = pytest.importorskip("playwright.sync_api")
    if not chromium():
        pytest.skip("Chromium is missing")
    with playwright.sync_playwright() as driver:
        yield driver


@pytest.fixture(scope="module")
def browser(driver: Any) -> Iterator[Any]:
    browser = driver.chromium.launch(executable_path=chromium(), args=DRAWS)
    yield browser
    browser.close()


def opened(browser: Any, address: str, **context: Any) -> Any:
    """A page, with `asked`, the addresses that it fetched, and `faults`."""
    page = browser.new_page(**({"viewport": {"width": 1280, "height": 720}} | context))
    page.set_default_timeout(SECONDS * 1000)
    page.asked, page.faults = [], []
    page.on("request", lambda request: page.asked.append(request.url))
    page.on("pageerror", lambda error: page.faults.append(str(error)))
    page.goto(address)
    return page


def until(page: Any, holds: Callable[[], Any]) -> None:
    end = time.monotonic() + SECONDS
    while not holds():
        assert time.monotonic() < end, page.faults
        page.wait_for_timeout(50)


SEARCHES = {
    "wax": "docs/reference/presets/wax.html",
    "skin_fair": "docs/reference/presets/skin_fair.html",
    "Honey": "docs/reference/presets/honey.html",
    "beer_lambert": "docs/reference/techniques/beer_lambert.html",
    "--max-error": "docs/reference/commands.html#cmdoption-sssgen-pick-max-error",
    "sssgen lint": "docs/reference/commands.html#sssgen-lint",
}
"""What a visitor types → what is found first."""


@pytest.mark.parametrize("words", SEARCHES)
def test_the_search_finds(words: str, browser: Any, address: str) -> None:
    page = opened(browser, f"{address}index.html")
    page.fill("input[name=q]", words)
    page.press("input[name=q]", "Enter")
    page.wait_for_selector("#search-results li a")
    page.wait_for_timeout(300)
    first = page.evaluate("document.querySelector('#search-results li a').href").removeprefix(address)
    page.close()
    assert first in (SEARCHES[words], SEARCHES[words] + "#index-0")


def color(page: Any) -> Any:
    """The mean colour of the body in the first page's picture, 0 to 255."""
    from PIL import Image

    picture = np.asarray(Image.open(BytesIO(page.locator("#demo-stage").screenshot())).convert("RGB"), float)
    height, width = picture.shape[:2]
    return picture[height // 2 - 10 : height // 2 + 10, width // 2 - 10 : width // 2 + 10].mean(axis=(0, 1))


def drawn(page: Any) -> str:
    return str(page.evaluate("document.querySelector('#demo').dataset.drawn ?? ''"))


def test_the_demo_draws_presets_without_the_compiler(browser: Any, address: str) -> None:
    page = opened(browser, f"{address}index.html")
    until(page, lambda: drawn(page) == "honey")
    amber = color(page)
    assert amber[0] > 1.5 * amber[2]
    page.click("#demo-presets [data-name=jade]")
    until(page, lambda: drawn(page) == "jade")
    green = color(page)
    assert green[1] > 1.2 * green[0] and 'name = "jade"' in page.input_value("#demo-editor textarea")
    assert page.inner_text("#demo-command") == "sssgen use jade mesh.obj --target threejs -o out --open"
    page.click("#demo-targets [data-target=unity-urp]")
    assert 'Shader "' in page.inner_text("#demo-text")
    assert page.inner_text("#demo-command") == "sssgen use jade mesh.obj --target unity-urp -o out"
    assert page.get_attribute("#demo-open", "href").endswith("playground/index.html#preset_jade")
    assert all(url.startswith((address, "blob:", "data:")) for url in page.asked)
    assert not [url for url in page.asked if "/python/" in url] and not page.faults
    page.close()


def test_an_edit_loads_the_compiler(browser: Any, address: str) -> None:
    page = opened(browser, f"{address}index.html?preset=paper")
    until(page, lambda: drawn(page) == "paper")
    field = page.locator("#demo-editor textarea")
    text = field.input_value()
    field.fill(text.replace('"pbr_constants"', '"pbr_constant"'))
    until(page, lambda: "did you mean 'pbr_constants'?" in page.inner_text("#demo-errors"))
    assert "paper.toml:" in page.inner_text("#demo-errors")
    tint = re.sub(r"tint = \[[^\]]*\]", "tint = [0.0, 0.9, 0.0, 1.0]", text, count=1)
    assert tint != text
    field.fill(tint)
    until(page, lambda: "compiled here in" in page.inner_text("#demo-status"))
    until(page, lambda: page.locator("#demo-text .new").count() > 0)
    assert not page.is_visible("#demo-errors") and "0.9" in page.inner_text("#demo-text .new")
    assert page.inner_text("#demo-command") == "sssgen emit paper.toml --target threejs -o out"
    assert [url for url in page.asked if "/python/" in url] and not page.faults
    page.close()


def test_without_webgl_there_is_a_picture(driver: Any, address: str) -> None:
    browser = driver.chromium.launch(executable_path=chromium(), args=DRAWS_NOT)
    page = opened(browser, f"{address}index.html")
    until(page, lambda: drawn(page) == "picture")
    assert page.is_visible("#demo-poster") and "a picture instead" in page.inner_text("#demo-hint")
    page.click("#demo-presets [data-name=jade]")
    until(page, lambda: "jade" in page.get_attribute("#demo-poster", "src"))
    assert page.evaluate("document.querySelector('#demo-poster').decode().then(() => true)")
    assert not page.faults
    browser.close()


NARROW = ("index.html", "README.html", "docs/accuracy.html", "docs/presets.html", "docs/reference/presets/wax.html")
NARROW += ("docs/reference/commands.html", "docs/scripts.html", "docs/reference/techniques/beer_lambert.html")


@pytest.mark.parametrize("name", NARROW)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_page_is_as_wide_as_a_phone(name: str, scheme: str, browser: Any, address: str) -> None:
    page = opened(browser, f"{address}{name}", viewport={"width": 390, "height": 844}, color_scheme=scheme)
    page.wait_for_timeout(500)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    light = sum(map(int, re.findall(r"\d+", page.evaluate("getComputedStyle(document.body).backgroundColor"))[:3]))
    assert light > 700 if scheme == "light" else light < 120
    page.close()


def test_a_page_that_is_missing_leads_back(browser: Any, address: str, site: Path) -> None:
    deep = site / "docs" / "no_such_page.html"
    deep.write_text((site / "404.html").read_text(encoding="utf-8"), encoding="utf-8")  # as a host shows it there
    try:
        page = opened(browser, f"{address}docs/no_such_page.html")
        page.wait_for_selector("#links a")
        links = [link.evaluate("link => link.href") for link in page.locator("#links a").all()]
        assert links == [f"{address}index.html", f"{address}search.html?q=no_such_page"]
        page.close()
    finally:
        deep.unlink()
