"""A logarithmic axis: where a value stands, and which values are written at it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from sssgen.lab.chart.record import LEAST

SHORTEST = 0.8
"""Decades that an axis has at least."""


class Scale(NamedTuple):
    """Maps values to places: the one with the logarithm `least` to `start`, `most` to `end`, in pixels."""

    least: float
    most: float
    start: float
    end: float
    bottom: float | None
    """Where values below LEAST are drawn, as a logarithm; None where there are none."""

    def at(self, value: float) -> float:
        """The place of a value."""
        log = self.bottom if value < LEAST and self.bottom is not None else math.log10(max(value, LEAST))
        return self.start + (log - self.least) / (self.most - self.least) * (self.end - self.start)

    def within(self, start: float, end: float) -> Scale:
        """The same values from another place to another place."""
        return self._replace(start=start, end=end)

    def ticks(self) -> list[tuple[float, str]]:
        """Places and what is written there."""
        decades = self.most - self.least
        steps = (1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)
        every = 1 if decades < 7.0 else 2 if decades < 14.0 else 4
        found = []
        for decade in range(math.floor(self.least), math.ceil(self.most) + 1):
            if decade % every:
                continue
            for step in steps:
                log = decade + math.log10(step)
                above = self.bottom is None or log > self.bottom + 0.3
                if self.least <= log <= self.most and above:
                    found.append((self.at(step * 10.0**decade), tick(step, decade)))
        if self.bottom is not None:
            found.append((self.at(0.0), f"<{tick(1.0, round(math.log10(LEAST)))}"))
        return found


def scale(values: Iterable[float], before: float, after: float) -> Scale:
    """A scale from 0 to 1 for values of 0 or more, with so much free before and after, as shares of their range."""
    given = list(values)
    logs = [math.log10(value) for value in given if value >= LEAST] or [0.0]
    bottom = min(logs) - 0.5 if any(value < LEAST for value in given) else None
    least, most = min(logs) if bottom is None else bottom, max(logs)
    if most - least < SHORTEST:
        middle = 0.5 * (least + most)
        least, most = middle - 0.5 * SHORTEST, middle + 0.5 * SHORTEST
    wide = most - least
    return Scale(least - before * wide, most + after * wide, 0.0, 1.0, bottom)


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def tick(step: float, decade: int) -> str:
    """How `step` × 10^`decade` is written at an axis."""
    if -3 <= decade <= 5:
        return f"{step * 10.0**decade:,.{max(0, -decade)}f}"
    power = "10" + str(decade).translate(_RAISED)
    return power if step == 1.0 else f"{step:g}·{power}"


def number(value: float | None) -> str:
    """A number with three digits, for people; – for none."""
    if value is None:
        return "–"
    return f"{value:,.0f}" if 1000.0 <= abs(value) < 1e7 else f"{value:.3g}"
