"""docs/scripts.md: the keys of the JSON of every command."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from documents import is_part, read
from folders import ROOT
from sssgen.cli.commands import COMMANDS
from sssgen.cli.main import main

PAGE = ROOT / "docs" / "scripts.md"
ROWS = dict(re.findall(r"^\| `sssgen ([^`]+)` \| (.+) \|$", read(PAGE), re.MULTILINE))
"""The command line without `sssgen` → the cell of its keys."""
SLOW = ("chart", "pick", "fit", "stress", "bake", "ci")
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def _row(line: str) -> object:
    return pytest.param(line, marks=[pytest.mark.slow] if line.partition(" ")[0] in SLOW else [], id=line)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the command lines of the page read."""
    folder = tmp_path_factory.mktemp("scripts")
    (folder / "mesh.obj").write_text(TETRAHEDRON, encoding="utf-8")
    (folder / "mine.glsl").write_text("float half_of(float x) { return 0.5 / max(x, 1.0); }\n", encoding="utf-8")
    shutil.copytree(ROOT / "examples" / "ci", folder / "project")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert main(["emit", "ice", "--target", "wgsl", "-o", "out"]) == 0
        assert main(["new", "wood"]) == 0
        assert main(["export-gltf", "ice", "-o", "ice.glb"]) == 0
        (folder / "wood.toml").rename("kept.toml")
    return folder


def test_every_command_has_its_keys() -> None:
    assert {line.partition(" ")[0] for line in ROWS} == set(COMMANDS)


@pytest.mark.parametrize("line", [_row(line) for line, cell in ROWS.items() if cell.startswith("`")])
def test_a_command_prints_these_keys(
    line: str,
    folder: Path,
    compiler: Callable[[str], Any],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if line.startswith("render") or "--verify" in line:
        compiler("gl")
    monkeypatch.chdir(folder)
    if line.startswith("fmt"):
        shutil.copyfile("kept.toml", "wood.toml")
    main([*shlex.split(line), "--json"])
    printed = json.loads(capsys.readouterr().out)
    always, _, _ = ROWS[line].partition(";")
    expected = ["ok", *re.findall(r"`(\w+)`", always.partition(", then")[0])]
    assert printed["ok"] is True
    assert list(printed)[: len(expected)] == expected
    assert ", then" in always or len(printed) == len(expected), list(printed)


@pytest.mark.parametrize(
    ("shown", "printed", "agrees"),
    [
        ({"a": 1}, {"a": 1, "b": 2}, True),
        ({"a": 1}, {"b": 1}, False),
        ([1], [1, 2], True),
        ([1, 2], [1], False),
        ("NumPy …", "NumPy 2", True),
        ("NumPy …", "numpy", False),
        ({"a": [{"b": True}]}, {"a": [{"b": False}]}, False),
    ],
)
def test_a_part_of_json(shown: object, printed: object, agrees: bool) -> None:
    assert is_part(shown, printed) == agrees
