"""Functions of whole vectors: lengths, products, directions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from sssgen.ir import vector_ranges
from sssgen.ir.intervals import Range
from sssgen.ir.intrinsics.table import Builtin, Guard, Samples

_REDUCE = ("float(vecF, vecF)", "float(float, float)")
_SUM = "WGSL, Vulkan: that of the formula, whose sum rounds in any order"


_DIRECTION = "x * (dot(x, x) > SQUARE ? inversesqrt(dot(x, x)) : 0.0)"
_DIRECTION_DOC = "The direction of `x`; of a zero vector, 0."


def _dot(x: Sequence[float], y: Sequence[float]) -> float:
    return math.fsum(a * b for a, b in zip(x, y))


def _length(x: Sequence[float]) -> float:
    return math.sqrt(_dot(x, x))


def _refracted(x: Sequence[float], y: Sequence[float], z: Sequence[float]) -> list[float]:
    eta, cosine = z[0], _dot(y, x)
    k = 1.0 - eta * eta * (1.0 - cosine * cosine)
    return [0.0 if k < 0.0 else eta * a - (eta * cosine + math.sqrt(k)) * b for a, b in zip(x, y)]


def _signed_dot(rt: Any, x: Any, y: Any, z: Any, rounding: float = 1e-6) -> Any:
    """Where the sign of dot(z, y) does not depend on rounding."""
    terms = rt.dot(abs(z), abs(y))
    return (terms < 1e38) & ((terms == 0.0) | (abs(rt.dot(z, y)) > rt.max(1e-30, rounding * terms)))


def _away_from_total_reflection(rt: Any, x: Any, y: Any, z: Any, rounding: float = 1e-6) -> Any:
    unit = (abs(rt.dot(x, x) - 1.0) < rounding) & (abs(rt.dot(y, y) - 1.0) < rounding)
    return unit & (z > 0.0) & (abs(1.0 - z * z * (1.0 - rt.dot(x, y) ** 2)) > 0.1)


def _measurable(rt: Any, x: Any) -> Any:
    """Where the sum of squares neither overflows nor underflows, or is 0."""
    return (rt.dot(x, x) < 1e38) & ((rt.dot(x, x) > 1e-30) | (rt.dot(x, x) == 0.0))


def _directed(rt: Any, x: Any) -> Any:
    """Where the sum of squares neither overflows nor underflows."""
    return (rt.dot(x, x) < 1e38) & (rt.dot(x, x) > 1e-30)


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("length", ("float(vecF)", "float(float)"), "Euclidean length.",
        es=100, texts={"wgsl-metal/float": "abs"},
        fold=lambda x: [_length(x)], relation="length", componentwise=False, range=vector_ranges.length,
        inside=_measurable, defined=_measurable,
        domain="dot(x, x) does not overflow: |x| < 1e19", kind="transcendental", cost=2, once=4, ulp=8.0,
        clause="WGSL, Vulkan: that of sqrt(dot(x, x))",
        vectors=((((3.0, 4.0),), 5.0), (((0.0, 0.0, 0.0),), 0.0), ((-2.0,), 2.0)),
    ),
    Builtin("distance", _REDUCE, "Length of x - y.",
        es=100, fold=lambda x, y: [_length([a - b for a, b in zip(x, y)])], componentwise=False, range=vector_ranges.distance,
        inside=lambda rt, x, y: _measurable(rt, x - y), defined=lambda rt, x, y: _measurable(rt, x - y),
        domain="|x - y| < 1e19", texts={"hlsl/float,float": "", "wgsl-metal/float,float": ""}, polyfill="float distance(float x, float y) { return abs(x - y); }",
        kind="transcendental", cost=3, once=4, ulp=8.0, clause="WGSL, Vulkan: that of length(x - y)",
        vectors=(
            (((4.0, 6.0), (1.0, 2.0)), 5.0), (((1.0, 2.0, 3.0), (1.0, 2.0, 3.0)), 0.0), ((1.0, -1.5), 2.5),
        ),
    ),
    Builtin("dot", _REDUCE, "Sum of the products of the components.",
        es=100, fold=lambda x, y: [_dot(x, y)], overflow_is_nan=True, relation="squares",
        componentwise=False, range=vector_ranges.dot,
        inside=lambda rt, x, y: rt.dot(abs(x), abs(y)) < 1e38, size=lambda rt, x, y: rt.dot(abs(x), abs(y)),
        texts={"hlsl/float,float": "op:*", "wgsl/float,float": "op:*", "tsl/float,float": "op:*"}, cost=2,
        vectors=(
            (((1.0, 2.0, 3.0), (4.0, -5.0, 6.0)), 12.0), (((0.0, 1.0), (1.0, 0.0)), 0.0), ((2.0, -3.0), -6.0),
        ),
    ),
    Builtin("cross", ("vec3(vec3, vec3)",), "Cross product, right-handed: x-axis with y-axis gives z-axis.",
        es=100, fold=lambda x, y: [x[i] * y[j] - x[j] * y[i] for i, j in ((1, 2), (2, 0), (0, 1))], overflow_is_nan=True,
        quantity="direction", componentwise=False, range=vector_ranges.cross,
        inside=lambda rt, x, y: rt.length(x) * rt.length(y) < 1e38, size=lambda rt, x, y: rt.max(abs(x * y[[1, 2, 0]]), abs(y * x[[1, 2, 0]])),
        cost=3,
        vectors=(
            (((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), (0.0, 0.0, 1.0)),
            (((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)), (-3.0, 6.0, -3.0)),
            (((2.0, 4.0, 6.0), (1.0, 2.0, 3.0)), (0.0, 0.0, 0.0)),
        ),
    ),
    Builtin("normalize", ("vecF(vecF)", "float(float)"), "x / length(x).",
        es=100, fold=lambda x: [a / _length(x) for a in x], quantity="direction",
        componentwise=False, range=vector_ranges.normalize,
        guards=(
            Guard(lambda F, x: F.square**0.5 < x.low, "nan", "the direction of a zero vector", _DIRECTION, doc=_DIRECTION_DOC,
                succeeds=lambda F, x: x.met(Range(1.001 * F.square**0.5, 0.99 * F.largest**0.5))),
            Guard(lambda F, x: x.high < F.largest**0.5, "overflow", "a vector whose squares overflow", _DIRECTION, doc=_DIRECTION_DOC,
                succeeds=lambda F, x: x.met(Range(0.0, 0.99 * F.largest**0.5))),
        ),
        inside=_directed, defined=_directed,
        domain="dot(x, x) > 0 and does not overflow", texts={"hlsl/float": "", "wgsl/float": "", "tsl/float": ""},
        polyfill="float normalize(float x) { return sign(x); }", kind="transcendental", cost=3, once=4, ulp=8.0,
        clause="WGSL, Vulkan: that of x / length(x)",
        vectors=(
            (((3.0, 4.0),), (0.6, 0.8)),
            (((1.0, 2.0, 3.0),), (0.2672612419124244, 0.5345224838248488, 0.8017837257372732)),
            (((0.0, 0.0, -0.5),), (0.0, 0.0, -1.0)), ((-2.0,), -1.0),
        ),
    ),
    Builtin("faceforward", ("vecF(vecF, vecF, vecF)", "float(float, float, float)"),
        "x where dot(z, y) < 0, else -x: the normal x turned against the direction of incidence y.",
        es=100, not_constant=("wgsl",), fold=lambda x, y, z: [a if _dot(z, y) < 0.0 else -a for a in x], quantity="direction", componentwise=False, range=vector_ranges.faceforward,
        inside=_signed_dot,
        texts={"hlsl/float,float,float": "", "wgsl": "faceForward", "wgsl/float,float,float": "", "tsl": "faceForward", "tsl/float,float,float": "",
            "wgsl-metal/vecF,vecF,vecF": "faceforward"},
        polyfill="float faceforward(float x, float y, float z) { return z * y < 0.0 ? x : -x; }", cost=4,
        ulp=0.0, vectors=(
            (((0.0, 1.0), (0.0, -1.0), (0.0, 1.0)), (0.0, 1.0)),
            (((0.0, 1.0), (0.0, 1.0), (0.0, 1.0)), (0.0, -1.0)),
            (((0.0, 0.5, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), (0.0, -0.5, -1.0)),
        ),
    ),
    Builtin("reflect", ("vecF(vecF, vecF)", "float(float, float)"),
        "x - 2·dot(y, x)·y: direction x mirrored at the unit normal y.",
        es=100, not_constant=("wgsl",), fold=lambda x, y: [a - 2.0 * _dot(y, x) * b for a, b in zip(x, y)], samples=Samples(unit=(1,)), overflow_is_nan=True, quantity="direction",
        componentwise=False, range=vector_ranges.reflect,
        inside=lambda rt, x, y, rounding=1e-6: (abs(rt.dot(y, y) - 1.0) < rounding) & (abs(x) < 1e38), size=lambda rt, x, y: rt.max(abs(x), 2.0 * rt.dot(abs(x), abs(y)) * abs(y)),
        domain="dot(y, y) = 1", texts={"hlsl/float,float": "", "wgsl/float,float": "", "tsl/float,float": ""},
        polyfill="float reflect(float x, float y) { return x - 2.0 * y * x * y; }", cost=4, ulp=8.0,
        clause=_SUM,
        vectors=(
            (((1.0, -1.0), (0.0, 1.0)), (1.0, 1.0)), (((0.0, 0.0, -1.0), (0.0, 0.0, 1.0)), (0.0, 0.0, 1.0)),
            (((1.0, 2.0, 3.0), (1.0, 0.0, 0.0)), (-1.0, 2.0, 3.0)),
        ),
    ),
    Builtin("refract", ("vecF(vecF, vecF, float)", "float(float, float, float)"),
        "Direction x refracted at the unit normal y, z = n_from/n_into; 0 on total internal reflection.",
        es=100, not_constant=("wgsl",), fold=_refracted, samples=Samples(floats=((-1.0, 1.0), (-1.0, 1.0), (0.0, 4.0)), unit=(0, 1)), overflow_is_nan=True,
        quantity="direction", componentwise=False, range=vector_ranges.refract,
        inside=_away_from_total_reflection, size=lambda rt, x, y, z: rt.max(z * z, 1.0),
        domain="dot(x, x) = dot(y, y) = 1 and z > 0",
        texts={"hlsl/float,float,float": "", "wgsl/float,float,float": "", "tsl/float,float,float": ""},
        polyfill="""
float refract(float x, float y, float z) {
    float c = y * x;
    float k = 1.0 - z * z * (1.0 - c * c);
    return k < 0.0 ? 0.0 : z * x - (z * c + sqrt(max(k, 0.0))) * y;
}
""",
        splat=(), kind="transcendental", cost=12, ulp=16.0,
        clause="WGSL, Vulkan: that of the formula, with sqrt near total internal reflection",
        vectors=(
            (((0.0, -1.0), (0.0, 1.0), 0.75), (0.0, -1.0)), (((1.0, 0.0), (0.0, 1.0), 1.5), (0.0, 0.0)),
            (((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.25), (0.25, 0.0, -0.9682458365518543)),
        ),
    ),
)
