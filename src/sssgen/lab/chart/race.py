"""The rule of a race: which chains could still be the answer, and are measured next.

Chains are measured with few samples of the reference first. A chain drops out as soon as its error bar is outside of
the limit, or as soon as a chain that costs less is surely within it; the others are measured with more samples. The
answer is the one of `picking.choose` after the last level.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple


class Entrant(NamedTuple):
    """A chain in the race."""

    cost: float
    level: int = 0
    """How many times it was measured, each time with more samples; 0: not yet"""
    low: float = 0.0
    """The lower end of its error bar: of the worst view"""
    high: float = math.inf
    """The upper end of its error bar: of the worst view"""


def within_error(entrants: Sequence[Entrant], limit: float, last: int) -> list[int]:
    """The entrants to measure next for the cheapest one within `limit`, the cheapest first; empty when it is decided.

    An entrant is inside when its bar ends within the limit, and outside when its bar begins beyond it. After the `last`
    level those between them are outside, too. Those that cost more than the cheapest one inside are not measured.
    """
    pending: list[int] = []
    for number in sorted(range(len(entrants)), key=lambda number: entrants[number].cost):
        entrant = entrants[number]
        inside = entrant.high <= limit
        if entrant.level < last and entrant.low <= limit:
            pending.append(number)
        if inside:
            break
    return _lowest(entrants, pending)


def within_cost(entrants: Sequence[Entrant], limit: float, last: int) -> list[int]:
    """The entrants to measure next for the most accurate one of at most the cost `limit`, the cheapest first.

    An entrant drops out when its bar begins above the end of another one's.
    """
    allowed = [number for number, entrant in enumerate(entrants) if entrant.cost <= limit]
    least = min((entrants[number].high for number in allowed), default=math.inf)
    pending = [number for number in allowed if entrants[number].level < last and entrants[number].low <= least]
    return _lowest(entrants, sorted(pending, key=lambda number: entrants[number].cost))


def within_budget(entrants: Sequence[Entrant], max_cost: float, max_error: float, last: int) -> list[int]:
    """The entrants to measure next for the cheapest one within `max_error`, of those of at most the cost `max_cost`;
    where none of these is, for the most accurate one."""
    allowed = [number for number, entrant in enumerate(entrants) if entrant.cost <= max_cost]
    cheap = [entrants[number] for number in allowed]
    pending = within_error(cheap, max_error, last)
    if not pending and all(entrant.high > max_error for entrant in cheap):
        pending = within_cost(cheap, max_cost, last)
    return [allowed[number] for number in pending]


def _lowest(entrants: Sequence[Entrant], pending: Sequence[int]) -> list[int]:
    """Those of the lowest level: samples grow together."""
    level = min((entrants[number].level for number in pending), default=0)
    return [number for number in pending if entrants[number].level == level]
