"""docs/webgl-to-webgpu.md: its pages, followed step by step in a browser, show one picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from documents import Reader, blocks, programs, uncommented
from folders import DOCS, ROOT
from static_host import serving
from webgpu_browser import READ, STAND_IN, browser

__all__ = ["browser"]
DOCUMENT = DOCS / "webgl-to-webgpu.md"
DUMP = ROOT / "tools" / "dump_shaders.js"
SIZE = (240, 320)

DRAWN = """
    const create = GPUDevice.prototype.createTexture;
    GPUDevice.prototype.createTexture = function (options) {
      const texture = create.call(this, options);
      if ((options.usage & 5) === 5) globalThis.drawn ??= texture; // it is drawn and then read
      return texture;
    };"""
"""The picture that the page draws and then shows."""
READ_WEBGL = """() => {
    const gl = document.querySelector('canvas').getContext('webgl2');
    const { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
    const pixels = new Uint8Array(w * h * 4), row = w * 4;
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return Array.from({ length: h }, (_, y) => [...pixels.subarray((h - 1 - y) * row, (h - y) * row)]);
}"""
READ_BY_THE_STEP = """async () => {
    const { pixels } = await import('./pixels.js'), { device } = globalThis.shown;
    return [...await pixels(device, globalThis.drawn)];
}"""
"""The step of the page that reads a picture back, for the one that the page drew into."""


def test_every_block_is_a_step() -> None:
    assert not uncommented(DOCUMENT)


@pytest.mark.slow
def test_the_pages_show_one_picture(browser: Any, tmp_path: Path) -> None:
    environment = {"PYTHONPATH": str(ROOT / "src"), "SSSGEN_CACHE": str(tmp_path / "cache")}
    reader = Reader(tmp_path, programs(tmp_path / "programs"), environment)
    steps = blocks(DOCUMENT)
    pages = [step for step in steps if step.verb == "write"]
    for step in pages:
        reader.follow(step)
    with serving(tmp_path) as url:
        page = browser.new_page()
        page.add_init_script(path=str(DUMP))
        page.goto(f"{url}flag.html", wait_until="networkidle")
        files = page.evaluate("() => dumpedShaders.files()")
        original = np.array(page.evaluate(READ_WEBGL)).reshape(*SIZE, 4)
        for step in steps:
            if step.verb == "run":
                reader.follow(step)
        written = {
            name: (tmp_path / "shaders" / name).read_text(encoding="utf-8") for name in ("flag.vert", "flag.frag")
        }
        assert {name: files.get(name) for name in written} == written
        assert json.loads((tmp_path / "web" / "flag.program.json").read_text(encoding="utf-8"))["program"] == "flag"
        page = browser.new_page()
        complaints: list[str] = []
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.add_init_script(DRAWN + STAND_IN)
        page.goto(f"{url}flag_webgpu.html")
        page.wait_for_function("() => globalThis.shown", timeout=60_000)
        copy = np.array(page.evaluate(READ)).reshape(*SIZE, 4)
        read = np.array(page.evaluate(READ_BY_THE_STEP)).reshape(*SIZE, 4)
    assert [text for text in complaints if "favicon" not in text and "404" not in text] == []
    assert np.ptp(original[..., :3]) > 100
    assert np.abs(original - copy).max() <= 1
    assert np.abs(copy - read[::-1]).max() <= 1
