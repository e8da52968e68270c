"""What stands beside a picture: another material, the same without guards, the material as it was at the start."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("igl")

MATERIAL = """[material]
name = "{name}"
shading = "lit"
[thickness]
technique = "constant_thickness"
[translucency]
technique = "absorption_tint"
[[surface]]
technique = "base_color"
tint = [0.25, 0.5, 0.75, 1.0]
"""


@pytest.fixture
def stone(tmp_path: Path) -> Path:
    (tmp_path / "stone.toml").write_text(MATERIAL.format(name="stone"), encoding="utf-8")
    (tmp_path / "slate.toml").write_text(MATERIAL.format(name="slate"), encoding="utf-8")
    return tmp_path / "stone.toml"


def tint(message: dict[str, Any]) -> list[float]:
    controls = message["picture"]["controls"]
    return next(control["value"] for control in controls if control["label"] == "tint")


def test_without_guards_is_the_same_material_with_another_text() -> None:
    talk = PageMessages(Pane("ice"))
    assert [message["panes"] for message in talk.messages()] == [1]
    talk.answer({"kind": "beside", "beside": "guards"})
    first, second = talk.messages()
    assert (first["pane"], second["pane"], first["panes"], first["beside"]) == (0, 1, 2, "guards")
    assert second["label"] == f"{first['label']}, without guards"
    assert first["picture"]["module"] != second["picture"]["module"]
    assert first["picture"]["controls"] == second["picture"]["controls"]
    talk.answer({"kind": "beside", "beside": ""})
    assert len(talk.messages()) == 1


def test_the_material_as_it_was_stays_while_the_file_changes(stone: Path) -> None:
    talk = PageMessages(Pane(str(stone)))
    stone.write_text(stone.read_text(encoding="utf-8").replace("0.25, 0.5", "0.5, 0.5"), encoding="utf-8")
    talk.renew()
    talk.answer({"kind": "beside", "beside": "start"})
    now, then = talk.messages()
    assert (tint(now)[0], tint(then)[0]) == (0.5, 0.25) and then["label"] == "Stone, at the start"
    stone.write_text(stone.read_text(encoding="utf-8").replace("0.5, 0.5", "0.75, 0.5"), encoding="utf-8")
    talk.renew()
    talk.answer({"kind": "shape", "shape": "cube"})
    now, then = talk.messages()
    assert (tint(now)[0], tint(then)[0]) == (0.75, 0.25)
    assert now["picture"]["body"] == then["picture"]["body"]
    with pytest.raises(SssgenError, match="nothing can be saved"):
        talk.answer({"kind": "save", "pane": 1, "values": {"tint": [1.0, 1.0, 1.0, 1.0]}})


def test_a_second_material_has_its_own_controls_and_files(stone: Path) -> None:
    other = stone.with_name("slate.toml")
    talk = PageMessages(Pane(str(stone)), Pane(str(other)))
    assert [message["label"] for message in talk.messages()] == ["Stone", "Slate"]
    assert {str(stone), str(other)} <= talk.files.keys()
    talk.answer({"kind": "save", "pane": 1, "values": {"tint": [1.0, 0.5, 0.75, 1.0]}})
    assert [tint(message)[0] for message in talk.messages()] == [0.25, 1.0]
    assert "0.25" in stone.read_text(encoding="utf-8") and "0.25" not in other.read_text(encoding="utf-8")
    talk.answer({"kind": "beside", "beside": ""})
    talk.answer({"kind": "beside", "beside": "other"})
    assert [message["label"] for message in talk.messages()] == ["Stone", "Slate"]


@pytest.mark.parametrize("message", [{"kind": "beside", "beside": "other"}, {"kind": "beside", "beside": "x"},
                                     {"kind": "save", "pane": 1, "values": {}}])  # fmt: skip
def test_what_is_not_there_is_a_faulty_message(stone: Path, message: dict[str, Any]) -> None:
    with pytest.raises((ValueError, KeyError)):
        PageMessages(Pane(str(stone))).answer(message)
