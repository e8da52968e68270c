"""Snapshots of a complete material for every target; docs/intrinsics.md is current.

UPDATE_SNAPSHOTS=1 writes the snapshots. test_material_constructs.py tests the other constructs of materials, and
benchmarks/replay.py compares every example and every technique with another state of the project.
"""

from __future__ import annotations

import runpy

import pytest

import sssgen
from folders import DOCS, SNAPSHOTS
from snapshot import check_snapshot

MATERIAL = "ice"
"""It has a mask, textures of several kinds, thickness and all inputs of a lit shell."""
FOLDER = SNAPSHOTS / "emitted" / MATERIAL
CASES = [(target, form) for target in sssgen.all_targets() for form in ("shader", "functions")]


def emitted(target: str, form: str) -> dict[str, str]:
    """The material's own files, without the runtime of engines, whose sources are files themselves."""
    files = sssgen.compile(MATERIAL, target, form).files
    return {file: text for file, text in files.items() if not file.startswith(("sssgen-", "sssgen_"))}


@pytest.mark.parametrize(("target", "form"), CASES)
def test_emitted_files(target: str, form: str) -> None:
    for file, text in emitted(target, form).items():
        check_snapshot(f"emitted/{MATERIAL}/{file}", text)


def test_every_snapshot_has_an_emitted_file() -> None:
    expected = {FOLDER / file for target, form in CASES for file in emitted(target, form)}
    assert {path for path in FOLDER.rglob("*") if path.is_file()} == expected


def test_the_page_of_builtins_is_current() -> None:
    result = runpy.run_path(str(DOCS / "intrinsics.py"))
    assert result["page"]() == (DOCS / "intrinsics.md").read_text(encoding="utf-8"), "run python docs/intrinsics.py"
