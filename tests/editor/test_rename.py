"""New names for parameters, functions and variables, in techniques, materials and scenes at once."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from sssgen.editor.open_documents import OpenDocuments
from sssgen.editor.rename import name_to_rename, rename
from sssgen.support import unsaved
from sssgen.support.diagnostics import SssgenError

SHARED = """uniform float gain : hint_range(0.0, 2.0), alias("loud") = 1.0; // gain of the lobe

float twice(float x)
{
    return 2.0 * x;
}
"""
OWN = """#include "shared.sss"

const float SHARP = 4.0;

float part(float x)
{
    float gained = x * gain;
    return gained * SHARP;
}

/**
 * A lobe with a gain.
 * role: translucency
 */
vec3 own(world_direction V, world_direction N)
{
    float x = dot(V, N);
    return vec3(part(x) * twice(x));
}
"""
MATERIAL = """# gain = 3.0
[material]
name = "mine"
title = "gain"

[translucency]
technique = "own.sss"
gain = 0.5 # the gain
"""
SCENE = 'material = "mine.toml"\n\n[geometry]\nkind = "ball"\n\n[parameters]\ngain = 0.25\n'
FILES = {"shared.sss": SHARED, "own.sss": OWN, "mine.toml": MATERIAL, "scene.toml": SCENE, "notes.toml": "gain = 1\n"}


class Folder:
    """Files on disk, of which some are open."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.documents = folder, OpenDocuments()
        for name, text in FILES.items():
            (folder / name).write_text(text, encoding="utf-8")

    def open(self, *names: str) -> None:
        for name in names:
            self.documents.change(str(self.folder / name), (self.folder / name).read_text("utf-8"))
            assert self.documents.problems(str(self.folder / name)) == []

    def renamed(self, file: str, piece: str, name: str) -> dict[str, str]:
        """The changed files after a new name for what a piece of a file begins with."""
        self.open(file)
        path = str(self.folder / file)
        text = (self.folder / file).read_text("utf-8")
        before = text[: text.index(piece)]
        found = self.documents.get(path)
        assert found is not None
        place = (*found, before.count("\n"), len(before) - before.rfind("\n") - 1)
        word = name_to_rename(*place)
        assert piece.startswith(word.text)
        edits = rename(place, name, self.documents.refresh, self.documents.paths)
        new = {}
        for changed, own in edits.items():
            lines = Path(changed).read_text("utf-8").split("\n")
            for part, replacement in sorted(own, reverse=True):
                line = lines[part.line]
                lines[part.line] = line[: part.column] + replacement + line[part.end_column :]
            new[Path(changed).name] = "\n".join(lines)
        return new


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Folder]:
    made = Folder(tmp_path)
    yield made
    for path in made.documents.paths:
        made.documents.close(path)
    assert not unsaved.any_kept()


@pytest.mark.parametrize("file", ["shared.sss", "own.sss", "mine.toml", "scene.toml"])
def test_a_parameter_is_renamed_wherever_it_is_used(folder: Folder, file: str) -> None:
    pieces = {"mine.toml": "gain = 0.5", "scene.toml": "gain = 0.25", "own.sss": "gain;"}
    new = folder.renamed(file, pieces.get(file, "gain"), "strength")
    assert new == {
        "shared.sss": SHARED.replace("float gain", "float strength"),
        "own.sss": OWN.replace("* gain;", "* strength;"),
        "mine.toml": MATERIAL.replace("gain = 0.5", "strength = 0.5"),
        "scene.toml": SCENE.replace("gain =", "strength ="),
    }


def test_functions_constants_parameters_and_variables(folder: Folder) -> None:
    assert folder.renamed("own.sss", "part(x)", "piece") == {"own.sss": OWN.replace("part(", "piece(")}
    assert folder.renamed("own.sss", "SHARP", "KEEN") == {"own.sss": OWN.replace("SHARP", "KEEN")}
    assert folder.renamed("own.sss", "gained *", "louder") == {"own.sss": OWN.replace("gained", "louder")}
    twice = folder.renamed("own.sss", "twice", "doubled")
    assert twice == {"own.sss": OWN.replace("twice", "doubled"), "shared.sss": SHARED.replace("twice", "doubled")}
    only_in_part = re.sub(r"\bx\b", "y", OWN[: OWN.index("/**")]) + OWN[OWN.index("/**") :]
    assert folder.renamed("own.sss", "x * gain", "y") == {"own.sss": only_in_part}


def test_the_formula_of_a_doc_comment_is_renamed(folder: Folder) -> None:
    text = SHARED + OWN.replace('#include "shared.sss"', "").replace(" */", " * formula: gain · x\n */")
    (folder.folder / "own.sss").write_text(text, encoding="utf-8")
    new = folder.renamed("own.sss", "gain :", "strength")["own.sss"]
    assert "formula: strength · x" in new and "with a gain." in new and "// gain of" in new


def test_unsaved_texts_are_renamed_too(folder: Folder) -> None:
    folder.open("own.sss")
    folder.documents.change(str(folder.folder / "own.sss"), OWN.replace("* gain;", "* gain + gain;"))
    folder.open("shared.sss")
    found = folder.documents.get(str(folder.folder / "shared.sss"))
    assert found is not None
    edits = rename((*found, 0, 14), "strength", folder.documents.refresh, folder.documents.paths)
    assert len(edits[str(folder.folder / "own.sss")]) == 2


def test_a_slot_and_what_is_bound_to_it(folder: Folder) -> None:
    (folder.folder / "own.sss").write_text(
        OWN.replace('"shared.sss"', '"shared.sss"\nfloat shape_of(float x);').replace("twice(x)", "shape_of(x)"),
        encoding="utf-8",
    )
    bound = MATERIAL + 'bind = { shape_of = "shared.sss:twice" }\n'
    (folder.folder / "mine.toml").write_text(bound, encoding="utf-8")
    assert folder.renamed("own.sss", "shape_of(x)", "form")["mine.toml"] == bound.replace("shape_of", "form")
    assert folder.renamed("shared.sss", "twice", "double_of")["mine.toml"] == bound.replace("twice", "double_of")


@pytest.mark.parametrize(
    ("file", "piece", "name", "message"),
    [
        ("own.sss", "own(", "other", "the technique of its file"),
        ("own.sss", "clamp", "other", "nothing here"),
        ("own.sss", "gain;", "part", "already has the name 'part'"),
        ("own.sss", "gain;", "x", "already has the name 'x'"),
        ("own.sss", "gain;", "if", "does not fit"),
        ("own.sss", "gain;", "two words", "not a name"),
        ("own.sss", "gained", "gain", "already has the name 'gain'"),
        ("own.sss", "V, world", "sideways", "a quantity of the chain"),
        ("mine.toml", "metalness", "iron", "in the library"),
        ("mine.toml", "loud = ", "noise", "another name of 'gain'"),
    ],
)
def test_refusals(folder: Folder, file: str, piece: str, name: str, message: str) -> None:
    if piece == "clamp":
        (folder.folder / file).write_text(OWN.replace("dot(V, N)", "clamp(V.x, 0.0, 1.0)"), encoding="utf-8")
    if piece == "metalness":
        stage = '[surface]\ntechnique = "pbr_constants"\nmetalness = 1.0\n'
        (folder.folder / file).write_text(MATERIAL[: MATERIAL.index("[trans")] + stage, encoding="utf-8")
    if piece.startswith("loud"):
        (folder.folder / file).write_text(MATERIAL.replace("gain = 0.5", "loud = 0.5"), encoding="utf-8")
    with pytest.raises(SssgenError, match=message):
        folder.renamed(file, piece, name)


def test_a_file_with_errors_is_named(folder: Folder) -> None:
    folder.open("shared.sss")
    (folder.folder / "own.sss").write_text(OWN.replace("return gained", "return gaind"), encoding="utf-8")
    with pytest.raises(SssgenError, match=r"own.sss has errors: correct them first|own.sss has errors"):
        folder.renamed("shared.sss", "gain", "strength")
