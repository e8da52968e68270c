"""A technique that is named alone: the smallest material that shows it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sssgen.ir.types import spell
from sssgen.lab.measure.technique_chain import chain_of, is_drawn, textures_of
from sssgen.material import library
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.preview.picture import Choices, picture_of
from sssgen.preview.technique_scene import scene_of_technique
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("PIL.Image")

OF_BODIES = ("coordinates", "surface", "thickness", "conversion", "translucency", "distance")


def test_what_a_technique_takes_stands_before_it() -> None:
    roles = [library.load(stage.technique).role for stage in chain_of(library.load("beer_lambert"))]
    assert roles[:2] == ["thickness", "conversion"] and roles[2] == "translucency"


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name, path in library.index().items() if library.folder_of(path) != "common"]
)
def test_each_technique_of_a_body_is_shown_and_the_others_say_why_not(name: str) -> None:
    technique = library.load(name)
    volume = any(spell(texture.type) != "sampler2D" and not is_drawn(texture) for texture in textures_of(technique))
    if technique.role in OF_BODIES and not volume:
        scene, material = scene_of_technique(technique.path)
        picture = picture_of(scene, material, Choices())
        stages = [stage.technique.name for stage in material.stages]
        assert technique.role == "distance" or name in stages
        assert picture.pieces[picture.head["body"]]
    else:
        with pytest.raises(SssgenError) as error:
            scene_of_technique(technique.path)
        reasons = ("no part of a body's material", "which no picture can be", "a scene's geometry cannot have")
        assert any(reason in str(error.value) for reason in reasons)


def test_a_file_is_shown_and_each_save_renews_it(tmp_path: Path) -> None:
    file = tmp_path / "glowing.sss"
    shutil.copy(library.index()["wrap_lighting"], file)
    text = file.read_text(encoding="utf-8").replace("wrap_lighting", "glowing")
    file.write_text(text, encoding="utf-8")
    talk = PageMessages(Pane(str(file)))
    (message,) = talk.messages()
    assert message["picture"]["name"] == "glowing" and str(file) in talk.files
    assert "glowing" in {control["technique"] for control in message["picture"]["controls"]}
    with pytest.raises(SssgenError, match="nothing can be saved"):
        talk.answer({"kind": "save", "values": {"wrap": [0.25]}})
    file.write_text(text.replace("max(facing, 0.0), 0.0)", "max(facing, 0.0), 0.1)"), encoding="utf-8")
    talk.renew()
    (after,) = talk.messages()
    assert not after["error"] and after["picture"]["module"] != message["picture"]["module"]
    file.write_text(text.replace("max(facing, 0.0), 0.0)", "missing, 0.0)"), encoding="utf-8")
    talk.renew()
    assert "glowing.sss:" in talk.messages()[0]["error"] and "missing" in talk.messages()[0]["error"]
