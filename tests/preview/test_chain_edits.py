"""The menus of the page: presets and techniques in the user's file, with reasons against them, and undo."""

from __future__ import annotations

import base64
from io import BytesIO
from pathlib import Path

import pytest

from slow_cases import diagonal
from sssgen.cli.main import main
from sssgen.material.material_loading import load_material
from sssgen.presets.preset import presets
from sssgen.preview.chain_edits import stage_rows, technique_rows
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.measured.media import media, preset
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("tomlkit")
pytest.importorskip("igl")


@pytest.fixture
def ring(in_folder: Path) -> Path:
    assert main(["new", "ring", "--copy", "jade_ring"]) == 0
    return in_folder / "ring" / "jade_ring.toml"


@pytest.fixture
def talk(ring: Path) -> PageMessages:
    return PageMessages(Pane("ring/scene.toml"))


def edit(talk: PageMessages, action: str, **more: object) -> str:
    return talk.answer({"kind": "edit", "action": action, **more})


def names(path: Path) -> list[str]:
    return [stage.technique.name for stage in load_material(str(path)).stages]


def test_a_stage_comes_goes_and_is_taken_back(talk: PageMessages, ring: Path) -> None:
    before = ring.read_text(encoding="utf-8")
    chain = names(ring)
    assert edit(talk, "add", technique="clearcoat_constants") == "jade_ring.toml is changed."
    assert sorted(names(ring)) == sorted([*chain, "clearcoat_constants"])
    assert talk.messages()[0]["undoes"] == "jade_ring.toml" and not talk.messages()[0]["error"]
    (row,) = [row for row in stage_rows(load_material(str(ring))) if row["technique"] == "clearcoat_constants"]
    edit(talk, "remove", path=row["path"])
    assert names(ring) == chain
    for _ in range(2):
        assert talk.answer({"kind": "undo"}) == "ring/jade_ring.toml is as it was before."
    assert ring.read_text(encoding="utf-8") == before
    with pytest.raises(SssgenError, match="nothing to undo"):
        talk.answer({"kind": "undo"})


def test_comments_stay(talk: PageMessages, ring: Path) -> None:
    before = ring.read_text(encoding="utf-8")
    edit(talk, "add", technique="sheen_constants")
    assert ring.read_text(encoding="utf-8").replace('[[surface]]\ntechnique = "sheen_constants"\n\n', "") == before


def test_what_does_not_link_is_refused_and_the_reason_is_in_the_menu(talk: PageMessages, ring: Path) -> None:
    before = ring.read_bytes()
    rows = {row["name"]: row for row in talk.reply({"kind": "techniques"})["rows"]}  # type: ignore[index]
    refused, fits = rows["absorption_tint"], rows["clearcoat_constants"]
    assert "takes a thickness" in refused["reason"] and not fits["reason"] and fits["summary"]
    with pytest.raises(SssgenError, match="takes a thickness"):
        edit(talk, "add", technique="absorption_tint")
    for path in [row["path"] for row in stage_rows(load_material(str(ring))) if row["role"] == "thickness"]:
        with pytest.raises(SssgenError, match="which no stage before it gives"):
            edit(talk, "remove", path=path)
    assert ring.read_bytes() == before and not talk.messages()[0]["undoes"]


def test_a_technique_takes_the_place_of_another(talk: PageMessages, ring: Path) -> None:
    material = load_material(str(ring))
    (row,) = [row for row in stage_rows(material) if row["technique"].startswith("interior_octaves")]
    offered = technique_rows(material, tuple(row["path"]))
    assert {offer.section for offer in offered} == {"translucency"}
    assert "interior_sample" in {offer.name for offer in offered if not offer.reason}
    edit(talk, "replace", technique="interior_sample", path=row["path"])
    assert "interior_sample" in names(ring) and row["technique"] not in names(ring)
    assert not talk.messages()[0]["error"]


@pytest.mark.parametrize(("name", "quality"), diagonal(["wax", "leaf", "ice"], ["fast", "good"]))
def test_a_preset_replaces_the_chain(talk: PageMessages, ring: Path, name: str, quality: str) -> None:
    edit(talk, "preset", preset=name, quality=quality, size_mm=30.0)
    assert not talk.messages()[0]["error"]
    material = load_material(str(ring))
    assert material.name == "jade_ring" and material.two_sided == (name == "leaf")
    assert talk.panes[0].picture.head["title"] == "Jade ring"


def test_the_scene_loses_what_the_chain_does_not_have(talk: PageMessages, ring: Path) -> None:
    scene = ring.with_name("scene.toml")
    text = scene.read_text(encoding="utf-8")
    scene.write_text(
        f"{text}\n[parameters]\n# dull\noctaves = [1.0, 1.0, 0.0, 0.0]\nsurface_roughness = 0.4\n", "utf-8"
    )
    talk.renew()
    edit(talk, "preset", preset="leaf", quality="fast")
    changed = scene.read_text(encoding="utf-8")
    assert "octaves" not in changed and "# dull" in changed and "surface_roughness = 0.4" in changed
    assert not talk.messages()[0]["error"]
    talk.answer({"kind": "undo"})
    assert "octaves = [1.0, 1.0, 0.0, 0.0]" in scene.read_text(encoding="utf-8")


def test_a_file_that_was_changed_since_stays(talk: PageMessages, ring: Path) -> None:
    edit(talk, "add", technique="sheen_constants")
    changed = ring.read_text(encoding="utf-8") + "# mine\n"
    ring.write_text(changed, encoding="utf-8")
    with pytest.raises(SssgenError, match="was changed since"):
        talk.answer({"kind": "undo"})
    assert ring.read_text(encoding="utf-8") == changed


def test_saved_values_are_taken_back_too(talk: PageMessages, ring: Path) -> None:
    before = ring.read_bytes()
    talk.answer({"kind": "save", "values": {"surfaceRoughness": [0.9]}})
    assert ring.read_bytes() != before
    talk.answer({"kind": "undo"})
    assert ring.read_bytes() == before


@pytest.mark.parametrize("more", [{"quality": "good", "size_mm": -3.0}, {"quality": "perfect"}, {"preset": "butter"}])
def test_faulty_settings_of_a_preset_change_nothing(talk: PageMessages, ring: Path, more: dict[str, object]) -> None:
    before = ring.read_bytes()
    with pytest.raises((SssgenError, ValueError)):
        edit(talk, "preset", **{"preset": "wax", "quality": "good", **more})
    assert ring.read_bytes() == before


def test_an_example_is_not_edited() -> None:
    with pytest.raises(SssgenError, match="comes with sssgen"):
        edit(PageMessages(Pane("jade_ring")), "add", technique="sheen_constants")


def test_the_menus_have_all_presets_and_media(talk: PageMessages) -> None:
    menus = talk.reply({"kind": "menus"})
    assert menus is not None
    rows = menus["presets"]["presets"]
    assert [row["name"] for row in rows] == list(presets()) and all(len(row["color"]) == 3 for row in rows)
    head, data = menus["presets"]["sheet"].split(",")
    pillow = pytest.importorskip("PIL.Image")
    width, height = pillow.open(BytesIO(base64.b64decode(data))).size
    assert head == "data:image/jpeg;base64" and width == height * len(rows)
    assert [row["name"] for row in menus["media"]] == list(media())


def test_a_medium_is_given_for_the_size_of_a_unit(talk: PageMessages) -> None:
    answer = talk.reply({"kind": "medium", "name": "marble", "unit_mm": 20.0})
    assert answer is not None and answer["parameters"] == preset("marble", 20.0).parameters
    with pytest.raises(SssgenError, match="did you mean 'marble'"):
        talk.reply({"kind": "medium", "name": "marbel", "unit_mm": 20.0})


def test_a_mesh_that_does_not_suit_is_said(talk: PageMessages, ring: Path) -> None:
    """The ring's material follows light through the body; one that is lit alone takes any mesh."""
    faces = ["1 3 2", "1 2 4", "1 4 3"]
    lines = [f"v {x} {y} {z}" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))]
    sheet = "\n".join([*lines, *(f"f {face}" for face in faces)])
    assert talk.messages()[0]["picture"]["warnings"] == []
    talk.answer({"kind": "mesh", "name": "open.obj"}, sheet.encode())
    (warning,) = talk.messages()[0]["picture"]["warnings"]
    assert "has holes (3 open edges)" in warning
    talk.answer({"kind": "save", "values": {"meanFreePath": [5.0]}})
    assert any("mean free paths thick" in warning for warning in talk.messages()[0]["picture"]["warnings"])
    edit(talk, "preset", preset="leaf", quality="fast")
    assert talk.messages()[0]["picture"]["warnings"] == []
