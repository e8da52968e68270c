"""Snapshots of every emitted file, and of docs/intrinsics.md: what changes shows in the diff of a review.

UPDATE_SNAPSHOTS=1 rewrites them.
"""

from __future__ import annotations

import os
import runpy

import pytest

import sssgen
from folders import DOCS, SNAPSHOTS
from sssgen.material.material_loading import examples

FOLDER = SNAPSHOTS / "emitted"
CASES = [
    (name, target, form) for name in examples() for target in sssgen.all_targets() for form in ("shader", "functions")
]


@pytest.mark.parametrize(("name", "target", "form"), CASES)
def test_emitted_files(name: str, target: str, form: str) -> None:
    for file, text in sssgen.compile(name, target, form).files.items():
        path = FOLDER / name / file
        if os.environ.get("UPDATE_SNAPSHOTS"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        assert path.is_file(), f"no snapshot of {file}: look at the text, then set UPDATE_SNAPSHOTS=1"
        assert text == path.read_text(encoding="utf-8"), f"{file} changed; UPDATE_SNAPSHOTS=1 takes it over"


def test_no_snapshot_is_left_over() -> None:
    expected = {
        FOLDER / name / file for name, target, form in CASES for file in sssgen.compile(name, target, form).files
    }
    assert {path for path in FOLDER.rglob("*") if path.is_file()} == expected


def test_the_page_of_builtins_is_current() -> None:
    made = runpy.run_path(str(DOCS / "intrinsics.py"))
    assert made["page"]() == (DOCS / "intrinsics.md").read_text(encoding="utf-8"), "run python docs/intrinsics.py"
