"""The picture of a hero by three.js in Chromium, without a GPU."""

from __future__ import annotations

import base64
import sys
from collections.abc import Iterator, Sequence

import numpy as np

from hero_stage.prepare import Prepared
from sssgen.run.machine_parts import chromium
from sssgen.support.folder_server import served

SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_TIMEOUT = 600_000.0


def draw(prepared: Prepared, size: tuple[int, int], frames: int) -> np.ndarray:
    """Linear light, (height, width, 3), row 0 above. Raises RuntimeError for errors of the page."""
    return next(_pictures(prepared, size, frames, [0.0]))


def draw_loop(prepared: Prepared, size: tuple[int, int], frames: int, count: int) -> Iterator[np.ndarray]:
    """`count` pictures, as `draw` has them, while the lamps go around the bodies once."""
    return _pictures(prepared, size, frames, [360.0 * number / count for number in range(count)])


def _pictures(prepared: Prepared, size: tuple[int, int], frames: int, angles: Sequence[float]) -> Iterator[np.ndarray]:
    from playwright.sync_api import sync_playwright

    width, height = size
    with sync_playwright() as driver, served(str(prepared.folder)) as address:
        browser = driver.chromium.launch(executable_path=chromium(), args=SWITCHES)
        page = browser.new_page()
        page.set_default_timeout(_TIMEOUT)
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(f"{address}?width={width}&height={height}")
        page.evaluate("async () => { window.stage = await window.hero; }")
        for angle in angles:
            page.evaluate("(angle) => window.stage.turn(angle)", angle)
            for number in range(frames):
                page.evaluate("() => window.stage.frame()")
                print(f"{prepared.hero.name}: frame {number + 1} of {frames}", file=sys.stderr, flush=True)
            pixels = base64.b64decode(page.evaluate("() => window.stage.picture()"))
            if errors:
                raise RuntimeError(f"{prepared.hero.name}: {errors[0]}")
            yield np.frombuffer(pixels, np.float32).reshape(height, width, 4)[::-1, :, :3].copy()
        browser.close()
