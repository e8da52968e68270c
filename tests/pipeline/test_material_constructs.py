"""The effect of each construct of a material on every target: a file of tests/material_constructs tests a construct.

A file has two materials and, for every target and form, the lines that differ between their emitted texts.
UPDATE_SNAPSHOTS=1 updates these lines, for review. To add a construct, write a file with a sentence and two materials.
"""

from __future__ import annotations

import os
import re
from difflib import unified_diff
from pathlib import Path

import pytest

import sssgen
from folders import TESTS
from slow_cases import diagonal
from sssgen.support.diagnostics import UnsupportedError

CONSTRUCTS = sorted((TESTS / "material_constructs").glob("*.txt"))
FORMS = ("shader", "functions")


def emitted(source: str, folder: Path, target: str, form: str) -> tuple[list[str], bool]:
    """The lines of all texts that are emitted for a material and a target, or else the messages, and whether it was."""
    path = folder / "made.toml"
    path.write_text(f'[material]\nname = "made"\n{source}', encoding="utf-8")
    try:
        files = sssgen.compile(str(path), target, form).files
    except UnsupportedError as error:
        return [entry.message for entry in error.diagnostics], False
    # a sub-graph for Unity is JSON, in which every line differs: it has tests of its own; the last two are sources
    left_out = (".json", ".shadersubgraph", "sssgen_passes.gd", "sssgen-webgpu.js")
    shown = [text for file, text in files.items() if not file.endswith(left_out)]
    return [line for text in shown for line in text.splitlines()], True


def differences(before: str, after: str, folder: Path, target: str, form: str) -> str:
    """The lines for a target that only one of the two materials has."""
    (lines, _), (new, supported) = (emitted(source, folder, target, form) for source in (before, after))
    texts = (lines, new) if supported else ([], new)
    return "\n".join(line for line in list(unified_diff(*texts, lineterm="", n=0))[2:] if line[0] in "+-")


@pytest.mark.parametrize(("stem", "tested"), diagonal([path.stem for path in CONSTRUCTS], FORMS))
def test_construct(stem: str, tested: str, tmp_path: Path) -> None:
    path = TESTS / "material_constructs" / f"{stem}.txt"
    update = bool(os.environ.get("UPDATE_SNAPSHOTS"))
    head, *sections = re.split(r"^--- (.+)\n", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    rule, before, after = re.split(r"^=== (?:before|after)\n", head, flags=re.MULTILINE)
    assert rule.strip().endswith(".")
    results = {
        f"{target} {form}": differences(before, after, tmp_path, target, form)
        for target in sssgen.all_targets()
        for form in (FORMS if update else (tested,))
    }
    if update:
        text = head.rstrip() + "\n" + "".join(f"--- {name}\n{lines}\n" for name, lines in results.items())
        path.write_text(text, encoding="utf-8", newline="\n")
        return
    expected = dict(zip(sections[::2], (section.removesuffix("\n") for section in sections[1::2]), strict=True))
    form = {name: lines for name, lines in expected.items() if name.endswith(f" {tested}")}
    assert results == form, "UPDATE_SNAPSHOTS=1 stores the new lines"
