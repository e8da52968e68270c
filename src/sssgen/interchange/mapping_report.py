"""What became of each element of a foreign material: mapped, approximated or left out."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

Outcome: TypeAlias = Literal["mapped", "approximated", "left out"]
OUTCOMES: tuple[Outcome, ...] = ("mapped", "approximated", "left out")
_LONGEST = 60
"""Characters of a value."""


class Row(NamedTuple):
    """One element of the source file."""

    element: str
    """Its path in the file, such as /materials/0/pbrMetallicRoughness/baseColorFactor"""
    value: str
    """Its value as text, shortened"""
    outcome: Outcome
    became: str
    """What it became in the material; for what is left out, the reason"""
    error: str = ""
    """The error of the approximation where it is known, with its measure"""


class Report:
    """The rows of a file's materials; the rows of one material can be asked for."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.rows: list[Row] = []

    def add_mapping(self, element: str, value: object, became: str) -> None:
        """Records an element whose meaning is kept."""
        self.rows.append(Row(element, short_text(value), "mapped", became))

    def add_approximation(self, element: str, value: object, became: str, error: str = "") -> None:
        """Records an element whose meaning changes a little."""
        self.rows.append(Row(element, short_text(value), "approximated", became, error))

    def add_omission(self, element: str, value: object, reason: str) -> None:
        """Records an element that has no effect on the material."""
        self.rows.append(Row(element, short_text(value), "left out", reason))

    def counts(self) -> dict[str, int]:
        """Outcome → number of rows, for all outcomes."""
        counted = Counter(row.outcome for row in self.rows)
        return {outcome: counted[outcome] for outcome in OUTCOMES}

    def summary(self) -> str:
        """The number of rows of each outcome, as text."""
        return ", ".join(f"{number} {outcome}" for outcome, number in self.counts().items())

    def as_json(self) -> dict[str, Any]:
        """The report for programs."""
        return {"source": self.source, "counts": self.counts(), "rows": [row._asdict() for row in self.rows]}

    def json_text(self) -> str:
        """The text of report.json."""
        return json.dumps(self.as_json(), indent=2, ensure_ascii=False) + "\n"

    def markdown(self) -> str:
        """The text of report.md: a table for each outcome."""
        lines = [f"# {self.source}", "", f"{self.summary()}."]
        for outcome in OUTCOMES:
            if rows := [row for row in self.rows if row.outcome == outcome]:
                lines += ["", f"## {outcome.capitalize()}", "", *_table(rows, outcome)]
        return "\n".join(lines) + "\n"


def _table(rows: Sequence[Row], outcome: Outcome) -> Iterable[str]:
    last = "Reason" if outcome == "left out" else "Became"
    heads = ["Element", "Value", last, *(["Error"] if outcome == "approximated" else [])]
    yield f"| {' | '.join(heads)} |"
    yield "|" + "---|" * len(heads)
    for row in rows:
        cells = [f"`{row.element}`", row.value, row.became, row.error][: len(heads)]
        yield f"| {' | '.join(cell.replace('|', chr(92) + '|').replace(chr(10), ' ') for cell in cells)} |"


def short_text(value: object) -> str:
    """A value as short text, in the words of JSON: numbers with 6 digits, `true`, `null`, `scale: 2, 2`."""
    if value is None or isinstance(value, bool | np.bool_):
        text = {None: "null", True: "true", False: "false"}[value if value is None else bool(value)]
    elif isinstance(value, float | np.floating):
        text = f"{value:.6g}"
    elif isinstance(value, Mapping):
        text = "; ".join(f"{key}: {short_text(part)}" for key, part in value.items())
    elif isinstance(value, list | tuple | np.ndarray):
        text = ", ".join(short_text(part) for part in value)
    else:
        text = str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
