"""What the page gets for its panel of emitted text: the files, the source of each line, and these sources."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from sssgen.preview import pane
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.targets import registry

pytest.importorskip("igl")

MATERIAL = """[material]
name = "stone"
shading = "lit"
[[surface]]
technique = "base_color"
"""


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> PageMessages:
    folder = tmp_path_factory.mktemp("stone")
    path = folder / "stone.toml"
    text = MATERIAL + '[[surface]]\ntechnique = "pbr_constants"\n'
    path.write_text(text, encoding="utf-8")
    (folder / "secret.txt").write_text("secret", encoding="utf-8")
    return PageMessages(Pane(str(path)))


def asked(talk: PageMessages, **message: str) -> dict[str, Any]:
    reply = talk.reply(message)
    assert reply is not None
    json.dumps(reply)
    return reply


def test_each_line_leads_to_the_line_of_its_source(talk: PageMessages) -> None:
    reply = asked(talk, kind="text", target="", form="shader")
    assert (reply["target"], reply["error"]) == ("glsl-330", "") and reply["targets"] == list(registry.names())
    file = reply["files"][0]
    lines = file["text"].splitlines()
    number = 1 + next(index for index, line in enumerate(lines) if re.match(r"\w+ \w*base_color\(", line))
    name, line, _ = file["sources"][str(number)].rsplit(":", 2)
    source = asked(talk, kind="source", name=name)
    assert "base_color(" in source["text"].splitlines()[int(line) - 1]
    own = next(span for span in file["sources"].values() if "stone.toml" in span)
    name, line, _ = own.rsplit(":", 2)
    assert "technique = " in asked(talk, kind="source", name=name)["text"].splitlines()[int(line) - 1]


@pytest.mark.parametrize("form", ["shader", "functions"])
@pytest.mark.parametrize("target", ["numpy", "wgsl"])
def test_every_source_of_a_text_is_shown(talk: PageMessages, target: str, form: str) -> None:
    reply = asked(talk, kind="text", target=target, form=form)
    assert reply["files"] and reply["error"] == ""
    for name in {span.rsplit(":", 2)[0] for file in reply["files"] for span in file["sources"].values()}:
        source = asked(talk, kind="source", name=name)
        assert source["text"] or name.startswith("guards/"), name


def test_what_a_target_cannot_carry_is_the_answer(talk: PageMessages, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise failure("this target has no textures", "take another one")

    monkeypatch.setattr(pane, "compile", refused)
    reply = asked(talk, kind="text", target="wgsl", form="shader")
    assert "this target has no textures" in reply["error"] and not reply["files"]


@pytest.mark.parametrize(
    "message", [{"target": "x", "form": "shader"}, {"target": "wgsl", "form": "x"}, {"target": "wgsl"}]
)
def test_a_faulty_question(talk: PageMessages, message: dict[str, str]) -> None:
    with pytest.raises((ValueError, KeyError)):
        talk.reply({"kind": "text", **message})


def test_no_other_file_is_shown(talk: PageMessages) -> None:
    folder = Path(talk.panes[0].picture.material.file).parent
    for name in (str(folder / "secret.txt"), "/etc/passwd", "../../version.py", "secret.txt", "", "..", "common"):
        with pytest.raises(SssgenError, match="is not a file that this picture depends on"):
            talk.reply({"kind": "source", "name": name})


def test_a_guard_has_a_note(talk: PageMessages) -> None:
    assert "normalize" in asked(talk, kind="source", name="guards/safe_normalize")["note"]


def test_a_change_is_no_question(talk: PageMessages) -> None:
    assert talk.reply({"kind": "shape", "shape": "cube"}) is None
