"""What rounding explains in each lane of a function: measured where a deviation asks, and kept for other back ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from sssgen.analyse.verify.rounding_noise import is_explained
from sssgen.analyse.verify.time_limit import TimeOverError
from sssgen.run.backends import Array

DRAWS_EACH = (4, 16, 128)
"""How many runs with errors a deviation is compared with; each further number for what those before do not explain."""
FIRST = 16
"""About how many lanes are decided first."""
FEW = 512
"""Lanes that take about as long as one."""

Measure = Callable[[Array, int, bool], Mapping[str, Array]]
"""The largest movement of each output in these lanes, in so many runs with errors; with True, in these the
comparisons that rounding decides have any outcome."""


class RoundingLimits:
    """The limits of each output, in all lanes."""

    def __init__(self, measure: Measure) -> None:
        self.measure = measure
        self.limits: dict[str, Array] = {}
        self.draws: Array = np.zeros(0, np.int64)
        """How many runs with errors each lane had; one more than all: both outcomes of its comparisons were tried."""

    def unexplained(self, deviations: Mapping[str, Array], lanes: Array) -> tuple[Array, Array]:
        """Of these lanes, those whose deviations rounding does not explain, and those that the time leaves undecided.

        The first few lanes are decided before the others start: they stand for all where the time ends.
        """
        if not self.limits:
            self.limits = {output: np.zeros(len(lanes)) for output in deviations}
            self.draws = np.zeros(len(lanes), np.int64)
        left = lanes & ~self.explains(deviations)
        undecided = np.zeros_like(left)
        numbers = np.flatnonzero(left)
        first = numbers[:: -(-len(numbers) // FIRST) or 1]
        for part in (first, np.setdiff1d(numbers, first)):
            try:
                self.measure_enough(deviations, part)
            except TimeOverError:
                undecided[part] = True
        left &= ~self.explains(deviations)
        return left & ~undecided, undecided & left

    def measure_enough(self, deviations: Mapping[str, Array], lanes: Array) -> None:
        """Runs these lanes with errors until their deviations are explained, or had all draws.

        Then the comparisons that rounding decides have any outcome. Raises TimeOverError.
        """
        for draws in DRAWS_EACH:
            pending = lanes[~self.explains(deviations)[lanes] & (self.draws[lanes] < draws)]
            if len(pending):
                count = min(max(draws, FEW // len(pending)), DRAWS_EACH[-1])
                self.add(pending, self.measure(pending, count, False))
                self.draws[pending] = count
        pending = lanes[~self.explains(deviations)[lanes] & (self.draws[lanes] <= DRAWS_EACH[-1])]
        if len(pending):
            self.add(pending, self.measure(pending, DRAWS_EACH[-1], True))
            self.draws[pending] = DRAWS_EACH[-1] + 1

    def add(self, lanes: Array, moved: Mapping[str, Array]) -> None:
        """The results of these lanes may move by so much."""
        for output, movement in moved.items():
            self.limits[output][lanes] = np.maximum(self.limits[output][lanes], movement)

    def explains(self, deviations: Mapping[str, Array]) -> Array:
        """Whether rounding explains the deviations of all outputs, in each lane."""
        each = [is_explained(error, self.limits[output]) for output, error in deviations.items()]
        explained: Array = np.all(each, axis=0)
        return explained
