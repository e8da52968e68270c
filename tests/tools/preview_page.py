"""The page of the preview in a headless Chromium, for tests."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
import pytest

from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.preview.preview_server import PreviewServer
from sssgen.run.machine_parts import chromium
from sssgen.run.web_library import library
from sssgen.support.diagnostics import SssgenError

SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SECONDS = 90.0
"""After which a page that does not answer has failed."""


def lacks_three() -> bool:
    try:
        return not library().files
    except SssgenError:
        return True


NEEDS = [
    pytest.mark.slow,
    pytest.mark.skipif(not chromium(), reason="Chromium is missing"),
    pytest.mark.skipif(lacks_three(), reason="npm's three is missing"),
]
"""The marks of tests that open the page."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        yield browser
        browser.close()


class Shown:
    """A server in a thread of its own, and a page that shows it."""

    def __init__(self, browser: Any, *names: str | Pane, renderer: str = "webgl2") -> None:
        shown = [Pane(name) if isinstance(name, str) else name for name in names]
        self.server = PreviewServer(PageMessages(*shown))
        started = threading.Event()
        self.loop = asyncio.new_event_loop()
        self.task = self.loop.create_task(self.server.run(0, False, lambda _: started.set()))
        self.thread = threading.Thread(target=self._run)
        self.thread.start()
        assert started.wait(SECONDS)
        self.page = browser.new_page(viewport={"width": 692, "height": 300})
        self.faults: list[str] = []
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.goto(self.server.url)
        ready = "preview.stage?.drafts.sharp"
        self.until(lambda: self.page.evaluate(ready) or self.error())
        shown_by = self.page.evaluate("preview.stage?.kind ?? ''")
        if renderer not in ("webgpu", shown_by) and self.page.is_visible("#renderer"):
            self.page.select_option("#renderer", renderer)
            self.until(lambda: self.page.evaluate(f"preview.stage?.kind === '{renderer}' && {ready}"))

    def _run(self) -> None:
        asyncio.set_event_loop(self.loop)
        with contextlib.suppress(asyncio.CancelledError):
            self.loop.run_until_complete(self.task)

    def close(self) -> None:
        self.page.close()
        self.loop.call_soon_threadsafe(self.task.cancel)
        self.thread.join()

    def until(self, holds: Any) -> None:
        end = time.monotonic() + SECONDS
        while not holds():
            assert time.monotonic() < end, f"{self.error()} {self.faults}"
            self.page.wait_for_timeout(20)

    def version(self) -> int:
        return int(self.page.evaluate("document.body.dataset.version ?? 0"))

    def error(self) -> str:
        return str(self.page.inner_text("#error"))

    def picture(self) -> Any:
        """The canvas, (height, width, 3), 0 to 255."""
        from PIL import Image

        self.page.wait_for_timeout(100)
        self.until(lambda: self.page.evaluate("preview.stage?.drafts.sharp"))
        self.page.wait_for_timeout(100)
        return np.asarray(Image.open(BytesIO(self.page.locator("main canvas").screenshot())).convert("RGB"), float)
