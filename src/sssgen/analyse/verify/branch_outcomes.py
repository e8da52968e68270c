"""Which outcomes of conditions and comparisons a run had, lane by lane.

A branch (`if`, `?:`, the condition of a loop) has two outcomes. A comparison has five: less, just less, equal, just
greater, greater. It is one of `<`, `==`, …, or it is inside a builtin with cases, such as `clamp` or `step`. Each
component of a vector counts by itself.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.nodes import Call, Expr, For, Global, If, Local, Module, Select, Span, While
from sssgen.ir.walk import all_expressions, statements, subexpressions
from sssgen.run.backends import Array

NEAR = 2.0**-22
"""Floats whose relative difference is at most this are next to one another."""

CASES = {
    "min": ((0, 1),), "max": ((0, 1),), "clamp": ((0, 1), (0, 2)), "saturate": ((0, 0.0), (0, 1.0)),
    "step": ((0, 1),), "smoothstep": ((2, 0), (2, 1)), "abs": ((0, 0.0),), "sign": ((0, 0.0),),
    "lessThan": ((0, 1),), "lessThanEqual": ((0, 1),), "greaterThan": ((0, 1),), "greaterThanEqual": ((0, 1),),
    "equal": ((0, 1),), "notEqual": ((0, 1),),
}  # fmt: skip
"""The comparisons inside builtins: positions of arguments, or a number."""

Site = tuple[int, int, int]
"""A comparison: the id of its node, which of the node's comparisons it is, and the component."""


class Branch(NamedTuple):
    """An outcome of a branch, in the text."""

    line: int
    outcome: str
    """`if`, `else`, `? yes`, `: no`, `loop body`, `loop end`."""
    key: tuple[int, bool]
    """The id of its node, and the value of the condition."""


class Outcomes:
    """The outcomes of one run."""

    def __init__(self, lanes: int) -> None:
        self.lanes = lanes
        self.branches: dict[tuple[int, bool], Array] = {}
        """The lanes that had each outcome."""
        self.cases: dict[tuple[Site, int], Array] = {}
        self.distances: dict[Site, Array] = {}
        """Left minus right of each comparison, where it is the smallest of a lane; NaN where it was not reached."""

    def part(self, lanes: slice) -> Outcomes:
        """The outcomes of some of the lanes."""
        part = Outcomes(len(range(*lanes.indices(self.lanes))))
        part.branches = {key: mask[lanes] for key, mask in self.branches.items()}
        part.cases = {key: mask[lanes] for key, mask in self.cases.items()}
        part.distances = {site: distance[lanes] for site, distance in self.distances.items()}
        return part

    def add(self, few: Outcomes, chosen: Array) -> None:
        """Adds the outcomes of a run of the chosen lanes, which are numbers."""

        def wide(values: Array, missing: Any) -> Array:
            result = np.full(self.lanes, missing, values.dtype)
            result[chosen] = values
            return result

        for key, mask in few.branches.items():
            self._add(self.branches, key, wide(mask, False))
        for case, mask in few.cases.items():
            self._add(self.cases, case, wide(mask, False))
        for site, distance in few.distances.items():
            self._add_distance(site, wide(distance, np.nan))

    def _add(self, masks: dict[Any, Array], key: Any, lanes: Array) -> None:
        seen = masks.get(key)
        masks[key] = lanes if seen is None else seen | lanes

    def _add_distance(self, site: Site, distance: Array) -> None:
        old = self.distances.get(site)
        if old is not None:
            distance = np.where(np.isnan(distance) | (np.abs(old) < np.abs(distance)), old, distance)
        self.distances[site] = distance

    def branch(self, node: object, condition: Array, active: Array) -> None:
        """A condition was evaluated in the active lanes."""
        for value in (True, False):
            self._add(self.branches, (id(node), value), active & (condition == value))

    def comparison(self, node: object, comparison: int, left: Array, right: Array | float, active: Array) -> None:
        """Two numbers were compared in the active lanes."""
        if isinstance(left, np.ndarray) and left.dtype.kind == "b":
            return
        with np.errstate(all="ignore"):
            a, b = np.broadcast_arrays(np.asarray(left, np.float64), np.asarray(right, np.float64))
            near = 1.0 if np.asarray(left).dtype.kind in "iu" else NEAR * np.maximum(np.abs(a), np.abs(b))
            difference = np.broadcast_to(a - b, (*a.shape[:-1], self.lanes)).reshape(-1, self.lanes)
            near = np.broadcast_to(near, (*a.shape[:-1], self.lanes)).reshape(-1, self.lanes)
        if len(difference) > 4:
            return
        for component, (values, close) in enumerate(zip(difference, near, strict=True)):
            site = (id(node), comparison, component)
            case = np.sign(values) * np.where(np.abs(values) <= close, 1.0, 2.0)
            for side in (-2.0, -1.0, 0.0, 1.0, 2.0):
                lanes = active & (case == side)
                if lanes.any():
                    self._add(self.cases, (site, int(side)), lanes)
            self._add_distance(site, np.where(active, values, np.nan))


def branches(module: Module, key: str) -> list[Branch]:
    """The branches of one function, without those whose condition is a constant."""
    function = next(function for function in module.functions if function.key == key)
    constants = {constant.name for constant in module.constants}
    outcomes: list[Branch] = []

    def add(node: object, condition: Expr | None, yes: str, no: str, span: Span) -> None:
        if condition is not None and not _constant(condition, constants):
            outcomes.extend(
                [Branch(span.line, outcome, (id(node), value)) for outcome, value in ((yes, True), (no, False))]
            )

    for stmt in statements(function.body or ()):
        if isinstance(stmt, If):
            add(stmt, stmt.condition, "if", "else", stmt.span)
        elif isinstance(stmt, For | While):
            add(stmt, stmt.condition, "loop body", "loop end", stmt.span)
    for part in all_expressions(function.body or ()):
        if isinstance(part, Select):
            add(part, part.condition, "? yes", ": no", part.span)
    return sorted(outcomes, key=lambda branch: branch.line)


def _constant(expr: Expr, constants: set[str]) -> bool:
    """Whether nothing in it varies."""
    return not any(
        isinstance(part, Local | Call) or (isinstance(part, Global) and part.name not in constants)
        for part in subexpressions(expr)
    )
