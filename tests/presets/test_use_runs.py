"""What `sssgen use` writes runs: the page of three.js in Chromium, the project in Godot; the lamp shines through."""

from __future__ import annotations

import contextlib
import subprocess
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preview_page import NEEDS, browser
from skips import or_skip
from sssgen.cli.main import main
from sssgen.run import compilers
from sssgen.run.compilers.godot_process import find
from sssgen.scene.arrays import Array
from sssgen.support.folder_server import served

__all__ = ["browser"]  # the fixture

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
