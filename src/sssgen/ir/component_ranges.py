"""Ranges of componentwise builtins, for the rows of the intrinsic table.

Each takes the format and the ranges of the arguments' components, and returns the range of the result's component. What
is here includes the rounding errors of a formula; a plain function of `intervals` suffices for all others.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from sssgen.ir.formats import Format
from sssgen.ir.intervals import ANY, INF, Range, clip, hull, maximum, power, remainder, rising, truncated, widened


def within(low: float, high: float) -> Callable[..., Range]:
    """The range function of a builtin whose results always lie in one interval."""
    interval = Range(low, high)
    return lambda F, *arguments: interval


def any_number(F: Format, *arguments: Range) -> Range:
    """The range of a builtin about whose result nothing is known."""
    return ANY


def scaled(factor: float) -> Callable[..., Range]:
    """The range function of a product with a constant, which may be rounded too."""
    return lambda F, x: widened(x * factor, 2.0 * F.epsilon)


def linear_blend(F: Format, x: Range, y: Range, z: Range) -> Range:
    """By x·(1 - z) + y·z, or by x + (y - x)·z as in HLSL: result and error have their ends at the corners.

    Between two numbers of the same sign the sign stays, and a power of two as the larger of them is not exceeded.
    """
    most = max(x.size, y.size)
    if (x.size + y.size) * (1.0 + z.size) > F.largest:  # a term may overflow
        return ANY
    low = exact_low = INF
    high = exact_high = -INF
    for a, b, c in itertools.product((x.low, x.high), (y.low, y.high), (z.low, z.high)):
        corner = a * (1.0 - c) + b * c
        error = 2.0 * F.epsilon * (abs((b - a) * c) + abs(a * (1.0 - c)) + abs(b * c))
        low, high = min(low, corner - error), max(high, corner + error)
        exact_low, exact_high = min(exact_low, corner), max(exact_high, corner)
    if z.low < 0.0 or z.high > 1.0:
        return Range(low, high)
    bound = most if math.frexp(most)[0] == 0.5 else INF
    if exact_low >= 0.0:
        return Range(max(low, 0.0), min(high, bound))
    if exact_high <= 0.0:
        return Range(max(low, -bound), min(high, 0.0))
    return Range(low, high)


def positive_power(F: Format, x: Range, y: Range) -> Range:
    """pow, whose base is at least the smallest normal number, or 0, whose powers are 0."""
    result = power(maximum(x, F.tiny), y)
    low, high = (result.low if x.low > 0.0 else 0.0), result.high
    if y.size > 64.0:  # the error of log2 counts; of 1 it has none
        error = 2.0 ** min(logarithm_error(F) * y.size, 1000.0)
        low = low / error if low <= 1.0 else max(low / error, 1.0)
        high = high * error if high >= 1.0 else min(high * error, 1.0)
    return Range(low, high)


def logarithm_error(F: Format) -> float:
    """The absolute error of log2 near 1 that WGSL and Vulkan allow."""
    return 4.0 * F.epsilon


def floored_remainder(F: Format, x: Range, y: Range) -> Range:
    return _with_wrapped(remainder(x, y), F, x, y)


def truncated_remainder(F: Format, x: Range, y: Range) -> Range:
    return _with_wrapped(truncated(x, y), F, x, y)


def _with_wrapped(exact_range: Range, F: Format, x: Range, y: Range) -> Range:
    """The range of a remainder whose x/y may round to the next integer (not if y is a power of two), or overflow."""
    if x.size > 1e30 * y.gap or x.size * (1.0 + 4.0 * F.epsilon) + y.size > F.largest:
        return ANY
    exact = y.low == y.high and abs(math.frexp(y.low)[0]) == 0.5
    opposite = max(x.high, y.high) > 0.0 > min(x.low, y.low)
    # a quotient below 0 that is flushed to 0 leaves x as it is
    flushed = F.tiny * y.size if opposite and not (exact and y.size <= 1.0) else 0.0
    return widened(exact_range, 0.0, (0.0 if exact else 4.0 * F.epsilon * x.size) + flushed)


def inverse_hyperbolic_tangent(F: Format, x: Range) -> Range:
    bound = 1.0 - 0.5 * F.epsilon
    result = rising(math.atanh, clip(x, -bound, bound))
    # there is a number between 1 - epsilon and 1
    return widened(result, 0.0, 0.35) if x.size > 1.0 - F.epsilon else result


def fused_product_sum(F: Format, x: Range, y: Range, z: Range) -> Range:
    """fma, rounded once or twice."""
    if (x * y).size > F.largest:
        return ANY
    return x * y + z + hull(-1.0, 1.0) * (F.epsilon * (x * y).size + F.tiny)


def power_of_two_product(F: Format, x: Range, y: Range) -> Range:
    return x * rising(math.exp2, y)
