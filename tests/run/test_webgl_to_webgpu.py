"""docs/webgl-to-webgpu.md: its pages, followed step by step in a browser, show one picture."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from documents import Reader, blocks, programs, uncommented
from folders import DOCS, ROOT
from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.machine_parts import all_lacks, chromium
from static_host import serving

DOCUMENT = DOCS / "webgl-to-webgpu.md"
DUMP = ROOT / "tools" / "dump_shaders.js"
SIZE = (240, 320)

STAND_IN = """
    const create = GPUDevice.prototype.createTexture;
    GPUDevice.prototype.createTexture = function (options) {
      const texture = create.call(this, options);
      if ((options.usage & 5) === 5) globalThis.drawn ??= texture; // it is drawn and then read
      return texture;
    };
    GPUCanvasContext.prototype.configure = function (options) { this.options = options; };
    GPUCanvasContext.prototype.getCurrentTexture = function () {
      const { device, format } = this.options, size = [this.canvas.width, this.canvas.height];
      globalThis.shown = { device, format, texture: device.createTexture({ size, format, usage: 0x11 }) };
      return globalThis.shown.texture;
    };"""
"""Without a GPU, Chromium loses the device when a canvas with WebGPU is shown: a texture stands in for it."""
READ_WEBGL = """() => {
    const gl = document.querySelector('canvas').getContext('webgl2');
    const { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
    const pixels = new Uint8Array(w * h * 4), row = w * 4;
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return Array.from({ length: h }, (_, y) => [...pixels.subarray((h - 1 - y) * row, (h - y) * row)]);
}"""
READ_WEBGPU = """async () => {
    const { device, texture, format } = globalThis.shown, { width: w, height: h } = texture;
    const row = Math.ceil(w / 64) * 256;
    const buffer = device.createBuffer({ size: row * h, usage: 9 }), encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: row }, [w, h]);
    device.queue.submit([encoder.finish()]);
    await buffer.mapAsync(1);
    const pixels = new Uint8Array(buffer.getMappedRange());
    const order = format.startsWith('bgra') ? [2, 1, 0, 3] : [0, 1, 2, 3];
    const line = (y) => Array.from({ length: w * 4 }, (_, x) => pixels[y * row + (x & ~3) + order[x & 3]]);
    return Array.from({ length: h }, (_, y) => line(y));
}"""
READ_BY_THE_STEP = """async () => {
    const { pixels } = await import('./pixels.js'), { device } = globalThis.shown;
    return [...await pixels(device, globalThis.drawn)];
}"""
"""The step of the page that reads a picture back, for the one that the page drew into."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if lacking := all_lacks(["chromium"]):
        pytest.skip(lacking)
    from playwright.sync_api import sync_playwright

    switches = [switch.format(adapter="swiftshader") for switch in (*WEBGPU, WEBGL[2])]
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=["--no-sandbox", *switches])
        yield browser
        browser.close()


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
        page.add_init_script(STAND_IN)
        page.goto(f"{url}flag_webgpu.html")
        page.wait_for_function("() => globalThis.shown", timeout=60_000)
        copy = np.array(page.evaluate(READ_WEBGPU)).reshape(*SIZE, 4)
        read = np.array(page.evaluate(READ_BY_THE_STEP)).reshape(*SIZE, 4)
    assert [text for text in complaints if "favicon" not in text and "404" not in text] == []
    assert np.ptp(original[..., :3]) > 100
    assert np.abs(original - copy).max() <= 1
    assert np.abs(copy - read[::-1]).max() <= 1
