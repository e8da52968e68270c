"""What `sssgen use` writes runs: the page of three.js in Chromium, the project in Godot; the lamp shines through."""

from __future__ import annotations

import contextlib
import subprocess
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gltf_validation import validate
from preview_page import NEEDS, browser
from skips import or_skip
from sssgen.cli.main import main
from sssgen.run import compilers
from sssgen.run.compilers.compiler_interface import Compiler, Source
from sssgen.run.compilers.godot_process import find
from sssgen.scene.arrays import Array
from sssgen.support.folder_server import served
from webgpu_browser import READ, STAND_IN
from webgpu_browser import browser as gpu_browser

__all__ = ["browser", "gpu_browser"]  # the fixtures

SIZE = (320, 240)
SHOT = """extends SceneTree
func _initialize() -> void:
	root.size = Vector2i(320, 240)
	root.add_child(load("res://main.tscn").instantiate())
	for i in 12: await process_frame
	await RenderingServer.frame_post_draw
	root.get_texture().get_image().save_png("res://shot.png")
	quit()
"""
"""A script that writes a picture of the project."""
FEW_FRAMES = """
    let left = 2;
    const ask = requestAnimationFrame;
    globalThis.requestAnimationFrame = (draw) => (left-- > 0 ? ask(draw) : 0);"""
"""A frame takes seconds without a GPU."""


@pytest.fixture
def ring(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")
    monkeypatch.chdir(tmp_path)
    trimesh.creation.torus(1.0, 0.4, major_sections=64, minor_sections=32).export("ring.obj")
    return "ring.obj"


def pixels(png: bytes) -> Array:
    """(height, width, 3), 0 to 255."""
    from PIL import Image

    return np.asarray(Image.open(BytesIO(png)).convert("RGB"), np.float64)


def check_coral(picture: Array) -> None:
    """A red body fills a part of the picture, and is bright although the lamp is behind it."""
    red = (picture[..., 0] > 90) & (picture[..., 0] > 2.0 * picture[..., 2])
    assert 0.02 < red.mean() < 0.5


class TestPage:
    pytestmark = NEEDS

    @pytest.mark.parametrize("quality", ["fast", "good"])
    def test_the_page_of_three(self, quality: str, ring: str, browser: Any) -> None:
        assert main(["use", "coral", ring, "-o", "out", "--quality", quality]) == 0
        page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
        page.set_default_timeout(120_000)
        with contextlib.closing(page), served("out") as address:
            page.goto(address)
            page.wait_for_timeout(3000)
            assert page.inner_text("#message") == ""
            page.evaluate("document.querySelector('#panel').remove()")
            check_coral(pixels(page.screenshot()))


class TestWebGpuPage:
    """The page without an engine; a texture stands in for the one of the canvas."""

    def open(self, gpu_browser: Any, script: str) -> Any:
        page = gpu_browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
        page.set_default_timeout(120_000)
        page.add_init_script(script)
        return page

    @pytest.mark.slow
    @pytest.mark.parametrize("quality", ["fast", "good"])
    def test_the_page(self, quality: str, ring: str, gpu_browser: Any) -> None:
        assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out", "--quality", quality]) == 0
        page = self.open(gpu_browser, STAND_IN + FEW_FRAMES)
        with contextlib.closing(page), served("out") as address:
            page.goto(address)
            page.wait_for_function(
                "() => globalThis.shown || document.querySelector('#message').textContent", polling=100
            )
            assert page.inner_text("#message") == ""
            assert page.locator("#panel input").count() == 3
            picture = np.array(page.evaluate(READ), np.float64).reshape(SIZE[1], SIZE[0], 4)[..., :3]
        check_coral(picture)
        assert picture[2, 2] == pytest.approx([20.0, 21.0, 24.0], abs=1.0)  # the air
        below = picture[SIZE[1] * 3 // 4 :]
        assert (below.min(axis=-1) > 40.0).mean() > 0.2  # the lamp lights the ground
        assert (below.max(axis=-1) < 12.0).mean() > 0.02  # and the ring throws a shadow on it

    @pytest.mark.slow
    def test_a_browser_without_webgpu_is_told_so(self, ring: str, gpu_browser: Any) -> None:
        assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out", "--quality", "fast"]) == 0
        page = self.open(gpu_browser, "Object.defineProperty(navigator, 'gpu', { value: undefined });")
        with contextlib.closing(page), served("out") as address:
            page.goto(address)
            page.wait_for_function("() => document.querySelector('#message').textContent", polling=100)
            assert "needs WebGPU" in page.inner_text("#message")
            assert "--target threejs" in page.inner_text("#message")


@pytest.mark.parametrize("name", ["naga", pytest.param("tint", marks=pytest.mark.slow)])
def test_the_shaders_of_the_webgpu_page(name: str, ring: str, compiler: Callable[[str], Compiler]) -> None:
    assert main(["use", "coral", ring, "--target", "webgpu", "-o", "out"]) == 0
    for shader in ("coral", "ground"):
        assert not compiler(name).check(Source(Path("out", f"{shader}.wgsl").read_text(encoding="utf-8"), "wgsl"))


@pytest.mark.parametrize("name", ["wax", "honey", "leaf"])
def test_the_gltf_file_is_valid(name: str, ring: str) -> None:
    assert main(["use", name, ring, "--target", "gltf", "-o", "out"]) == 0
    validate(Path("out", f"{name}.glb"))
    wanted = {
        "wax": "KHR_materials_volume", "honey": "KHR_materials_transmission",
        "leaf": "KHR_materials_diffuse_transmission",
    }  # fmt: skip
    assert wanted[name].encode() in Path("out", f"{name}.glb").read_bytes()


@pytest.mark.slow
def test_the_project_of_godot(ring: str) -> None:
    assert main(["use", "coral", ring, "--target", "godot", "-o", "out"]) == 0
    or_skip(compilers.get, "godot")
    godot = find()
    files: dict[str, str | bytes] = {path.name: path.read_bytes() for path in Path("out").iterdir() if path.is_file()}
    with godot.display() as display, godot.project(files | {"shot.gd": SHOT}) as project:
        inside = f"/{project.relative_to(godot.root)}" if godot.root else str(project)
        command = godot.command(godot.program, "--headless", "--path", inside, "--import")
        subprocess.run(command, capture_output=True, timeout=300, check=False)
        options = ["--rendering-method", "forward_plus", "--rendering-driver", "vulkan"]
        printed = godot.run(project, "shot.gd", options, 300.0, display)
        assert "SCRIPT ERROR" not in printed and "SHADER ERROR" not in printed, printed
        check_coral(pixels((project / "shot.png").read_bytes()))
