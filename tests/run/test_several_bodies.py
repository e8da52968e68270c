"""Scenes of several bodies, and glTF files that are drawn whole."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gltf_files import box, write_gltf
from sssgen.cli.main import main
from sssgen.preview.pane import Pane
from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.scene.pictures import images
from sssgen.scene.pictures.resizing import resized
from sssgen.scene.scene_loading import load, parse_scene
from sssgen.support.diagnostics import SssgenError
from textured_head import textured

WALL = {"name": "wall", "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.8, 0.2, 1.0], "metallicFactor": 0.0}}
RED = {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.05, 0.05, 1.0], "metallicFactor": 0.0}}


def glass(distance: float = 1.0) -> dict[str, Any]:
    """Clear red glass."""
    volume = {"thicknessFactor": 1.0, "attenuationColor": [0.9, 0.3, 0.3], "attenuationDistance": distance}
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_volume": volume}
    extensions["KHR_materials_ior"] = {"ior": 1.2}
    return {
        "name": "glass",
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.0},
        "extensions": extensions,
    }


def scene_of(
    folder: Path, parts: list[tuple[dict[str, Any], list[float], list[float]]], **more: Any
) -> tuple[Path, Path]:
    """A file of boxes with a camera in front of them, each with its material, place and scale; and its whole scene."""
    content, data = box()
    content["materials"] = [material for material, _, _ in parts]
    primitive = content["meshes"][0]["primitives"][0]
    content["meshes"] = [{"primitives": [{**primitive, "material": index}]} for index in range(len(parts))]
    nodes: list[dict[str, Any]] = [
        {"mesh": index, "translation": place, "scale": scale} for index, (_, place, scale) in enumerate(parts)
    ]
    nodes.append({"camera": 0, "translation": [0.0, 0.0, 5.0]})
    content["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 1.0, "znear": 0.1}}]
    content |= {"nodes": nodes, "scenes": [{"nodes": list(range(len(nodes)))}], **more}
    path = write_gltf(folder / "boxes.glb", content, data)
    assert main(["import", str(path), "-o", str(folder / "out"), "--force"]) == 0
    return path, folder / "out" / "scene.toml"


def drawn(scene: Path) -> Any:
    """The linear picture of 32 × 32 pixels, of one sample each."""
    backend = backends.require("numpy-f32")
    whole = parse_scene(scene.read_text().replace("samples = 2", "samples = 1"), scene)
    return render(whole, backend, (32, 32)).linear


BEHIND: tuple[list[float], list[float]] = ([0.0, 0.0, -2.0], [6.0, 6.0, 0.1])
MIDDLE: tuple[list[float], list[float]] = ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0])
FRONT: tuple[list[float], list[float]] = ([0.0, 0.0, 1.5], [0.2, 0.2, 0.2])


def test_glass_shows_what_is_behind_it_in_its_colour(tmp_path: Path) -> None:
    _, scene = scene_of(tmp_path, [(glass(), *MIDDLE), (WALL, *BEHIND)])
    picture = drawn(scene)
    wall, through = picture[1:4, 1:4].mean((0, 1)), picture[14:18, 14:18].mean((0, 1))
    assert wall[1] > 2.0 * wall[0]  # green
    assert through[1] < 0.75 * wall[1]  # absorbed
    assert through[1] > 0.15 * wall[1]  # and not opaque
    thick = drawn(scene_of(tmp_path, [(glass(0.3), *MIDDLE), (WALL, *BEHIND)])[1])[14:18, 14:18].mean((0, 1))
    assert thick[1] < 0.6 * through[1]  # a shorter attenuation distance is darker


def test_warnings_of_a_file_are_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of pictures in a format that is not read, and of a mesh, which is written elsewhere for the picture."""
    monkeypatch.chdir(tmp_path)
    content, data = textured()
    content["textures"][1] = {"extensions": {"KHR_texture_basisu": {"source": 0}}}
    del content["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    write_gltf(Path("head.glb"), content, data)
    command = ["render", "head.glb", "-o", "head.png", "--size", "16x16", "--backend", "numpy-f32", "--json"]
    assert main(command) == 0
    warnings = json.loads(capsys.readouterr().out)["diagnostics"]
    texts = [warning["message"] for warning in warnings]
    assert any("left out: /materials/0/normalTexture" in text for text in texts), texts
    assert any("the mesh has no texture coordinates" in text for text in texts), texts
    assert {warning["file"] for warning in warnings} == {"head.glb"}


def test_an_opaque_body_in_front_hides_the_glass_in_any_order(tmp_path: Path) -> None:
    parts = [(glass(), *MIDDLE), (RED, *FRONT), (WALL, *BEHIND)]
    first = drawn(scene_of(tmp_path, parts)[1])
    second = drawn(scene_of(tmp_path, parts[::-1])[1])
    np.testing.assert_allclose(first, second, atol=1e-6)
    middle = first[15:17, 15:17].mean((0, 1))
    assert middle[0] > 4.0 * middle[1]  # red


def test_the_nearer_of_two_clear_bodies_shows_the_farther(tmp_path: Path) -> None:
    clear = drawn(scene_of(tmp_path, [(glass(), *MIDDLE), (WALL, *BEHIND)])[1])
    near = ([0.0, 0.0, 1.5], [0.6, 0.6, 0.6])
    two = drawn(scene_of(tmp_path, [(glass(), *near), ({**glass(), "name": "b"}, *MIDDLE), (WALL, *BEHIND)])[1])
    assert two[15:17, 15:17, 1].mean() < 0.8 * clear[15:17, 15:17, 1].mean()


def test_the_lights_of_the_file_light_its_scene(tmp_path: Path) -> None:
    lights = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3.1416, "color": [0, 0, 1]}]}}
    _, scene = scene_of(tmp_path, [(WALL, *BEHIND)], extensions=lights)
    assert len(load(scene).lights) == 2  # no node has the light
    content = json.loads((scene.parent / "report.json").read_text())
    assert any(row["became"] == "camera" for row in content["rows"])
    assert load(scene).camera.position == (0.0, 0.0, 5.0)
    content, data = box(extensions=lights)
    content["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    path = write_gltf(tmp_path / "lit.glb", content, data)
    assert main(["import", str(path), "-o", str(tmp_path / "lit")]) == 0
    (light,) = load(tmp_path / "lit" / "scene.toml").lights
    assert light.direction == (0.0, 0.0, 1.0)
    np.testing.assert_allclose(light.color, (0.0, 0.0, 1.0), atol=1e-5)


def test_a_file_is_drawn_by_one_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, _ = scene_of(tmp_path, [(glass(), *MIDDLE), (WALL, *BEHIND)])
    output = tmp_path / "picture.png"
    command = ["render", str(path), "-o", str(output), "--size", "24x24", "--samples", "1", "-b", "numpy-f32"]
    assert main(command) == 0
    picture = images.encoded(str(output))
    assert picture.shape[:2] == (24, 24) and picture.std() > 0.02
    content, data = box()
    content["meshes"], content["nodes"] = [], [{}]
    assert main(["render", str(write_gltf(tmp_path / "empty.glb", content, data)), "-o", str(output)]) != 0
    assert "no triangles" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("extension", "command"),
    [("KHR_draco_mesh_compression", "copy"), ("EXT_meshopt_compression", "copy"), ("KHR_texture_basisu", "ktx")],
)
def test_compressed_files_are_refused_with_what_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], extension: str, command: str
) -> None:
    content, data = box(extensionsUsed=[extension], extensionsRequired=[extension])
    path = write_gltf(tmp_path / "box.glb", content, data)
    assert main(["render", str(path), "-o", str(tmp_path / "box.png")]) != 0
    error = capsys.readouterr().err
    assert extension in error and f"gltf-transform/cli {command}" in error
    assert not (tmp_path / "box.png").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('bodies = "a.toml"', "'bodies' is a list of scenes"),
        ('bodies = ["missing.toml"]', "cannot find the file 'missing.toml'"),
        ('bodies = ["scene.toml"]\nmaterial = "jelly"', "a scene has a body of its own, or those of others"),
        ('background = "environment"\nmaterial = "jelly"', "the scene has no environment to show"),
    ],
)
def test_faulty_scenes_of_bodies(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(SssgenError, match=message):
        parse_scene(text, tmp_path / "scene.toml")


def test_resized_pictures_keep_straight_lines() -> None:
    ramp = np.linspace(0.0, 1.0, 8)[None, :, None].repeat(4, axis=0)
    large = resized(ramp, 32, 16)
    assert large.shape == (16, 32, 1)
    np.testing.assert_allclose(np.diff(large[0, 4:28, 0]), 1.0 / 28.0, atol=1e-9)
    np.testing.assert_allclose(resized(large, 8, 4)[:, 1:-1], ramp[:, 1:-1], atol=1e-9)


def test_a_scene_of_bodies_is_shown_and_not_previewed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text('bodies = ["glass.toml", "wood.toml"]\n', encoding="utf-8")
    for name in ("glass.toml", "wood.toml"):
        Path(name).write_text('material = "jelly"\n[geometry]\nkind = "ball"\n', encoding="utf-8")
    assert main(["show", "scene.toml"]) == 0
    text = capsys.readouterr().out
    assert "bodies: 2, each with its own material\n  glass.toml\n  wood.toml\n" in text
    assert "none: the scene" not in text and "marches" not in text
    with pytest.raises(SssgenError, match=r"(?s)has 2 bodies.*open one of its scenes: glass\.toml, wood\.toml"):
        Pane("scene.toml")
