"""The errors of open files: their places, files that are named, half-written and hostile texts."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from folders import ROOT
from sssgen.editor.completion import completions_at
from sssgen.editor.definition import definition_at
from sssgen.editor.documents import GLSL, MATERIAL, OTHER, SCENE, TECHNIQUE, kind_of
from sssgen.editor.hover import hover_at
from sssgen.editor.lenses import lenses_of
from sssgen.editor.open_documents import OpenDocuments
from sssgen.editor.problems import Problem, fixes_of
from sssgen.editor.rename import rename
from sssgen.material.material_loading import examples
from sssgen.support.diagnostics import SssgenError

LOBE = """/**
 * A lobe.
 * role: translucency
 */
float lobe(world_direction N)
{
    return N.x;
}
"""
MATERIAL_TEXT = """[material]
name = "glass"

[[thickness]]
technique = "voronoi_thickness"
bevel = 0.3

[[thickness]]
technique = "beer_lambert"

[translucency]
technique = "lobe_normalized"
"""
SCENE_TEXT = """material = "ice"

[geometry]
kind = "ball"

[parameters]
erosion = 0.5
"""
PLAIN = """#version 330
out vec4 color;
void main()
{
    color = vec4(1.0);
}
"""


def problems(opened: Any) -> list[Problem]:
    return opened.documents.problems(opened.document.path)


def test_the_kind_of_a_file() -> None:
    assert kind_of("a/b.sss", "") == TECHNIQUE
    assert kind_of("b.GLSL", "") == GLSL
    assert kind_of("m.toml", MATERIAL_TEXT) == MATERIAL
    assert kind_of("s.toml", SCENE_TEXT) == SCENE
    assert kind_of("Cargo.toml", "[package]\nname = 'x'\n") == OTHER
    assert kind_of("pyproject.toml", MATERIAL_TEXT) == OTHER
    assert kind_of("m.toml", '[geometry]\ntechnique = "raymarch"\n') == MATERIAL
    assert kind_of("picture.png", "") == OTHER


def test_every_example_has_the_kind_that_it_is() -> None:
    for path in examples().values():
        assert kind_of(path, Path(path).read_text("utf-8")) == MATERIAL, path
    for scene in (ROOT / "examples").glob("*/scene*.toml"):
        assert kind_of(str(scene), scene.read_text("utf-8")) == SCENE, scene


@pytest.mark.parametrize(
    ("name", "right", "wrong", "line", "word"),
    [
        ("lobe.sss", LOBE, LOBE.replace("N.x", "M.x"), 6, "M"),
        ("lobe.sss", LOBE, LOBE.replace("translucency", "translucence"), 2, "role"),
        ("glass.toml", MATERIAL_TEXT, MATERIAL_TEXT.replace("bevel", "bevle"), 5, "bevle"),
        ("glass.toml", MATERIAL_TEXT, MATERIAL_TEXT.replace('"beer_lambert"', '"beer"'), 8, '"beer"'),
        ("scene.toml", SCENE_TEXT, SCENE_TEXT.replace("kind", "kidn"), 3, "kidn"),
        ("scene.toml", SCENE_TEXT, SCENE_TEXT.replace("erosion", "erotion"), 6, "erotion"),
        ("own.glsl", PLAIN, PLAIN.replace("vec4(1.0)", "vec4(one)"), 4, "one"),
    ],
)
def test_an_error_is_at_its_place_and_goes_when_it_is_mended(
    opened: Callable[..., Any], name: str, right: str, wrong: str, line: int, word: str
) -> None:
    found = problems(faulty := opened(name, wrong))
    at = next(problem for problem in found if problem.range.line == line)
    assert faulty.document.line(line)[at.range.column :].startswith(word)
    assert at.severity == "error" and at.range[:2] < at.range[2:]
    assert problems(opened(name, right)) == []


def test_an_error_of_an_included_file_is_at_the_include(opened: Callable[..., Any], tmp_path: Path) -> None:
    (tmp_path / "part.sss").write_text("float part(float x)\n{\n    return y;\n}\n", encoding="utf-8")
    including = opened("lobe.sss", f'#include "part.sss"\n{LOBE}')
    (problem,) = problems(including)
    assert (problem.range.line, problem.range.column) == (0, 10)
    assert problem.message.startswith("part.sss:3:12: ")
    assert (problem.related_path, problem.related_range.line) == (str(tmp_path / "part.sss"), 2)


def test_an_unsaved_file_changes_the_files_that_name_it(opened: Callable[..., Any]) -> None:
    opened("lobe.sss", LOBE)
    path = opened("lobe.sss", LOBE).document.path
    Path(path).write_text(LOBE, encoding="utf-8")
    material = opened("own.toml", '[material]\nname = "own"\n\n[translucency]\ntechnique = "lobe.sss"\n')
    assert problems(material) == []
    assert material.documents.depending_on(path) == [material.document.path]
    opened("lobe.sss", LOBE.replace("N.x", "M.x"))
    (problem,) = problems(material)
    assert problem.range.line == 4 and "lobe.sss:7" in problem.message


def test_a_hint_is_a_fix(opened: Callable[..., Any]) -> None:
    for name, text, after in (
        ("glass.toml", MATERIAL_TEXT.replace("bevel", "bevle"), "bevel"),
        ("glass.toml", MATERIAL_TEXT.replace("lobe_normalized", "lobe_normalised"), "lobe_normalized"),
        ("lobe.sss", LOBE.replace("return N.x", "return clmp(N.x, 0.0, 1.0)"), "clamp"),
    ):
        faulty = opened(name, text)
        (problem,) = problems(faulty)
        (fix,) = fixes_of(faulty.document, problem)
        lines = faulty.document.lines
        line = lines[fix.range.line]
        lines[fix.range.line] = line[: fix.range.column] + fix.text + line[fix.range.end_column :]
        assert fix.text == after
        assert problems(opened(name, "\n".join(lines))) == []


def test_half_written_and_hostile_texts_raise_nothing(opened: Callable[..., Any]) -> None:
    generator = random.Random(7)
    texts = {"lobe.sss": LOBE, "glass.toml": MATERIAL_TEXT, "scene.toml": SCENE_TEXT, "own.glsl": PLAIN}
    for name, text in texts.items():
        cut = [text[: generator.randrange(len(text))] for _ in range(12)]
        mixed = [
            text[: (at := generator.randrange(len(text)))] + generator.choice('"[{(\\\x00\ud800é😀') + text[at:]
            for _ in range(12)
        ]
        for part in (*cut, *mixed, "", "\x00", "((((" * 2000):
            shown = opened(name, part, right=text)
            for problem in problems(shown):
                assert problem.message and problem.range.line <= part.count("\n") + 1
            for line in generator.sample(range(part.count("\n") + 1), min(4, part.count("\n") + 1)):
                place = (*shown.place[:2], line, generator.randrange(12))
                hover_at(*place)
                definition_at(*place)
                completions_at(*place)
                with contextlib.suppress(SssgenError):
                    rename(place, "other", shown.documents.refresh, shown.documents.paths)
            with contextlib.suppress(SssgenError):
                lenses_of(*shown.place[:2])


def test_a_file_that_is_no_text_or_vanishes_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "lobe.sss"
    path.write_bytes(b"float \xff;")
    including = tmp_path / "own.sss"
    documents = OpenDocuments()
    documents.change(str(including), '#include "lobe.sss"\n')
    try:
        assert "not UTF-8" in documents.problems(str(including))[0].message
        path.unlink()
        assert "cannot find 'lobe.sss'" in documents.problems(str(including))[0].message
    finally:
        documents.close(str(including))
    assert documents.problems(str(including)) == []
