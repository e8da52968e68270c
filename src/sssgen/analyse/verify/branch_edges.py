"""Comparisons that rounding decides: lanes in which a branch may go either way, although no run with errors shows it.

Where two terms cancel exactly in a driver, as in `z * c + sqrt(k)` of a large number, its result lies on one side of a
comparison, and float64 and all random errors may lie on the other. So the operands of each comparison are measured as
results are: a comparison whose operands differ by at most `MARGIN` times their largest movement may have any outcome,
and further runs take both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes, Site
from sssgen.analyse.verify.rounded_floats import with_error
from sssgen.run.backends import Array
from sssgen.run.evaluate.deviation import MARGIN

Value = Any
JUMPS = frozenset({"step", "sign", "lessThan", "lessThanEqual", "greaterThan", "greaterThanEqual", "equal", "notEqual"})
"""The builtins with cases (`CASES`) whose result jumps where its arguments are equal."""


def branch_distance(name: str, args: Sequence[Value]) -> Value | None:
    """The number whose sign a builtin branches on, where that is none of its arguments."""
    if name == "refract":
        cosine = (args[1] * args[0]).sum(axis=0) if np.ndim(args[0]) > 1 else args[1] * args[0]
        return 1.0 - args[2] * args[2] * (1.0 - cosine * cosine)
    if name == "faceforward":
        return (args[2] * args[1]).sum(axis=0) if np.ndim(args[1]) > 1 else args[2] * args[1]
    return None


def on_side(name: str, args: Sequence[Value], distance: Value) -> Value:
    """The result of such a builtin where the number is this one."""
    if name == "faceforward":
        return np.where(distance < 0.0, args[0], -args[0])
    cosine = (args[1] * args[0]).sum(axis=0) if np.ndim(args[0]) > 1 else args[1] * args[0]
    bent = args[2] * args[0] - (args[2] * cosine + np.sqrt(np.maximum(distance, 0.0))) * args[1]
    return np.where(distance < 0.0, 0.0, bent)


class Edges:
    """How far the operands of each comparison may be from where they are."""

    def __init__(self, limits: Mapping[Site, Array]) -> None:
        self.limits = limits
        """Left minus right of a comparison may be another number by so much, in each lane."""

    def of_lanes(self, chosen: Array) -> Edges:
        """The same of these lanes, which are numbers."""
        return Edges({site: limit[chosen] for site, limit in self.limits.items()})

    def moved(self, node: object, comparison: int, distance: Value) -> Value:
        """Left minus right of a comparison with a random error."""
        shape = np.shape(distance)
        count = int(np.prod(shape[:-1], dtype=int))
        limits = [self.limits.get((id(node), comparison, component)) for component in range(count)]
        lanes = max([len(limit) for limit in limits if limit is not None], default=0)
        if not lanes:
            return distance
        limit = np.stack([np.zeros(lanes) if limit is None else limit for limit in limits]).reshape(*shape[:-1], lanes)
        wide = np.broadcast_to(distance, limit.shape)
        return np.where(limit > 0.0, with_error(wide, 0.0, limit), wide)


def edges_of(exact: Outcomes, rounded: Sequence[Outcomes]) -> Edges | None:
    """The comparisons of an exact run that rounding decides in some lane; None where there are none."""
    limits: dict[Site, Array] = {}
    for site, distance in exact.distances.items():
        moved = np.zeros(exact.lanes)
        for outcomes in rounded:
            other = outcomes.distances.get(site)
            if other is not None:
                moved = np.fmax(moved, np.abs(other - distance))
        near = (np.abs(distance) <= MARGIN * moved) & (moved > 0.0)
        if near.any():
            limits[site] = np.where(near, MARGIN * moved, 0.0)
    return Edges(limits) if limits else None
