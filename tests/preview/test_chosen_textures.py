"""Pictures in texture slots: shown at once, saved beside the file that names the texture."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.pictures.images import png_bytes
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("tomlkit")
pillow = pytest.importorskip("PIL.Image")

MATERIAL = """# a stone
[material]
name = "stone"
shading = "lit"

[[surface]]
technique = "base_color"  # with a picture
tint = [1.0, 1.0, 1.0, 1.0]
"""
SCENE = """material = "stone.toml"
[geometry]
kind = "ball"
[textures]
base_color_texture = { file = "maps/old.png", wrap = "clamp" }  # drawn by hand
"""
RED = png_bytes(np.full((2, 4, 3), [1.0, 0.0, 0.0]))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    return tmp_path


def slot(talk: PageMessages) -> dict[str, Any]:
    (row,) = talk.messages()[0]["picture"]["textures"]
    return row


def choose(talk: PageMessages, name: str, data: bytes) -> None:
    talk.answer({"kind": "texture", "slot": "baseColorTexture", "name": name}, data)


def texel(talk: PageMessages) -> list[float]:
    data = talk.piece(slot(talk)["texels"]["levels"][0]["data"])
    return np.frombuffer(data or b"", "<f2")[:4].astype(float).tolist()


def test_a_chosen_picture_is_shown_and_given_up(folder: Path) -> None:
    talk = PageMessages(Pane(str(folder / "stone.toml")))
    assert slot(talk)["chosen"] == ""
    choose(talk, "my red.png", RED)
    assert slot(talk)["chosen"] == "my_red.png" and slot(talk)["texels"]["levels"][0]["size"] == (4, 2)
    assert texel(talk) == [1.0, 0.0, 0.0, 1.0]
    choose(talk, "", b"")
    assert slot(talk)["chosen"] == ""
    assert {path.name for path in folder.iterdir()} == {"stone.toml"}


def test_a_jpeg_becomes_a_png(folder: Path) -> None:
    buffer = io.BytesIO()
    pillow.new("RGB", (8, 8), (0, 255, 0)).save(buffer, "JPEG")
    talk = PageMessages(Pane(str(folder / "stone.toml")))
    choose(talk, "leaf.JPG", buffer.getvalue())
    assert slot(talk)["chosen"] == "leaf.png" and texel(talk)[1] == pytest.approx(1.0, abs=0.02)


def test_a_picture_is_saved_beside_the_material(folder: Path) -> None:
    talk = PageMessages(Pane(str(folder / "stone.toml")))
    choose(talk, "red.png", RED)
    said = talk.answer({"kind": "save", "values": {}})
    assert said == f"red.png is written, and {folder / 'stone.toml'} names it."
    assert (folder / "stone.toml").read_text(encoding="utf-8") == f'{MATERIAL}base_color_texture = "red.png"\n'
    assert (folder / "red.png").read_bytes() == RED
    assert slot(talk)["chosen"] == "" and texel(talk) == [1.0, 0.0, 0.0, 1.0]


def test_a_picture_of_the_scene_is_saved_where_the_old_one_is_and_overwrites_none(folder: Path) -> None:
    (folder / "maps").mkdir()
    old = png_bytes(np.zeros((2, 2, 3)))
    (folder / "maps" / "old.png").write_bytes(old)
    (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
    talk = PageMessages(Pane(str(folder / "scene.toml")))
    choose(talk, "old.png", RED)
    assert slot(talk)["texels"]["wrap"] == "clamp"
    talk.answer({"kind": "save", "values": {}})
    expected = SCENE.replace("maps/old.png", "maps/old_2.png")
    assert (folder / "scene.toml").read_text(encoding="utf-8") == expected
    assert [(folder / "maps" / name).read_bytes() for name in ("old.png", "old_2.png")] == [old, RED]
    assert (folder / "stone.toml").read_text(encoding="utf-8") == MATERIAL


@pytest.mark.parametrize(
    ("slot_name", "name", "data", "message"),
    [
        ("baseColorTexture", "a.png", b"no picture", "not a PNG"),
        ("baseColorTexture", "a.jpg", RED, "not a JPEG"),
        ("baseColorTexture", "a.exr", b"no picture", "a.exr"),
        ("baseColorTexture", "a.svg", RED, "not a texture's suffix"),
        ("nothing", "a.png", RED, "has no texture 'nothing'"),
    ],
)
def test_a_faulty_picture_is_refused_and_the_slot_stays(
    folder: Path, slot_name: str, name: str, data: bytes, message: str
) -> None:
    talk = PageMessages(Pane(str(folder / "stone.toml")))
    before = talk.messages()
    with pytest.raises(SssgenError, match=message):
        talk.answer({"kind": "texture", "slot": slot_name, "name": name}, data)
    assert talk.messages() == before


def test_a_texture_that_the_page_draws_takes_no_picture(folder: Path) -> None:
    with (folder / "stone.toml").open("a", encoding="utf-8") as file:
        file.write('[[thickness]]\ntechnique = "depth_map_thickness"\n[translucency]\ntechnique = "absorption_tint"\n')
    talk = PageMessages(Pane(str(folder / "stone.toml")))
    row = next(row for row in talk.messages()[0]["picture"]["textures"] if row["page_draws"])
    with pytest.raises(SssgenError, match="drawn for each frame"):
        talk.answer({"kind": "texture", "slot": row["property"], "name": "a.png"}, RED)
