"""The time that `--verify` has: for the whole file, for each function, and for the parts of its work.

The interpreter asks at each round of a loop and each call whether the time is over. What is left undone is reported.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf

EACH = 60.0
"""The seconds of one function, if no others are given."""
TOTAL = 300.0
"""The seconds of a file, if no others are given."""


class TimeOverError(Exception):
    """The time of the current part is over."""


class TimeLimit:
    """Without numbers, no limit. `clock` returns seconds."""

    def __init__(self, total: float = inf, each: float = inf, clock: Callable[[], float] = time.monotonic) -> None:
        self.total, self.each, self.clock = total, each, clock
        self.start()

    def start(self) -> None:
        """The time of the file begins."""
        self.end = self.clock() + self.total
        self.start_function()

    def start_function(self) -> None:
        """The time of the next function begins."""
        self.function_start = self.clock()
        self.function_end = self.part_end = min(self.function_start + self.each, self.end)

    @contextmanager
    def until(self, share: float) -> Iterator[None]:
        """What is inside ends when this share of the function's time is over."""
        if self.function_end < inf:
            self.part_end = self.function_start + share * (self.function_end - self.function_start)
        try:
            yield
        finally:
            self.part_end = self.function_end

    @property
    def left(self) -> float:
        """The seconds of the function that are left."""
        return self.function_end - self.clock()

    @property
    def over(self) -> bool:
        """Whether the time of the file is over."""
        return self.clock() >= self.end

    def check(self) -> None:
        """Raises TimeOverError where the time of the current part is over."""
        if self.part_end < inf and self.clock() >= self.part_end:
            raise TimeOverError
