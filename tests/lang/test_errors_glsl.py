"""The errors of plain GLSL and of its preprocessor: their messages and places."""

from __future__ import annotations

import pytest

from folders import SNAPSHOTS
from glsl_errors import CASES, FILE, LONG, errors_of
from snapshot import check_snapshot


@pytest.mark.parametrize("name", CASES)
def test_error_text(name: str) -> None:
    error = errors_of(CASES[name])
    check_snapshot(f"errors_glsl/{name}.txt", f"{error}\n")
    for diagnostic in error.diagnostics:
        assert diagnostic.span.file == FILE
        assert 1 <= diagnostic.span.line <= CASES[name].count("\n") + 1


@pytest.mark.parametrize("message", LONG)
def test_too_long_programs_are_refused(message: str) -> None:
    error = errors_of(LONG[message])
    assert message in error.diagnostics[0].message
    assert error.diagnostics[0].span.file == FILE


def test_snapshots_have_cases() -> None:
    assert {path.stem for path in (SNAPSHOTS / "errors_glsl").glob("*.txt")} == set(CASES)
