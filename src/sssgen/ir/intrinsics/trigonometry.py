"""Angles and trigonometry: 8.1 of the specification."""

from __future__ import annotations

import math
from typing import Any

from sssgen.ir.component_ranges import inverse_hyperbolic_tangent, scaled, within
from sssgen.ir.formats import Format
from sssgen.ir.intervals import Range, absolute, clip, maximum, rising
from sssgen.ir.intrinsics.table import F1, HALF_PI, NONZERO, PI, Builtin, Guard, Samples, check_domain

_PI32 = 3.1415927410125732
"""pi in float32."""
_HYPERBOLIC = "WGSL, Vulkan: that of the formula with exp, 3 + 2·|x| ulp, which cancels near 0"
_TRIG = "WGSL, Vulkan: absolute error of 2^-11 in [-pi, pi]; D3D: 0.0008"
_ASIN = (
    "GLSL: no bound (Mesa: absolute error of 4e-4); WGSL: 6.81e-5, or that of the formula with atan; Vulkan: the latter"
)
_ATAN = "WGSL, Vulkan: 4096 ulp"
_BY_LOG = "WGSL, Vulkan: that of the formula with log, whose own error is absolute"
_ACOSH = "WGSL, Vulkan: that of log(x + sqrt(x·x - 1)), which cancels near 1"


def _above_one(F: Format, x: Range) -> Range:
    return clip(x, 1.0, 0.5 * F.largest**0.5)


def _reduced(rt: Any, x: Any) -> Any:
    """Where drivers reduce an angle to [-pi, pi]; larger ones have no meaning in float32."""
    return abs(x) <= 2.0**15


def _unit_advice(x: Range) -> str:
    noted = ", as rounding alone can exceed 1" if 1.0 < x.size <= 1.01 else ""
    return f"clamp(x, -1.0, 1.0) in place of x{noted}"


def _angle_advice(x: Range, y: Range) -> str:
    return f"{NONZERO} in place of y"  # lint proves it, unlike a sum with step


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("radians", F1, "Degrees to radians: x·pi/180.",
        es=100, fold=lambda x: x * math.pi / 180.0, range=scaled(0.017453292519943295), texts={"wgsl-metal": ""},
        polyfill="genF radians(genF x) { return x * 0.017453292519943295; }",
        vectors=(((90.0,), HALF_PI), ((0.0,), 0.0), ((-30.0,), -0.5235987755982989)),
    ),
    Builtin("degrees", F1, "Radians to degrees: x·180/pi.",
        es=100, fold=lambda x: x * 180.0 / math.pi, range=scaled(57.29577951308232), texts={"wgsl-metal": ""},
        polyfill="genF degrees(genF x) { return x * 57.29577951308232; }",
        vectors=(((1.0,), 57.29577951308232), ((0.0,), 0.0), ((-0.5,), -28.64788975654116)),
    ),
    Builtin("sin", F1, "Sine of an angle in radians.",
        es=100, fold=math.sin, samples=Samples(floats=((-_PI32, _PI32),)), range=within(-1.0, 1.0),
        defined=_reduced, inside=lambda rt, x: abs(x) <= 3.1415928,
        domain="accurate for |x| <= pi", kind="transcendental", cost=4, absolute=2.0**-11, clause=_TRIG,
        vectors=(((1.0,), 0.8414709848078965), ((0.0,), 0.0), ((-0.5,), -0.479425538604203)),
    ),
    Builtin("cos", F1, "Cosine of an angle in radians.",
        es=100, fold=math.cos, samples=Samples(floats=((-_PI32, _PI32),)), range=within(-1.0, 1.0),
        defined=_reduced, inside=lambda rt, x: abs(x) <= 3.1415928,
        domain="accurate for |x| <= pi", kind="transcendental", cost=4, absolute=2.0**-11, clause=_TRIG,
        vectors=(((1.0,), 0.5403023058681398), ((0.0,), 1.0), ((2.5,), -0.8011436155469337)),
    ),
    Builtin("tan", F1, "Tangent of an angle in radians.",
        es=100, fold=math.tan, samples=Samples(floats=((-1.0, 1.0),)), range=within(-1e7, 1e7),
        guards=(Guard(lambda F, x: absolute(x).high <= 1.5, "overflow", "a tangent near 90 degrees", "clamp(tan(x), -1.0e7, 1.0e7)"),),
        defined=_reduced, inside=lambda rt, x: abs(x) <= 1.0,
        domain="cos(x) != 0; accurate for |x| <= 1", kind="transcendental", cost=12, ulp=8192.0,
        absolute=2.0**-10, clause="WGSL, Vulkan: that of sin(x)/cos(x)",
        vectors=(((1.0,), 1.5574077246549023), ((0.0,), 0.0), ((-0.5,), -0.5463024898437905)),
    ),
    Builtin("asin", F1, "Arc sine, in [-pi/2, pi/2].",
        es=100, fold=math.asin, samples=Samples(floats=((-1.0, 1.0),)), range=within(-1.5708, 1.5708),
        guards=(Guard(lambda F, x: x.low >= -1.0 and x.high <= 1.0, "nan", "an arc sine of a number outside of -1..1", "clamp(x, -1.0, 1.0)", "x", advice=_unit_advice),),
        inside=lambda rt, x: abs(x) <= 1.0,
        domain="-1 <= x <= 1", kind="transcendental", cost=16, ulp=4096.0, absolute=2.0**-11, clause=_ASIN,
        vectors=(((1.0,), HALF_PI), ((0.0,), 0.0), ((-0.5,), -0.5235987755982989)),
    ),
    Builtin("acos", F1, "Arc cosine, in [0, pi].",
        es=100, fold=math.acos, samples=Samples(floats=((-1.0, 1.0),)), range=within(0.0, 3.1416),
        guards=(Guard(lambda F, x: x.low >= -1.0 and x.high <= 1.0, "nan", "an arc cosine of a number outside of -1..1", "clamp(x, -1.0, 1.0)", "x", advice=_unit_advice),),
        inside=lambda rt, x: abs(x) <= 1.0,
        domain="-1 <= x <= 1", kind="transcendental", cost=16, ulp=4096.0, absolute=2.0**-11, clause=_ASIN,
        vectors=(((1.0,), 0.0), ((0.5,), 1.0471975511965979), ((-1.0,), PI)),
    ),
    Builtin("atan", ("genF(genF)", "genF(genF, genF)"),
        "Arc tangent: of x, in [-pi/2, pi/2]; of x/y in the quadrant of (y, x), in [-pi, pi].",
        es=100, fold=lambda x, y=None: math.atan(x) if y is None else check_domain(x != 0.0 or y != 0.0, math.atan2(x, y)),
        range=lambda F, x, y=None: Range(-3.1416, 3.1416) if y else Range(-1.5708, 1.5708),
        guards=(Guard(lambda F, x, y: not x.has_zero() or not y.has_zero(), "undefined", "the angle of (0, 0)", "y + step(abs(x) + abs(y), genF(0.0))", "y", advice=_angle_advice),),
        domain="with two arguments: x != 0 or y != 0, and x != -0, whose sign may be lost; accurate for y != 0 and |y| < 2^126",
        defined=lambda rt, x, y=1.0: ((x != 0.0) & (y == 0.0)) | (abs(y) >= 2.0**-126) & (abs(y) <= 2.0**126),
        inside=lambda rt, x, y=1.0: (rt.floatBitsToInt(x) != -2**31) & (abs(y) >= 2.0**-126) & (abs(y) <= 2.0**126),
        texts={"hlsl/genF,genF": "atan2", "wgsl/genF,genF": "atan2"}, kind="transcendental", cost=16,
        ulp=4096.0, clause=_ATAN,
        vectors=(
            ((1.0,), 0.7853981633974483), ((-3.0,), -1.2490457723982544), ((0.0,), 0.0),
            ((1.0, -1.0), 2.356194490192345), ((0.0, -1.0), PI), ((-2.0, 0.0), -HALF_PI),
        ),
    ),
    Builtin("sinh", F1, "Hyperbolic sine.",
        es=300, fold=math.sinh, samples=Samples(floats=((-88.0, 88.0),)), range=lambda F, x: rising(math.sinh, x),
        guards=(Guard(lambda F, x: x.size < 0.6 * F.exponent, "overflow", "exp in it overflows", "clamp(x, -0.6 * EXPONENT, 0.6 * EXPONENT)", "x",
            argument=lambda F, x: clip(x, -0.6 * F.exponent, 0.6 * F.exponent)),),
        inside=lambda rt, x: abs(x) < 88.0,
        domain="|x| < 88", kind="transcendental", cost=11, ulp=184.0, absolute=2.0**-20, clause=_HYPERBOLIC,
        vectors=(((1.0,), 1.1752011936438014), ((0.0,), 0.0), ((-0.5,), -0.5210953054937474)),
    ),
    Builtin("cosh", F1, "Hyperbolic cosine.",
        es=300, fold=math.cosh, samples=Samples(floats=((-88.0, 88.0),)), range=lambda F, x: rising(math.cosh, absolute(x)),
        guards=(Guard(lambda F, x: x.size < 0.6 * F.exponent, "overflow", "exp in it overflows", "clamp(x, -0.6 * EXPONENT, 0.6 * EXPONENT)", "x",
            argument=lambda F, x: clip(x, -0.6 * F.exponent, 0.6 * F.exponent)),),
        inside=lambda rt, x: abs(x) < 88.0,
        domain="|x| < 88", kind="transcendental", cost=11, ulp=184.0, clause=_HYPERBOLIC,
        vectors=(((1.0,), 1.5430806348152437), ((0.0,), 1.0), ((-2.0,), 3.7621956910836314)),
    ),
    Builtin("tanh", F1, "Hyperbolic tangent.",
        es=300, fold=math.tanh, samples=Samples(floats=((-44.0, 44.0),)), range=within(-1.0, 1.0),
        guards=(Guard(lambda F, x: x.size <= 0.3 * F.exponent, "overflow", "exp in it overflows", "clamp(x, -0.3 * EXPONENT, 0.3 * EXPONENT)", "x"),),
        inside=lambda rt, x: abs(x) < 44.0,
        domain="|x| < 44, as sinh(x)/cosh(x) may overflow beyond", kind="transcendental", cost=14, ulp=184.0,
        absolute=1e-5, clause="WGSL: absolute error of 1e-5, or that of sinh(x)/cosh(x); Vulkan: the latter",
        vectors=(((0.5,), 0.46211715726000974), ((0.0,), 0.0), ((-20.0,), -1.0)),
    ),
    Builtin("asinh", F1, "Inverse hyperbolic sine.",
        es=300, fold=math.asinh, range=lambda F, x: rising(math.asinh, x),
        guards=(Guard(lambda F, x: x.size < 0.5 * F.largest**0.5, "overflow", "the argument's square overflows", "clamp(x, -0.5 * ROOT, 0.5 * ROOT)", "x"),),
        inside=lambda rt, x: abs(x) < 1e19,
        domain="|x| < 1e19", texts={"glsl": "", "hlsl": "", "wgsl": "", "tsl": ""},  # NVIDIA and SwiftShader lose large negative x
        polyfill="genF asinh(genF x) { return sign(x) * log(abs(x) + sqrt(x * x + 1.0)); }",
        kind="transcendental", cost=14, absolute=2.0**-20, clause=_BY_LOG,
        vectors=(((1.0,), 0.881373587019543), ((0.0,), 0.0), ((-2.0,), -1.4436354751788103)),
    ),
    Builtin("acosh", F1, "Inverse hyperbolic cosine, not negative.",
        es=300, fold=math.acosh, samples=Samples(floats=((1.0, 1e18),)),
        range=lambda F, x: rising(math.acosh, maximum(x, 1.0)),
        guards=(
            Guard(lambda F, x: x.low >= 1.0, "nan", "an argument below 1", "clamp(x, 1.0, 0.5 * ROOT)", "x", argument=_above_one),
            Guard(lambda F, x: x.high < 0.5 * F.largest**0.5, "overflow", "the argument's square overflows", "clamp(x, 1.0, 0.5 * ROOT)", "x", argument=_above_one),
        ),
        inside=lambda rt, x: (x >= 1.0) & (x < 1e19),
        domain="1 <= x < 1e19", texts={"hlsl": ""},
        polyfill="genF acosh(genF x) { return log(x + sqrt((x - 1.0) * (x + 1.0))); }", kind="transcendental",
        cost=13, absolute=2.0**-12, clause=_ACOSH,
        vectors=(((1.0,), 0.0), ((1.5,), 0.9624236501192069), ((2.0,), 1.3169578969248168)),
    ),
    Builtin("atanh", F1, "Inverse hyperbolic tangent.",
        es=300, fold=math.atanh, samples=Samples(floats=((-1.0, 1.0),)), range=inverse_hyperbolic_tangent,
        guards=(Guard(lambda F, x: x.low > -1.0 and x.high < 1.0, "nan", "an argument that is not between -1 and 1", "clamp(x, EPSILON - 1.0, 1.0 - EPSILON)", "x"),),
        inside=lambda rt, x: abs(x) < 1.0,
        domain="-1 < x < 1", texts={"hlsl": ""},
        polyfill="genF atanh(genF x) { return 0.5 * log((1.0 + x) / (1.0 - x)); }", kind="transcendental",
        cost=12, absolute=2.0**-20, clause=_BY_LOG,
        vectors=(((0.5,), 0.5493061443340549), ((0.0,), 0.0), ((-0.25,), -0.25541281188299536)),
    ),
)
