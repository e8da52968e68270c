"""Arithmetic of ranges against members: float32 results of members are in the range of the result."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sssgen.ir import intervals
from sssgen.ir.formats import FLOAT16, FLOAT32, Format
from sssgen.ir.intervals import INF, Range

ROUNDS, MEMBERS = 400, 24
ENDS = (0.0, 1.0, -1.0, 0.5, 2.0, 3.0, 1e-30, 1e-3, 1e6, 1e30, 0.1, 255.0, -1e-30, -0.1, -7.5, -1e6, -1e30)


def a_range(rng: np.random.Generator, small: bool = False) -> Range:
    """A range whose ends are numbers of float32, some of them points, some with a gap around 0."""
    chosen = [float(np.float32(rng.choice(ENDS) if rng.random() < 0.6 else rng.normal() * 3.0)) for _ in range(2)]
    if small:
        chosen = [float(np.float32(math.remainder(end, 50.0))) for end in chosen]
    low, high = min(chosen), max(chosen)
    if rng.random() < 0.15:
        high = low
    gap = 0.0
    if low < 0.0 < high and rng.random() < 0.4:
        gap = float(np.float32(rng.choice([1e-3, 0.5, 1e-30]) * max(-low, high)))
    return Range(low, high, gap)


def members(rng: np.random.Generator, x: Range) -> Any:
    """Numbers of float32 in a range: its ends, the edges of its gap, 0, and others."""
    drawn = [x.low, x.high, x.gap, -x.gap, 0.0, 1.0, -1.0, *(x.low + (x.high - x.low) * rng.random(MEMBERS))]
    drawn += list(np.sign(rng.normal(size=8)) * 10.0 ** rng.uniform(-30.0, 5.0, 8))
    result = np.array(drawn, np.float32)
    return result[(result >= x.low) & (result <= x.high) & (np.abs(result) >= x.gap)]


def assert_holds(result: Range, values: Any, message: object) -> None:
    """Every value is in the range, whose ends are in order."""
    assert result.low <= result.high and result.gap >= 0.0, (message, result)
    values = np.asarray(values, np.float64)
    inside = (values >= result.low) & (values <= result.high) & (np.abs(values) >= result.gap)
    assert inside.all(), (message, result, values[~inside][:3])


F32 = np.float32
ONE: dict[str, tuple[Callable[[Range], Range], Callable[[Any], Any]]] = {
    "neg": (lambda x: -x, lambda x: -x),
    "square": (intervals.square, lambda x: x * x),
    "absolute": (intervals.absolute, np.abs),
    "signs": (intervals.signs, np.sign),
    "fraction": (intervals.fraction, lambda x: x - np.floor(x)),
    "floor": (lambda x: intervals.rising(math.floor, x), np.floor),
    "ceil": (lambda x: intervals.rising(math.ceil, x), np.ceil),
    "trunc": (lambda x: intervals.rising(math.trunc, x), np.trunc),
    "round": (lambda x: intervals.rising(round, x), np.rint),
    "falling": (lambda x: intervals.falling(lambda v: -v, x), lambda x: -x),
}
TWO: dict[str, tuple[Callable[[Range, Range], Range], Callable[[Any, Any], Any]]] = {
    "+": (lambda x, y: x + y, lambda x, y: x + y),
    "-": (lambda x, y: x - y, lambda x, y: x - y),
    "*": (lambda x, y: x * y, lambda x, y: x * y),
    "minimum": (intervals.minimum, np.minimum),
    "maximum": (intervals.maximum, np.maximum),
}


def rounded(result: Range, format: Format = FLOAT32) -> Range:
    return intervals.rounded(result, format)


@pytest.mark.parametrize("name", ONE)
def test_intervals_of_functions_of_one_argument(name: str) -> None:
    rng = np.random.default_rng(1)
    over, of = ONE[name]
    for _ in range(ROUNDS):
        x = a_range(rng)
        with np.errstate(all="ignore"):
            assert_holds(rounded(over(x)), of(members(rng, x)), (name, x))


@pytest.mark.parametrize("name", TWO)
def test_intervals_of_functions_of_two_arguments(name: str) -> None:
    rng = np.random.default_rng(2)
    over, of = TWO[name]
    for _ in range(ROUNDS):
        x, y = a_range(rng), a_range(rng)
        with np.errstate(all="ignore"):
            values = of(members(rng, x)[:, None], members(rng, y))
        assert values.dtype == np.float32
        assert_holds(rounded(over(x, y)), values, (name, x, y))


def test_quotients() -> None:
    """Where the divisor is not 0; its error is widened, as nowhere is a division rounded correctly."""
    rng = np.random.default_rng(3)
    apart = 0
    for _ in range(ROUNDS):
        x, y = a_range(rng), a_range(rng)
        if y.has_zero():
            assert (x / y).low == -INF
            continue
        apart += 1
        with np.errstate(over="ignore"):
            values = members(rng, x)[:, None] / members(rng, y)
        assert_holds(rounded(intervals.widened(x / y, 3.0 * FLOAT32.epsilon)), values, (x, y))
    assert apart > ROUNDS / 4


def test_intervals_of_clip() -> None:
    rng = np.random.default_rng(4)
    for _ in range(ROUNDS):
        x, y, z = (a_range(rng) for _ in range(3))
        values = np.minimum(np.maximum(members(rng, x)[:, None, None], members(rng, y)[:, None]), members(rng, z))
        assert_holds(intervals.clip(x, y, z), values, (x, y, z))


def test_power() -> None:
    rng = np.random.default_rng(5)
    for _ in range(ROUNDS):
        x, y = intervals.maximum(a_range(rng, small=True), 2.0**-10), a_range(rng, small=True)
        with np.errstate(over="ignore"):
            values = members(rng, x).astype(np.float64)[:, None] ** members(rng, y)
        assert_holds(intervals.widened(intervals.power(x, y), 1e-12), values, (x, y))
    assert intervals.power(Range(0.0, 1.0), Range(-1.0, 2.0)) == Range(0.0, INF)


def test_blends_between_numbers() -> None:
    rng = np.random.default_rng(6)
    for _ in range(ROUNDS):
        x, y, t = (a_range(rng, small=True) for _ in range(3))
        a, b, c = (members(rng, one).astype(np.float64) for one in (x, y, t))
        values = a[:, None, None] * (1.0 - c) + b[:, None] * c
        assert_holds(intervals.widened(intervals.blend(x, y, t), 1e-12, 1e-9), values, (x, y, t))


def test_remainders() -> None:
    """Of numbers whose quotient is exact; for the others the builtins' own test is there."""
    rng = np.random.default_rng(7)
    for _ in range(ROUNDS):
        y = Range(*sorted(float(size) for size in 2.0 ** rng.integers(-3, 4, 2)))
        y = -y if rng.random() < 0.5 else y
        x = a_range(rng, small=True)
        powers = 2.0 ** np.arange(-3, 4) * (-1.0 if y.high < 0.0 else 1.0)
        by = powers[(powers >= y.low) & (powers <= y.high)].astype(np.float32)
        a = members(rng, x)[:, None]
        assert_holds(intervals.remainder(x, y), a - by * np.floor(a / by), (x, y))
        assert_holds(intervals.truncated(x, y), a - by * np.trunc(a / by), (x, y))


def test_joined_and_met() -> None:
    rng = np.random.default_rng(8)
    for _ in range(ROUNDS):
        x, y = a_range(rng), a_range(rng)
        a, b = members(rng, x), members(rng, y)
        joined, met = x.joined(y), x.met(y)
        assert_holds(joined, np.concatenate([a, b]), (x, y))
        assert x.within(joined) and y.within(joined) and joined == y.joined(x)
        both = np.concatenate([a, b]).astype(np.float64)
        both = both[(both >= x.low) & (both <= x.high) & (np.abs(both) >= x.gap)]
        assert_holds(met, both[(both >= y.low) & (both <= y.high) & (np.abs(both) >= y.gap)], (x, y))


def test_a_range_is_never_inside_out() -> None:
    """Not even an empty one, as after a condition that cannot hold."""
    for low, high, gap in ((0.0, 0.0, 1.0), (-0.5, 0.25, 1.0), (-2.0, 0.5, 1.0), (-0.5, 2.0, 1.0), (-0.5, 0.0, 1.0)):
        result = Range(low, high, gap)
        assert result.low <= result.high and not result.has_zero()
    assert Range(3.0, 4.0).met(Range(0.0, 1.0)).low <= 4.0


@pytest.mark.parametrize("format", [FLOAT32, FLOAT16], ids=["float", "half"])
def test_rounding(format: Format) -> None:
    """A rounded range has the rounded and the exact numbers; what GPUs may flush to 0 does not keep 0 away."""
    rng = np.random.default_rng(9)
    dtype = np.float32 if format is FLOAT32 else np.float16
    for _ in range(ROUNDS):
        low, high = sorted(float(end) for end in rng.normal(size=2) * 10.0 ** rng.uniform(-3.0, 3.0))
        drawn = low + (high - low) * rng.random(MEMBERS)
        result = intervals.rounded(Range(low, high), format)
        assert_holds(result, np.concatenate([drawn, drawn.astype(dtype)]), (low, high))
    assert intervals.rounded(Range(format.tiny * 0.5, 1.0), format).has_zero()
    assert not intervals.rounded(Range(format.tiny, 1.0), format).has_zero()
    assert intervals.rounded(Range(1.0, 2.0 * format.largest), format).high == INF


def test_widening() -> None:
    wide = intervals.widened(Range(1.0, 2.0), 0.5, 0.25)
    assert (wide.low, wide.high, wide.gap) == (0.25, 3.25, 0.25)
    assert intervals.widened(Range(0.0, 1.0), 0.1).low == 0.0, "0 stays 0 without an absolute error"
    assert intervals.widened(Range(0.1, 1.0), 0.0, 0.2).low < 0.0, "with one the sign may go"
    assert intervals.widened(intervals.ANY, 0.0) == intervals.ANY and intervals.widened(intervals.ANY, 0.1).high == INF


def test_functions_that_overflow() -> None:
    assert intervals.rising(math.sinh, Range(-1e4, 1e4)) == intervals.ANY
    assert intervals.rising(math.exp, Range(-1e4, 1e4)) == Range(0.0, INF)
    assert intervals.rising(math.log, Range(0.0, 1.0)) == Range(-INF, 0.0)
    assert intervals.rising(math.floor, intervals.ANY) == intervals.ANY
