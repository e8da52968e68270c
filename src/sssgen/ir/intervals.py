"""Interval arithmetic: the possible values of numbers.

A range contains every value that a float32 (or float16) computation may give. In every language sums, differences and
products round to nearest; rounding is monotone, so it suffices to round the ends. Where targets may be less exact, the
range is widened by the error that the intrinsic table grants (`widened`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

from sssgen.ir.formats import Format

INF = math.inf


class Range:
    """`low` to `high`, without the numbers that are nearer to 0 than `gap`."""

    __slots__ = ("gap", "high", "low")

    def __init__(self, low: float, high: float, gap: float = 0.0) -> None:
        if low > 0.0:
            gap = max(gap, low)
        elif high < 0.0:
            gap = max(gap, -high)
        elif gap > 0.0:
            if low > -gap:
                low, high = gap, max(high, gap)
            elif high < gap:
                high = -gap
        self.low, self.high, self.gap = low, high, gap

    def __repr__(self) -> str:
        return f"Range({self.low:g}, {self.high:g}" + (f", {self.gap:g})" if self.gap else ")")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Range) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    @property
    def key(self) -> tuple[float, float, float]:
        return self.low, self.high, self.gap

    @property
    def size(self) -> float:
        """The largest magnitude."""
        return self.high if self.high > -self.low else -self.low

    def has_zero(self) -> bool:
        return self.gap == 0.0

    def within(self, other: Range) -> bool:
        """Whether the other range contains this one."""
        return self.low >= other.low and self.high <= other.high and self.gap >= other.gap

    def joined(self, other: Range) -> Range:
        """The smallest range that contains both."""
        if self is other:
            return self
        return Range(min(self.low, other.low), max(self.high, other.high), min(self.gap, other.gap))

    def met(self, other: Range) -> Range:
        """The intersection. If it is empty, a range of one number, as such code does not run."""
        low, high = max(self.low, other.low), min(self.high, other.high)
        if low > high:
            low = high = min(max(self.low, other.low), self.high)
            return Range(low, high)
        return Range(low, high, max(self.gap, other.gap))

    def __neg__(self) -> Range:
        return Range(-self.high, -self.low, self.gap)

    def __add__(self, other: Range | float) -> Range:
        other = as_range(other)
        return Range(self.low + other.low, self.high + other.high)

    def __sub__(self, other: Range | float) -> Range:
        return self + -as_range(other)

    def __mul__(self, other: Range | float) -> Range:
        other = as_range(other)
        ends = [_times(a, b) for a in (self.low, self.high) for b in (other.low, other.high)]
        return Range(min(ends), max(ends), self.gap * other.gap)

    def __truediv__(self, other: Range) -> Range:
        """The quotient by a divisor that is not 0."""
        if other.gap == 0.0:
            return ANY
        if other.low > 0.0 or other.high < 0.0:
            inverse = Range(1.0 / other.high, 1.0 / other.low)
        else:
            inverse = Range(-1.0 / other.gap, 1.0 / other.gap, 1.0 / other.size if other.size < INF else 0.0)
        return self * inverse


ANY = Range(-INF, INF)
UNIT = Range(0.0, 1.0)


def as_range(value: Range | float) -> Range:
    return value if isinstance(value, Range) else Range(value, value)


def _times(a: float, b: float) -> float:
    """The product of two ends; 0 times infinity is 0, as no value is infinite."""
    return 0.0 if a == 0.0 or b == 0.0 else a * b


def square(x: Range) -> Range:
    """x·x of the same x."""
    most = x.size * x.size
    return Range(x.gap * x.gap, most)


def absolute(x: Range) -> Range:
    return x if x.low > 0.0 else Range(x.gap, x.size)


def minimum(x: Range, y: Range | float) -> Range:
    y = as_range(y)
    return Range(min(x.low, y.low), min(x.high, y.high), min(x.gap, y.gap))


def maximum(x: Range, y: Range | float) -> Range:
    y = as_range(y)
    return Range(max(x.low, y.low), max(x.high, y.high), min(x.gap, y.gap))


def clip(x: Range, low: Range | float, high: Range | float) -> Range:
    return minimum(maximum(x, low), high)


def hull(low: float, high: float) -> Range:
    return Range(low, high)


def rising(function: Callable[[float], float], x: Range) -> Range:
    """The range of a monotonically increasing function."""
    return Range(_value(function, x.low), _value(function, x.high))


def falling(function: Callable[[float], float], x: Range) -> Range:
    """The range of a monotonically decreasing function."""
    return Range(_value(function, x.high), _value(function, x.low))


def _value(function: Callable[[float], float], x: float) -> float:
    try:
        return float(function(x))
    except OverflowError:
        return math.copysign(INF, x)
    except ValueError:
        return -INF


def power(x: Range, y: Range) -> Range:
    """x to the power y for x above 0. It is monotone in each, so the extremes are at the corners."""
    ends = [_power(a, b) for a in (x.low, x.high) for b in (y.low, y.high)]
    return Range(min(ends), max(ends))


def _power(a: float, b: float) -> float:
    if a <= 0.0:
        return 0.0 if b > 0.0 else INF
    exponent = b * math.log2(a) if a < INF else INF
    return 2.0**exponent if exponent < 1000.0 else INF


def blend(x: Range, y: Range, t: Range) -> Range:
    """x·(1 - t) + y·t. It is linear in each, so the extremes are at the corners."""
    ends = [
        _times(a, 1.0 - c) + _times(b, c) for a in (x.low, x.high) for b in (y.low, y.high) for c in (t.low, t.high)
    ]
    return Range(min(ends), max(ends))


def remainder(x: Range, y: Range) -> Range:
    """mod: between 0 and y, inclusive of y because of rounding."""
    return Range(min(y.low, 0.0), max(y.high, 0.0)) if x.size < INF else ANY


def truncated(x: Range, y: Range) -> Range:
    """fmod: at most as large as y, with the sign of x."""
    return Range(-y.size if x.low < 0.0 else 0.0, y.size if x.high > 0.0 else 0.0)


def signs(x: Range) -> Range:
    low = -1.0 if x.low < 0.0 else (1.0 if x.low > 0.0 else 0.0)
    high = 1.0 if x.high > 0.0 else (-1.0 if x.high < 0.0 else 0.0)
    return Range(low, high, 1.0 if x.gap > 0.0 else 0.0)


def fraction(x: Range) -> Range:
    return x if x.low >= 0.0 and x.high < 1.0 else UNIT


def rounded(x: Range, format: Format) -> Range:
    """A range after rounding to nearest; numbers beyond the largest become infinite.

    A compiler may omit the rounding of a product in a sum (contraction), so the range contains the exact ends too.
    """
    low, high = format.rounded(x.low), format.rounded(x.high)
    gap = x.gap
    if gap:
        gap = format.rounded(gap)
        if gap < format.tiny:  # it may be flushed to 0
            gap = 0.0
            low = 0.0 if low > 0.0 else low
            high = 0.0 if high < 0.0 else high
    low, high = min(low, x.low) if low else 0.0, max(high, x.high) if high else 0.0
    return Range(low, high, min(gap, x.gap))


def widened(x: Range, relative: float, absolute: float = 0.0) -> Range:
    """A range after a computation with a `relative` error (below 1) and an `absolute` error."""
    low = x.low - _times(abs(x.low), relative) - absolute if x.low < INF else INF
    high = x.high + _times(abs(x.high), relative) + absolute if x.high > -INF else -INF
    gap = max(x.gap * (1.0 - relative) - absolute, 0.0)
    return Range(low, high, gap)
