"""What `sssgen use` writes runs: the page of three.js in Chromium, the project in Godot; the lamp shines through."""

from __future__ import annotations

import contextlib
import subprocess
from pathlib import Path
from typing import Any

import pytest

from gltf_validation import validate
from preview_page import NEEDS, browser
from ring_page import SIZE, check_coral, pixels, ring
from skips import or_skip
from sssgen.cli.main import main
from sssgen.run import compilers
from sssgen.run.compilers.godot_process import find
from sssgen.support.folder_server import served

__all__ = ["browser", "ring"]  # the fixtures

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


@pytest.mark.parametrize("name", ["wax", "honey", "leaf"])
def test_the_gltf_file_is_valid(name: str, ring: str) -> None:
    assert main(["use", name, ring, "--target", "gltf", "-o", "out"]) == 0
    validate(Path("out", f"{name}.glb"))
    wanted = {
        "wax": "KHR_materials_volume", "honey": "KHR_materials_transmission",
        "leaf": "KHR_materials_diffuse_transmission",
    }  # fmt: skip
    assert wanted[name].encode() in Path("out", f"{name}.glb").read_bytes()


def shot_in_godot(files: dict[str, str | bytes]) -> Any:
    """The pixels of a project that Godot draws."""
    or_skip(compilers.get, "godot")
    godot = find()
    with godot.display() as display, godot.project(files | {"shot.gd": SHOT}) as project:
        inside = f"/{project.relative_to(godot.root)}" if godot.root else str(project)
        command = godot.command(godot.program, "--headless", "--path", inside, "--import")
        subprocess.run(command, capture_output=True, timeout=300, check=False)
        options = ["--rendering-method", "forward_plus", "--rendering-driver", "vulkan"]
        printed = godot.run(project, "shot.gd", options, 300.0, display)
        assert "SCRIPT ERROR" not in printed and "SHADER ERROR" not in printed, printed
        return pixels((project / "shot.png").read_bytes())


def project_files() -> dict[str, str | bytes]:
    return {path.name: path.read_bytes() for path in Path("out").iterdir() if path.is_file()}


@pytest.mark.slow
def test_the_project_of_godot(ring: str) -> None:
    assert main(["use", "coral", ring, "--target", "godot", "-o", "out"]) == 0
    check_coral(shot_in_godot(project_files()))


WALL = """
[sub_resource type="StandardMaterial3D" id="paint"]
shading_mode = 0
albedo_color = Color(COLOR, 1)

[sub_resource type="BoxMesh" id="wall"]
material = SubResource("paint")
size = Vector3(20, 20, 0.1)

[node name="Main" """
STANDS = """
[node name="Wall" type="MeshInstance3D" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -6)
mesh = SubResource("wall")
"""


@pytest.mark.slow
def test_a_clear_body_shows_what_is_behind_it_in_godot(ring: str) -> None:
    assert main(["use", "ice", ring, "--target", "godot", "-o", "out"]) == 0
    files, shots = project_files(), []
    scene = Path("out", "main.tscn").read_text(encoding="utf-8")
    for color in ("1, 0, 0", "0, 0, 1"):
        text = scene.replace('\n[node name="Main" ', WALL.replace("COLOR", color)) + STANDS
        shots.append(shot_in_godot(files | {"main.tscn": text}).astype(float))
    red, blue = (shot[int(0.27 * shot.shape[0]), shot.shape[1] // 2] for shot in shots)  # in the upper part of the ring
    assert red[0] > 150.0 and red[2] < 60.0 and blue[2] > 150.0 and blue[0] < 60.0
