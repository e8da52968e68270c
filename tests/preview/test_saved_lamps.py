"""The lamps of the page in the file of a person's scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("tomlkit")
pytest.importorskip("igl")

MATERIAL = '[material]\nname = "stone"\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'
SCENE = """material = "stone.toml"

[[light]]  # the window
direction = [0.0, 0.0, 1.0]

[[light]]
position = [0.0, 2.0, 0.0]
color = [1.0, 0.5, 0.25]

[geometry]  # a ball
kind = "ball"
"""
FAR: dict[str, Any] = {"position": [0.6, 0.8, 0.0, 0.0], "color": [2.0, 2.0, 1.0]}
NEAR: dict[str, Any] = {"position": [1.0, -2.0, 3.0, 1.0], "color": [4.0, 5.0, 6.0]}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def save(path: Path, *lights: dict[str, Any]) -> str:
    return PageMessages(Pane(str(path))).answer({"kind": "lights", "pane": 0, "lights": list(lights)})


def seen(path: Path) -> list[dict[str, Any]]:
    """The lamps of the picture, as the page gets them."""
    lights: list[dict[str, Any]] = Pane(str(path)).picture.head["lights"]
    return lights


@pytest.mark.parametrize("lights", [(), (FAR,), (NEAR, FAR), (FAR, FAR, NEAR), (NEAR, NEAR, NEAR, FAR)])
def test_the_scene_has_the_lamps_of_the_page(scene: Path, lights: tuple[dict[str, Any], ...]) -> None:
    assert save(scene, *lights) == f"Saved: {len(lights)} lamps in {scene.as_posix()}."
    assert [light["color"] for light in seen(scene)] == [light["color"] for light in lights]
    for light, wanted in zip(seen(scene), lights, strict=True):
        assert light["position"] == pytest.approx(wanted["position"])
    text = scene.read_text(encoding="utf-8")
    assert text.startswith('material = "stone.toml"\n') and "[geometry]  # a ball\n" in text
    assert ("# the window" in text) == bool(lights)


def test_lamps_are_saved_where_the_lights_are_an_array_in_one_line(scene: Path) -> None:
    scene.write_text(
        'material = "stone.toml"\nlight = [{direction = [0.0, 0.0, 1.0]}]\n[geometry]\nkind = "ball"\n', "utf-8"
    )
    save(scene, NEAR, FAR)
    assert [light.color for light in load(str(scene)).lights] == [(4.0, 5.0, 6.0), (2.0, 2.0, 1.0)]


def test_a_material_without_a_scene_says_what_to_write(scene: Path) -> None:
    scene.unlink()
    material = scene.with_name("stone.toml")
    with pytest.raises(SssgenError, match=r"has no scene[\s\S]*scene.toml"):
        save(material, FAR)
    assert material.read_text(encoding="utf-8") == MATERIAL


def test_the_scenes_that_come_with_sssgen_stay() -> None:
    with pytest.raises(SssgenError, match="sssgen new ice --copy ice"):
        PageMessages(Pane("ice")).answer({"kind": "lights", "pane": 0, "lights": [FAR]})


@pytest.mark.parametrize(
    "light",
    [
        {"position": [0.0, 0.0, 0.0, 0.0], "color": [1.0, 1.0, 1.0]},
        {"position": [0.0, 0.0, 1.0], "color": [1.0, 1.0, 1.0]},
        {"position": [0.0, float("nan"), 0.0, 1.0], "color": [1.0, 1.0, 1.0]},
        {"position": [0.0, 0.0, 0.0, 1.0], "color": [1.0, 1.0]},
        {"position": "1231", "color": None},
    ],
)
def test_a_faulty_lamp_is_refused(scene: Path, light: dict[str, Any]) -> None:
    with pytest.raises((ValueError, TypeError, KeyError)):
        save(scene, FAR, light)
    assert scene.read_text(encoding="utf-8") == SCENE


def test_more_lamps_than_a_scene_has_are_refused(scene: Path) -> None:
    with pytest.raises(ValueError, match="5"):
        save(scene, *[FAR] * 5)


def test_the_page_knows_what_the_passes_of_a_material_see(scene: Path) -> None:
    assert Pane(str(scene)).picture.head["lamp_passes"] == []
    assert Pane("jade_ring").picture.head["lamp_passes"] == [{"seen_from": "distant light", "views": 1}]
