"""The page of `sssgen use` with WebGPU and no engine: its shaders are valid, and it runs in Chromium."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ring_page import SIZE, check_coral, ring
from sssgen.cli.main import main
from sssgen.run.compilers.compiler_interface import Compiler, Source
from sssgen.support.folder_server import served
from webgpu_browser import READ, STAND_IN, browser

__all__ = ["browser", "ring"]  # the fixtures
FEW_FRAMES = """
    let left = 2;
    const ask = requestAnimationFrame;
    globalThis.requestAnimationFrame = (draw) => (left-- > 0 ? ask(draw) : 0);"""
"""A frame takes seconds without a GPU."""


@pytest.mark.parametrize("name", ["naga", pytest.param("tint", marks=pytest.mark.slow)])
def test_the_shaders_of_the_webgpu_page(name: str, ring: str, compiler: Callable[[str], Compiler]) -> None:
    assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out"]) == 0
    for shader in ("coral", "ground"):
        assert not compiler(name).check(Source(Path("out", f"{shader}.wgsl").read_text(encoding="utf-8"), "wgsl"))


def open_page(browser: Any, script: str) -> Any:
    page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
    page.set_default_timeout(120_000)
    page.add_init_script(script)
    return page


@pytest.mark.slow
@pytest.mark.parametrize("quality", ["fast", "good"])
def test_the_page(quality: str, ring: str, browser: Any) -> None:
    assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out", "--quality", quality]) == 0
    page = open_page(browser, STAND_IN + FEW_FRAMES)
    with contextlib.closing(page), served("out") as address:
        page.goto(address)
        page.wait_for_function("() => globalThis.shown || document.querySelector('#message').textContent", polling=100)
        assert page.inner_text("#message") == ""
        assert page.locator("#panel input").count() == 3
        picture = np.array(page.evaluate(READ), np.float64).reshape(SIZE[1], SIZE[0], 4)[..., :3]
    check_coral(picture)
    assert picture[2, 2] == pytest.approx([20.0, 21.0, 24.0], abs=1.0)  # the air
    below = picture[SIZE[1] * 3 // 4 :]
    assert (below.min(axis=-1) > 40.0).mean() > 0.2  # the lamp lights the ground
    assert (below.max(axis=-1) < 12.0).mean() > 0.02  # and the ring throws a shadow on it


@pytest.mark.slow
def test_a_browser_without_webgpu_is_told_so(ring: str, browser: Any) -> None:
    assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out", "--quality", "fast"]) == 0
    page = open_page(browser, "Object.defineProperty(navigator, 'gpu', { value: undefined });")
    with contextlib.closing(page), served("out") as address:
        page.goto(address)
        page.wait_for_function("() => document.querySelector('#message').textContent", polling=100)
        assert "needs WebGPU" in page.inner_text("#message")
        assert "--target threejs" in page.inner_text("#message")
