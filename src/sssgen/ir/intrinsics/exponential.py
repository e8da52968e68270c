"""Exponentials, logarithms and roots: 8.2 of the specification."""

from __future__ import annotations

import math

from sssgen.ir.component_ranges import logarithm_error, positive_power
from sssgen.ir.formats import Format
from sssgen.ir.intervals import INF, Range, clip, falling, maximum, rising
from sssgen.ir.intrinsics.table import F1, F2, LARGEST, Builtin, Guard, Samples, check_domain

_LOG = "WGSL, Vulkan: 3 ulp, but an absolute error of 2^-21 for x in [0.5, 2]"
_EXP = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 88"
_EXP2 = "WGSL, Vulkan: 3 + 2·|x| ulp; taken at |x| = 128"


def _below_overflow(F: Format, result: Range) -> Range:
    """A power behind its guard, which limits the exponent."""
    top = 2.0**F.exponent
    return Range(min(result.low, 0.99 * top), min(result.high, 1.01 * top))


def _power_is_finite(F: Format, x: Range, y: Range) -> bool:
    """Whether exp2(y * log2(x)) does not overflow, though log2 has an error; it has a margin of 1 for that."""
    return (y * rising(math.log2, maximum(x, F.tiny))).high + max(logarithm_error(F) * y.size - 1.0, 0.0) < F.exponent


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("pow", F2, "x to the power y.",
        es=100, fold=lambda x, y: check_domain(x > 0.0 or (x == 0.0 and y > 0.0), math.pow(x, y)),
        samples=Samples(floats=((0.0, LARGEST), (-64.0, 64.0))), exact_bounds=(0.0, INF), range=positive_power,
        guards=(
            Guard(_power_is_finite, "overflow", "a power that overflows", "exp2(min(y * log2(max(x, TINY)), EXPONENT))", result=_below_overflow),
            Guard(lambda F, x, y: x.low > 0.0 or (x.low >= 0.0 and y.low >= F.epsilon), "nan", "a power of less than 0, or one of 0 near the power 0", "max(x, TINY)", "x", result=_below_overflow),
        ),
        defined=lambda rt, x, y: (x > 0.0) | (x == 0.0) & (y > 0.0),
        inside=lambda rt, x, y: (x > 0.0) & (abs(y) <= 64.0) & (abs(y * rt.log2(rt.max(x, 1e-38))) < 126.0),
        domain="x > 0, or x = 0 and y > 0, where WGSL may miss 0; accurate for |y| <= 64", kind="transcendental", cost=9, ulp=600.0,
        clause="WGSL, Vulkan: that of exp2(y·log2(x)); taken at |y| = 64 and |y·log2(x)| = 126",
        vectors=(((2.0, -1.5), 0.3535533905932738), ((3.0, 2.0), 9.0), ((0.0, 0.5), 0.0), ((5.0, 0.0), 1.0)),
    ),
    Builtin("exp", F1, "e to the power x.",
        es=100, fold=math.exp, samples=Samples(floats=((-88.0, 88.0),)), exact_bounds=(0.0, 1.0),
        range=lambda F, x: rising(math.exp, x),
        guards=(Guard(lambda F, x: x.high < 0.69 * F.exponent, "overflow", "exp overflows", "min(x, 0.69 * EXPONENT)", "x", argument=lambda F, x: clip(x, -INF, 0.69 * F.exponent)),),
        inside=lambda rt, x: x < 88.0,
        domain="x < 88", kind="transcendental", cost=5, ulp=179.0, clause=_EXP,
        vectors=(((1.0,), 2.718281828459045), ((0.0,), 1.0), ((-2.0,), 0.1353352832366127)),
    ),
    Builtin("log", F1, "Natural logarithm.",
        es=100, fold=math.log, samples=Samples(floats=((0.0, LARGEST),)), exact_bounds=(0.0, 0.0),
        range=lambda F, x: rising(math.log, maximum(x, F.tiny)),
        guards=(Guard(lambda F, x: x.low > 0.0, "nan", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside=lambda rt, x: x > 0.0,
        domain="x > 0", kind="transcendental", cost=5, absolute=2.0**-21, clause=_LOG,
        vectors=(((1.0,), 0.0), ((10.0,), 2.302585092994046), ((0.5,), -0.6931471805599453)),
    ),
    Builtin("exp2", F1, "2 to the power x.",
        es=100, fold=lambda x: 2.0**x, samples=Samples(floats=((-126.0, 127.9),)), exact_bounds=(0.0, 1.0),
        range=lambda F, x: rising(math.exp2, x),
        guards=(Guard(lambda F, x: x.high < F.exponent + 1.0, "overflow", "exp2 overflows", "min(x, EXPONENT)", "x", argument=lambda F, x: clip(x, -INF, F.exponent)),),
        inside=lambda rt, x: x < 128.0,
        domain="x < 128", kind="transcendental", cost=4, ulp=259.0, clause=_EXP2,
        vectors=(((0.5,), 1.4142135623730951), ((0.0,), 1.0), ((-3.0,), 0.125)),
    ),
    Builtin("log2", F1, "Binary logarithm.",
        es=100, fold=math.log2, samples=Samples(floats=((0.0, LARGEST),)), exact_bounds=(0.0, 0.0),
        range=lambda F, x: rising(math.log2, maximum(x, F.tiny)),
        guards=(Guard(lambda F, x: x.low > 0.0, "nan", "the logarithm of 0 or less", "max(x, TINY)", "x"),),
        inside=lambda rt, x: x > 0.0,
        domain="x > 0", kind="transcendental", cost=4, absolute=2.0**-21, clause=_LOG,
        vectors=(((3.0,), 1.584962500721156), ((1.0,), 0.0), ((0.125,), -3.0)),
    ),
    Builtin("sqrt", F1, "Square root.",
        es=100, fold=math.sqrt, samples=Samples(floats=((0.0, LARGEST),)), exact_bounds=(0.0, INF),
        range=lambda F, x: rising(math.sqrt, maximum(x, 0.0)),
        guards=(Guard(lambda F, x: x.low >= 0.0, "nan", "the square root of less than 0", "max(x, 0.0)", "x"),),
        inside=lambda rt, x: x >= 0.0,
        domain="x >= 0", kind="transcendental", cost=4, ulp=6.0,
        clause="WGSL, Vulkan: that of 1/inversesqrt(x), with 2 and 2.5 ulp",
        vectors=(((2.0,), 1.4142135623730951), ((0.0,), 0.0), ((0.0625,), 0.25)),
    ),
    Builtin("inversesqrt", F1, "1/sqrt(x).",
        es=100, fold=lambda x: 1.0 / math.sqrt(x), samples=Samples(floats=((0.0, LARGEST),)), exact_bounds=(0.0, INF),
        range=lambda F, x: falling(lambda v: v**-0.5, maximum(x, F.tiny)),
        guards=(Guard(lambda F, x: x.low > 0.0, "nan", "the inverse square root of 0 or less", "max(x, TINY)", "x"),),
        inside=lambda rt, x: x > 0.0,
        domain="x > 0", texts={"hlsl": "rsqrt", "wgsl": "inverseSqrt", "wgsl-metal": "rsqrt", "tsl": "inverseSqrt"}, kind="transcendental", cost=4,
        vectors=(((2.0,), 0.7071067811865476), ((1.0,), 1.0), ((0.0625,), 4.0)),
    ),
)
