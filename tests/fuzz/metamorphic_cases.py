"""Programs whose results are known, and how they run: many in one text, on every target.

Unlike the programs of `glsl_batches`, these have parameters and results of any type, and no interpreter of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any, NamedTuple

import numpy as np

from glsl_batches import LANES, Failure, Runner
from glsl_batches import TARGETS as TARGETS
from known_answers import HEAD, SWITCHES, KnownAnswer, KnownFloats
from sssgen.ir.types import BY_NAME, VEC4, Type, kind_of
from sssgen.run.backends import Array, Call

TOLERANCE = 1e-3
"""For floats, relative to the larger of their size and 1."""
FLOATS = 0.4
"""The share of floats among known answers."""
IVEC4 = BY_NAME["ivec4"]
SWITCH_VALUES = np.repeat(np.array([[0], [1], [2], [3]], np.int32), LANES, axis=1)
EXTREMES = (0, 1, -1, 2, 255, 65535, 65536, (1 << 24) + 1, 0x55555555, 2147483647, -2147483647, -2147483648)


class Entry(NamedTuple):
    """What `Runner` asks of a program."""

    entry: str
    has_state: bool = False
    smooth: bool = True


class KnownCase:
    """A program with the results that it must have."""

    def __init__(
        self, kind: str, text: str, entry: str, result: Type, arguments: Mapping[str, Array], expected: Array,
        valid: Array | None = None, origin: str = "",
    ) -> None:  # fmt: skip
        self.kind, self.text, self.program, self.result = kind, text, Entry(entry), result
        self.arguments = {**arguments, SWITCHES: SWITCH_VALUES}
        """By the name of the parameter or uniform, lanes last."""
        self.expected = expected
        """Lanes last."""
        self.valid = np.ones(LANES, bool) if valid is None else valid
        self.origin = origin
        """Which function it was made of."""
        self.steady: Callable[[], Array] | None = None
        """The lanes that rounding cannot move, by a longer search; None where no result is rounded."""

    def wrong_lanes(self, result: Array) -> list[int]:
        """The lanes whose result is not the expected one."""
        if result.shape != self.expected.shape:
            return [0]
        actual, expected = np.asarray(result, np.float64), np.asarray(self.expected, np.float64)
        largest = np.abs(expected).reshape(-1, LANES).max(axis=0)  # of a value, as `deviation.errors` measures
        limit = TOLERANCE * np.maximum(1.0, largest) if kind_of(self.result) == "float" else 0.0
        right = np.abs(actual - expected) <= limit
        return [int(lane) for lane in np.flatnonzero(~right.reshape(-1, LANES).all(axis=0) & self.valid)]

    def difference(self, result: Array, lane: int) -> str:
        """The result of a lane, and the expected one."""
        if result.shape != self.expected.shape:
            return f"a result of the shape {result.shape}, not {self.expected.shape}"
        values = {name: value[..., lane].tolist() for name, value in self.arguments.items() if name != SWITCHES}
        return f"lane {lane} {values}: {result[..., lane].tolist()}, expected {self.expected[..., lane].tolist()}"


def known_case(random: Random, number: int) -> KnownCase:
    """A program that returns its argument."""
    if random.random() < FLOATS:
        entry, text = KnownFloats(random, number).text()
        eighths = np.array([random.randrange(-512, 513) / 8.0 for _ in range(4 * LANES)]).reshape(4, LANES)
        return KnownCase("known answer", text, entry, VEC4, {"given": eighths}, eighths)
    entry, text = KnownAnswer(random, number).text()
    numbers = [random.choice(EXTREMES) if random.random() < 0.4 else random.getrandbits(32) for _ in range(4 * LANES)]
    given = (np.array(numbers, np.int64) & 0xFFFFFFFF).astype(np.uint32).view(np.int32).reshape(4, LANES)
    return KnownCase("known answer", text, entry, IVEC4, {"given": given}, given)


class MetamorphicRunner(Runner):
    """The back ends for such programs."""

    def __init__(self, targets: Sequence[str] = TARGETS) -> None:
        super().__init__(targets)
        self.head = HEAD

    def confirmed(self, cases: Sequence[KnownCase]) -> list[tuple[KnownCase, Failure]]:
        """The failures that are left where lanes that rounding moves are not compared."""
        failures = self.failures(cases)
        compared = [case for case, failure in failures if failure.message.startswith("lane ")]  # also those of tools
        doubtful = {case for case in compared if case.steady is not None}
        for case in doubtful:
            case.valid = case.valid & case.steady()
        left = [pair for pair in failures if pair[0] not in doubtful]
        return left + [pair for case in doubtful for pair in self.failures([case])]

    def call(self, case: Any, params: Sequence[Any], renames: dict[str, str]) -> Call:
        args = [case.arguments[param.name] for param in params]
        entry = case.program.entry
        return Call(renames.get(entry, entry), tuple([param.type for param in params]), case.result, tuple(args))
