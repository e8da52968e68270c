"""Measures the live preview: `make bench`, or python benchmarks/bench_preview.py [EXAMPLE...].

For each example, in a headless Chromium on SwiftShader, WebGL 2: the milliseconds from the write on disk to the page's
new picture, drawn and read back; the median of saves that change one value, and of saves that change a line of a
technique. `frame` is what the page needs to draw a picture at full resolution; the ratios are to it. Where a frame is
slow, the first picture after a change has the share of the resolution in column `share`, and that of full resolution
follows after a rest: `full`, for a changed value. `slider` is the number of the page's frames from a moved slider to
the picture, and the milliseconds.

The rows before these are of the first picture: the seconds from the start of the command `sssgen preview` to its
address, to the page's own start, to the message with the picture, to the picture, and to that of full resolution; with
an empty cache folder, and with the one that the first run has left.

The last rows change one value 10,000 times without a browser, and a technique's line after each hundred: the memory of
the process at the start, in the middle and at the end.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from sssgen.material import library
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.preview.preview_server import PreviewServer
from sssgen.run.machine_parts import chromium
from sssgen.support.paths import folder

VALUE_SAVES, LINE_SAVES, FRAMES = 10, 5, 5
FIRST = 3
"""Examples whose first pictures are measured."""
EDITS = 10_000
GOAL = 100.0
"""Milliseconds from a save to its picture."""
SECONDS = 90.0
"""After which a page that does not answer has failed."""

SIZE = {"width": 640, "height": 300}
SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

VALUES = re.compile(r"(?<=return )[^;]+(?=;)|(?<= = )[^;=,()]+(?=;)")
"""What a technique's function returns or assigns."""

MEASURE = """
() => {
  const { stage } = preview;
  const gl = stage.renderer.backend.gl;
  const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  const show = stage.show.bind(stage);
  globalThis.shown = [];
  stage.show = async (picture, values) => { await show(picture, values); finish(); shown.push(Date.now()); };
  globalThis.frame = async () => {
    const start = performance.now();
    stage.resolution(1); stage.frame(); finish();
    return performance.now() - start;
  };
  globalThis.slide = (share) => new Promise((done) => {
    const slider = document.querySelector('#controls input[type=range]');
    slider.value = 1000 * share;
    const [start, drawn] = [performance.now(), stage.drawn];
    let frames = 0;
    const look = () => {
      frames += 1;
      if (stage.drawn === drawn) return requestAnimationFrame(look);
      finish();
      done([frames, performance.now() - start]);
    };
    slider.dispatchEvent(new Event('input'));
    requestAnimationFrame(look);
  });
}
"""


TIMES = """
() => {
  const times = globalThis.times = {};
  const now = () => (performance.timeOrigin + performance.now()) / 1000;
  const Socket = WebSocket;
  globalThis.WebSocket = class extends Socket {
    constructor(...all) {
      super(...all);
      times.page = now();
      this.addEventListener('message', () => { times.message ??= now(); });
    }
  };
  const look = () => {
    if (document.body?.dataset.version) times.picture ??= now();
    if (times.picture && globalThis.preview?.stage?.drafts.sharp) times.full ??= now();
    if (!times.full) setTimeout(look, 5);
  };
  look();
}
"""


class Example:
    """An example in a folder of its own, with one of its techniques beside it, whose lines can be changed."""

    def __init__(self, root: Path, name: str) -> None:
        shutil.copytree(folder("examples") / name, root / name)
        self.file = root / name / f"{name}.toml"
        self.shown = Pane(str(self.file))
        self.control = next(
            control
            for control in self.shown.picture.head["controls"]
            if control["range"] and not (control["drawn"] or control["in_scene"])
            and control["type"] in ("float", "vec2", "vec3", "vec4")
        )  # fmt: skip
        self.technique = self.own_technique()

    def save_value(self, number: int) -> None:
        """Another value in the file."""
        low, high = self.control["range"]
        values = [*self.control["value"]]
        values[0] = low + (high - low) * (0.3 + 0.4 * (number % 1009) / 1009)
        self.shown.save({self.control["property"]: values})

    def own_technique(self) -> tuple[Path, list[str]]:
        """A copy of a technique that the material then takes, and its text around a factor that can be changed."""
        before = self.file.read_text("utf-8")
        for name in dict.fromkeys(re.findall(r'^technique = "(\w+)"', before, re.MULTILINE)):
            text = Path(library.index()[name]).read_text("utf-8")
            copy = self.file.with_name(f"{name}.sss")
            if copy.exists():
                continue
            self.file.write_text(before.replace(f'technique = "{name}"', f'technique = "{name}.sss"', 1), "utf-8")
            for found in [*VALUES.finditer(text)][::-1][:8]:
                parts = [text[: found.start()], found[0], text[found.end() :]]
                copy.write_text(text, "utf-8")
                self.shown.renew()
                module = self.shown.picture.head["module"]
                copy.write_text(self.line(parts, 1), "utf-8")
                self.shown.renew()
                if not self.shown.error and self.shown.picture.head["module"] != module:
                    return copy, parts
            copy.unlink()
            self.file.write_text(before, "utf-8")
        raise SystemExit(f"{self.file}: no technique whose line can be changed")

    @staticmethod
    def line(halves: list[str], number: int) -> str:
        return f"{halves[0]}({halves[1]}) * {1.0 + number / 1e5:.5f}{halves[2]}"

    def save_line(self, number: int) -> None:
        """Another line in the technique's file."""
        path, halves = self.technique
        path.write_text(self.line(halves, number), "utf-8")


@contextlib.contextmanager
def served(shown: Pane) -> Iterator[str]:
    """The address of a server in a thread of its own."""
    server, started, loop = PreviewServer(PageMessages(shown)), threading.Event(), asyncio.new_event_loop()
    task = loop.create_task(server.run(0, False, lambda _: started.set()))

    def run() -> None:
        with contextlib.suppress(asyncio.CancelledError):
            loop.run_until_complete(task)

    thread = threading.Thread(target=run)
    thread.start()
    started.wait(60)
    try:
        yield server.url
    finally:
        loop.call_soon_threadsafe(task.cancel)
        thread.join()


def until(page: Any, holds: str) -> None:
    """Waits until an expression of the page is true."""
    end = time.monotonic() + SECONDS
    while not page.evaluate(holds):
        if time.monotonic() > end:
            raise SystemExit(f"{holds}: {page.inner_text('#error')}{page.inner_text('#status')}")
        page.wait_for_timeout(10)


def saves(page: Any, save: Any, count: int) -> tuple[float, float]:
    """The medians of the milliseconds from a save to its picture, and to that of full resolution."""
    times, sharp = [], []
    for number in range(count):
        page.evaluate("shown.length = 0")
        start = time.time()
        save(number + 2)
        until(page, "shown.length > 0")
        times.append(page.evaluate("shown[0]") - 1e3 * start)
        until(page, "preview.stage.drafts.sharp")
        sharp.append(1e3 * (time.time() - start))
    return statistics.median(times), statistics.median(sharp)


def row(browser: Any, root: Path, name: str) -> tuple[float, float]:
    """Prints the row of an example, and returns the two medians."""
    example = Example(root, name)
    with served(example.shown) as url:
        page = browser.new_page(viewport=SIZE)
        page.goto(url)
        until(page, "preview.stage?.drafts.sharp")
        if page.evaluate("preview.stage.kind") != "webgl2":
            page.select_option("#renderer", "webgl2")
            until(page, "preview.stage?.kind === 'webgl2' && preview.stage.drafts.sharp")
        page.evaluate(MEASURE)
        frame = statistics.median(page.evaluate("frame()") for _ in range(FRAMES))
        value, sharp = saves(page, example.save_value, VALUE_SAVES)
        line, _ = saves(page, example.save_line, LINE_SAVES)
        slides = []
        for number in range(5):
            slides.append(page.evaluate(f"slide({0.2 + 0.1 * number})"))
            until(page, "preview.stage.drafts.sharp")
        share = page.evaluate("1 / 2 ** preview.stage.drafts.level")
        page.close()
    frames, moved = (statistics.median(one[index] for one in slides) for index in (0, 1))
    times = f"{frame:8.1f} {value:8.1f} {line:8.1f} {sharp:8.1f} {share:6.2f}"
    print(f"{name:14} {times}  {value / frame:5.1f} {line / frame:5.1f}   {frames:.0f} in {moved:.0f} ms", flush=True)
    return value, line


def first(browser: Any, name: str, cache: str) -> None:
    """Prints the row of the first picture of an example."""
    page = browser.new_page(viewport=SIZE)
    page.add_init_script(f"({TIMES})()")
    start = time.time()
    command = [sys.executable, "-m", "sssgen", "preview", name, "--no-browser"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "SSSGEN_CACHE": cache}
    ) as server:
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        times = [time.time()]
        page.goto(address)
        until(page, "times.full")
        times += [page.evaluate(f"times.{event}") for event in ("page", "message", "picture", "full")]
        server.terminate()
    page.close()
    print(f"{name:14} {' '.join(f'{one - start:8.2f}' for one in times)}", flush=True)


def resident() -> float:
    """The resident memory of this process in MB."""
    pages = Path("/proc/self/statm").read_text("ascii").split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE") / 1e6


def memory(root: Path, name: str, edits: int) -> None:
    """Prints the resident memory over many edits."""
    example, sizes = Example(root, name), []
    for number in range(edits + 1):
        if number % 100 == 0:
            example.save_line(number // 100 + 2)
        else:
            example.save_value(number)
        example.shown.renew()
        if example.shown.error:
            raise SystemExit(example.shown.error)
        if number in (min(500, edits // 4), edits // 2, edits):
            sizes.append(f"{resident():.0f} MB after {number}")
    print(f"{name}: resident {', '.join(sizes)} edits", flush=True)


def main(names: list[str]) -> None:
    from playwright.sync_api import sync_playwright

    chosen = names or sorted(
        path.parent.name for path in folder("examples").glob("*/scene.toml") if path.parent.name != "jelly_cubes"
    )
    with tempfile.TemporaryDirectory() as cache, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        print(f"{'first, s':14} {' '.join(f'{one:>8}' for one in ('address', 'page', 'message', 'picture', 'full'))}")
        for name in chosen[:FIRST]:
            first(browser, name, cache)
            first(browser, name, cache)
        browser.close()
    columns = f"{'frame ms':>8} {'value':>8} {'line':>8} {'full':>8} {'share':>6}"
    print(f"{'':14} {columns}  ratios to frame  slider: frames")
    with tempfile.TemporaryDirectory() as root, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        medians = [row(browser, Path(root), name) for name in chosen]
        browser.close()
        within = [sum(one[index] <= GOAL for one in medians) for index in (0, 1)]
        print(f"within {GOAL:.0f} ms: {within[0]} of {len(chosen)} (value), {within[1]} of {len(chosen)} (line)")
    if not names:
        with tempfile.TemporaryDirectory() as root:
            memory(Path(root), "skin_ear", EDITS)


if __name__ == "__main__":
    main(sys.argv[1:])
