"""The picture of a hero by three.js in Chromium, without a GPU."""

from __future__ import annotations

import base64
import contextlib
import sys
from typing import Any

import numpy as np

from hero_stage.prepare import Prepared
from sssgen.run.machine_parts import chromium
from sssgen.support.folder_server import served

SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_MINUTES = 60_000.0


def draw(prepared: Prepared, size: tuple[int, int], frames: int) -> np.ndarray:
    """Linear light, (height, width, 3), row 0 above. Raises RuntimeError for errors of the page."""
    from playwright.sync_api import sync_playwright

    width, height = size
    with sync_playwright() as driver, served(str(prepared.folder)) as address:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        page = browser.new_page()
        page.set_default_timeout(10 * _MINUTES)
        messages: list[str] = []
        page.on("pageerror", lambda error: messages.append(str(error)))
        page.on("console", lambda text: messages.append(text.text) if text.type in ("error", "warning") else None)
        page.goto(f"{address}?width={width}&height={height}")
        with contextlib.suppress(KeyboardInterrupt):
            page.evaluate("async () => { window.stage = await window.hero; }")
            for number in range(frames):
                page.evaluate("() => { window.stage.frame(); }")
                print(f"{prepared.hero.name}: frame {number + 1} of {frames}", file=sys.stderr, flush=True)
        pixels = base64.b64decode(page.evaluate("() => window.stage.picture()"))
        browser.close()
    for message in dict.fromkeys(messages):
        print(f"{prepared.hero.name}: {message[:600]}")
    picture: Any = np.frombuffer(pixels, np.float32).reshape(height, width, 4)
    return np.array(picture[::-1, :, :3])
