"""Parameters of which `make test` runs some, and `make test-long` the others."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from sssgen.run.backends import DEFAULT


def some_slow(cases: Iterable[Any], *quick: Any) -> list[Any]:
    """The cases; all but the quick ones are marked slow. A tuple is the values of several parameters."""
    cases = list(cases)
    assert set(quick) <= set(cases)
    return [
        case if case in quick else pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow)
        for case in cases
    ]


def back_end_cases(names: Iterable[str], *quick: str) -> list[Any]:
    """Back ends; all but the defaults, NumPy in float64 and `quick` are marked slow."""
    names = list(names)
    return some_slow(names, *(name for name in names if name in (*DEFAULT, "numpy", *quick)))
