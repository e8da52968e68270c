"""Measures the playground: `make bench`, or python benchmarks/bench_playground.py [FOLDER].

FOLDER is a built playground, such as build/site/playground; without one, a small one is built. In a headless Chromium
on SwiftShader, from a host of static files on this machine that compresses nothing:

the compressed bytes of each file that the page fetches until its first picture (gzip; packed files as they are), then
the seconds from the start of a navigation without any cache to an empty page, to a bare Pyodide (`1 + 1` in a worker,
with npm's own standard library), and to the first picture of the playground, whose text Pyodide has made. At last the
milliseconds from an edit to its picture, drawn and read back: another value of a parameter, another constant, another
line of a technique. All are medians; the cases take turns.
"""

from __future__ import annotations

import contextlib
import gzip
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

sys.path.append(str(Path(__file__).parents[1] / "docs" / "site"))
sys.path.append(str(Path(__file__).parents[1] / "docs" / "site" / "playground"))
sys.path.append(str(Path(__file__).parents[1] / "tests" / "tools"))

import build_playground
from sssgen.run.machine_parts import chromium, node_modules
from static_host import serving

ROUNDS, EDITS = 3, 12
MOST_BYTES, MOST_SECONDS, MOST_MILLISECONDS = 8_000_000, 6.0, 150.0
SECONDS = 120.0
"""After which a page that does not answer has failed."""
SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

EMPTY = "<!doctype html><title>empty</title><body><script>document.body.dataset.version = 1</script>"
BARE = """<!doctype html><title>bare</title><body><script type="module">
const worker = new Worker('bare.js', { type: 'module' });
worker.onmessage = () => { document.body.dataset.version = 1; };
</script>"""
BARE_WORKER = """import { loadPyodide } from './pyodide/pyodide.mjs';
const python = await loadPyodide({ indexURL: new URL('./pyodide/', import.meta.url).href });
postMessage(python.runPython('1 + 1'));"""

FINISHED = """
() => {
  const { picture } = playground;
  const show = picture.show.bind(picture);
  picture.show = async (answer) => {
    await show(answer);
    const { gl } = picture.stage.renderer.backend;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  };
}
"""
"""The page's own time of an edit then ends when its picture is read back."""

STAGE = 'technique = "stripes.sss"'
CASES = {
    "a value": ("new_material.toml", "surface_roughness = 0.35", "surface_roughness = 0.{}"),
    "a constant": ("new_material.toml", STAGE, STAGE + "\nstripe_count = {{ value = 9.{}, fixed = true }}"),
    "a line of a technique": ("stripes.sss", "2.0 * fract", "2.{} * fract"),
}
"""What is edited: the file, the text that is replaced, the new one for a number."""


@contextlib.contextmanager
def built() -> Iterator[Path]:
    """The playground of the command line, or a small one."""
    with tempfile.TemporaryDirectory() as temporary:
        if len(sys.argv) > 1:
            yield Path(sys.argv[1])
        else:
            build_playground.build(Path(temporary, "playground"), (build_playground.FIRST, "new_material"))
            yield Path(temporary, "playground")


@contextlib.contextmanager
def bare() -> Iterator[Path]:
    """A folder with the pages to compare with."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        shutil.copytree(node_modules() / "pyodide", folder / "pyodide")
        for name, text in {"empty.html": EMPTY, "bare.html": BARE, "bare.js": BARE_WORKER}.items():
            (folder / name).write_text(text, encoding="utf-8")
        yield folder


def until(page: Any, version: int) -> None:
    """Waits for a version of the page."""
    page.wait_for_function(f"Number(document.body?.dataset.version ?? 0) >= {version}", timeout=1000 * SECONDS)


def start(browser: Any, address: str) -> tuple[float, list[str]]:
    """The seconds of a page until its first version, without a cache, and what it asks for."""
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    page, asked = context.new_page(), []
    page.on("request", lambda request: asked.append(request.url))
    began = time.monotonic()
    page.goto(address, wait_until="commit")
    until(page, 1)
    seconds = time.monotonic() - began
    context.close()
    return seconds, asked


def fetched(folder: Path, asked: list[str]) -> dict[str, int]:
    """File → its compressed bytes, for each file that was asked for."""
    sizes = {}
    for url in dict.fromkeys(asked):
        if url.startswith("http"):
            path = folder / (urlsplit(url).path.lstrip("/") or "index.html")
            data = path.read_bytes()
            sizes[path.relative_to(folder).as_posix()] = len(data if path.suffix == ".gz" else gzip.compress(data, 9))
    return sizes


def edits(browser: Any, address: str) -> dict[str, list[float]]:
    """The milliseconds of edits, by case."""
    page = browser.new_page(viewport={"width": 1280, "height": 720})
    page.goto(f"{address}#new_material")
    until(page, 1)
    page.wait_for_timeout(3000)  # Python imports what the first edit of a technique needs
    page.evaluate(FINISHED)
    first = page.evaluate("({ ...playground.editor.files })")
    version, times = 1, {case: [] for case in CASES}
    for number in range(EDITS + 1):
        for case, (file, old, new) in CASES.items():
            text = first[file].replace(old, new.format(10 + number))
            assert text != first[file], old
            version = page.evaluate("Number(document.body.dataset.version)")
            page.evaluate(
                "([file, text]) => { playground.editor.select(file); const field = document.querySelector('textarea');"
                " field.value = text; field.dispatchEvent(new Event('input')); }",
                [file, text],
            )
            until(page, version + 1)
            if number:  # the first edit of a kind imports and compiles what the others have
                times[case].append(float(page.evaluate("document.body.dataset.milliseconds")))
            page.wait_for_timeout(400)
    page.close()
    return times


def main() -> None:
    from playwright.sync_api import sync_playwright

    with built() as folder, bare() as others, serving(folder) as address, serving(others) as plain:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
            pages = {
                "an empty page": f"{plain}empty.html",
                "a bare Pyodide": f"{plain}bare.html",
                "the first picture": address,
            }
            seconds: dict[str, list[float]] = {name: [] for name in pages}
            asked: list[str] = []
            for _ in range(ROUNDS):
                for name, page in pages.items():
                    took, urls = start(browser, page)
                    seconds[name].append(took)
                    asked = urls
            times = edits(browser, address)
            browser.close()
        sizes = fetched(folder, asked)
    for name, size in sorted(sizes.items(), key=lambda row: -row[1]):
        print(f"{size / 1000:9.1f} kB  {name}")
    total = sum(sizes.values())
    print(f"{total / 1000:9.1f} kB  compressed until the first picture (goal: at most {MOST_BYTES / 1000:.0f})\n")
    medians = {name: statistics.median(values) for name, values in seconds.items()}
    last = medians["the first picture"]
    for name, median in medians.items():
        print(
            f"{median:7.2f} s  {name}"
            + (f" (the first picture takes {last / median:.1f} times as long)" if median != last else "")
        )
    print(f"           goal: at most {MOST_SECONDS:.0f} s\n")
    for case, values in times.items():
        print(f"{statistics.median(values):6.0f} ms  from an edit of {case} to its picture, at most {max(values):.0f}")
    print(f"           goal: at most {MOST_MILLISECONDS:.0f} ms")


if __name__ == "__main__":
    main()
