"""A headless Chromium with WebGPU, for tests."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from sssgen.run.backends.browser_page import WEBGL, WEBGPU
from sssgen.run.machine_parts import all_lacks, chromium

STAND_IN = """
    GPUCanvasContext.prototype.configure = function (options) { this.options = options; };
    GPUCanvasContext.prototype.getCurrentTexture = function () {
      const { device, format, viewFormats } = this.options, size = [this.canvas.width, this.canvas.height];
      globalThis.shown = { device, format, texture: device.createTexture({ size, format, viewFormats, usage: 0x11 }) };
      return globalThis.shown.texture;
    };"""
"""Without a GPU, Chromium loses the device when a canvas with WebGPU is shown: a texture stands in for it."""
READ = """async () => {
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
"""The rows of what the page shows, from above."""


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
