"""What a picture keeps from the one before, and what it makes anew when a file changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.preview import body_triangles
from sssgen.preview.pane import Pane
from sssgen.run.render import scene_values
from sssgen.support import cache

pytest.importorskip("igl")
Image = pytest.importorskip("PIL.Image")

MATERIAL = '[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'
SCENE = """material = "stone.toml"
[geometry]
kind = "distance"
technique = "pebble.sss"
[camera]
position = [0.0, 0.0, 4.0]
[[light]]
direction = [0.0, 0.0, 1.0]
color = [1.0, 1.0, 1.0]
"""
BODY = "/// A pebble.\nfloat pebble(object_position at) {{ return length(at) - {radius}; }}\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(body_triangles, "RESOLUTION", 16)
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "_folder", None)
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    (tmp_path / "pebble.sss").write_text(BODY.format(radius="0.5"), encoding="utf-8")
    return tmp_path


def test_an_edited_distance_function_is_another_body(folder: Path) -> None:
    shown = Pane(str(folder / "scene.toml"))
    before = shown.picture.head["body"]
    (folder / "stone.toml").write_text(MATERIAL + "tint = [0.1, 0.2, 0.3, 1.0]\n", encoding="utf-8")
    shown.renew()
    assert shown.picture.head["body"] == before and not shown.error
    assert str(folder / "pebble.sss") in shown.files, "it is watched also where the body is kept"
    (folder / "pebble.sss").write_text(BODY.format(radius="0.75"), encoding="utf-8")
    shown.renew()
    assert shown.picture.head["body"] != before and not shown.error


def test_a_texture_is_read_again_once_its_file_changes(tmp_path: Path) -> None:
    file = tmp_path / "one.png"
    entry = {"source_name": "one", "type": "sampler2D", "color_space": "linear"}
    Image.new("RGB", (2, 2), (255, 0, 0)).save(file)
    first = scene_values._picture(str(file), "repeat", entry)
    assert scene_values._picture(str(file), "repeat", entry) is first
    assert scene_values._picture(str(file), "clamp", entry).wrap == "clamp"
    Image.new("RGB", (2, 2), (0, 255, 0)).save(file)
    second = scene_values._picture(str(file), "repeat", entry)
    assert first.levels[0][0, 0].tolist() != second.levels[0][0, 0].tolist()


def test_the_memory_of_textures_is_bounded(tmp_path: Path) -> None:
    for number in range(scene_values.MOST_TEXTURES + 4):
        file = tmp_path / f"{number}.png"
        Image.new("RGB", (1, 1)).save(file)
        scene_values._picture(str(file), "repeat", {"source_name": "a", "type": "sampler2D", "color_space": "linear"})
    assert len(scene_values._kept_textures) <= scene_values.MOST_TEXTURES
