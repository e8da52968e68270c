"""Parameters of which `make test` runs some, and `make test-long` the others."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import cycle
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


def diagonal(rows: Iterable[Any], columns: Iterable[Any]) -> list[Any]:
    """Pairs of a row and a column: each row with one column, which take turns, and the other pairs as slow cases.

    A tuple is the values of several parameters.
    Rows and columns may be cases of `pytest.param` with marks: those are slow in every pair.
    """
    rows, columns = [_case(row) for row in rows], [_case(column) for column in columns]
    turns = cycle([column for column in columns if not column.marks])
    pairs = []
    for row in rows:
        turn = None if row.marks else next(turns)
        for column in columns:
            marks = () if column is turn else (pytest.mark.slow, *row.marks, *column.marks)
            name = f"{row.id}-{column.id}" if row.id and column.id else None
            pairs.append(pytest.param(*row.values, *column.values, marks=marks, id=name))
    return pairs


def _case(value: Any) -> Any:
    """A case of `pytest.param`, with a name where its values are texts."""
    case = value if hasattr(value, "marks") else pytest.param(*(value if isinstance(value, tuple) else (value,)))
    named = case.id is not None or not all(isinstance(part, str) for part in case.values)
    return case if named else case._replace(id="-".join(case.values))


def back_end_cases(names: Iterable[str], *quick: str) -> list[Any]:
    """Back ends; all but the defaults, NumPy in float64 and `quick` are marked slow."""
    names = list(names)
    return some_slow(names, *(name for name in names if name in (*DEFAULT, "numpy", *quick)))
