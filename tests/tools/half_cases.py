"""The cases and limits of builtins in half precision, with arguments for which no result overflows."""

from __future__ import annotations

import zlib
from functools import cache, partial
from typing import Any

import numpy as np

from qualification.parity import Case, cases, oracle
from qualification.parity_inputs import TEXTURE_LANES, evaluated, widened
from sssgen.ir.intrinsics import BUILTINS, Samples
from sssgen.ir.types import Matrix, Type, kind_of
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import shape_of

LANES = 400
LARGEST, LEAST = 8.0, 2.0**-6
"""The range of magnitudes: products of four arguments, and exp, are finite halves; squares are normal halves."""

DOMAINS: dict[str, Any] = {
    "acosh": ((1.0, 8.0),), "pow": ((0.125, 8.0), (-4.0, 4.0)), "atanh": ((-0.9, 0.9),),
}  # fmt: skip
"""Smaller domains, where the domain of the table leads to halves that overflow or underflow."""

ROUNDING = {"mod": 2.0**-7, "fmod": 2.0**-7, "faceforward": 1e-2, "reflect": 1e-2, "refract": 1e-2}
"""The rounding errors in half precision that the table's `inside` allows for."""

LIMITS = {
    "sin": (4.0, 2.0**-7),
    "cos": (4.0, 2.0**-7),
    "tan": (4.0, 2.0**-4),  # sin/cos with 2^-7 each, and cos >= 0.54
    "asin": (4.0, 3.91e-3),
    "acos": (4.0, 3.91e-3),
    "atan": (5.0, 0.0),
    "exp": (17.0, 0.0),  # 1 + 2·|x| at 8
    "exp2": (17.0, 0.0),
    "log": (4.0, 2.0**-7),
    "log2": (4.0, 2.0**-7),
    "pow": (50.0, 0.0),  # exp2(y·log2(x)): 1 + 2·12 of exp2, and four times log2's 2^-7
    "sinh": (20.0, 2.0**-8),  # the formulas with exp, which cancel near 0
    "cosh": (20.0, 0.0),
    "tanh": (42.0, 2.0**-8),
    "asinh": (4.0, 2.0**-6),  # the formulas with log
    "acosh": (4.0, 2.0**-6),
    "atanh": (4.0, 2.0**-6),
    "intBitsToFloat": (1.0, 2.0**-14),  # a float32 rounded to half, whose denormals may be lost
    "uintBitsToFloat": (1.0, 2.0**-14),
}
"""(ulp of half, absolute): the limits for f16 in WGSL, "Accuracy of Concrete Floating Point Expressions", if they
differ from those for f32. All other builtins have the limits of the table, which are counts of roundings."""


@cache
def half_cases() -> tuple[Case, ...]:
    """The cases of every overload with a float parameter or result."""
    return tuple(
        case._replace(args=_args(case)) for case in cases(TEXTURE_LANES) if _has_floats((*case.params, case.result))
    )


def wrong_lanes(case: Case, actual: Array) -> str:
    """A message about the lane that exceeds the limits most; '' if all are within the limits."""
    expected = np.broadcast_to(oracle(case), actual.shape)
    if kind_of(case.result) != "float":
        error = np.where(actual == expected, 0.0, np.inf).reshape(-1, case.lanes).max(axis=0)
        return _message(case, actual, expected, error, np.zeros(case.lanes))
    magnitude = np.abs(expected).reshape(-1, case.lanes).max(axis=0)
    size = evaluated(case.row.size, widened(case.args)) if case.row.size else magnitude
    ulp, absolute = LIMITS.get(case.name, (case.row.ulp, case.row.absolute))
    with np.errstate(all="ignore"):
        error = np.abs(actual - expected).reshape(-1, case.lanes).max(axis=0)
        limit = np.maximum(ulp * np.spacing(size.astype(np.float16)).astype(np.float64), absolute)
    error = np.where(magnitude < 65504.0, error, 0.0)  # bits that are not a finite half
    return _message(case, actual, expected, np.nan_to_num(error, nan=np.inf), limit)


def _message(case: Case, actual: Array, expected: Array, error: Array, limit: Array) -> str:
    beyond = np.where(error > limit, error, -1.0)
    lane = int(np.argmax(beyond))
    if beyond[lane] < 0.0:
        return ""
    args = [arg if isinstance(arg, str) else arg[..., lane].tolist() for arg in case.args]
    return f"{case.title} at {args}: {actual[..., lane].tolist()} is not {expected[..., lane].tolist()}"


def _has_floats(types: tuple[Type, ...]) -> bool:
    return any(kind_of(type_) == "float" for type_ in types)


def _args(case: Case) -> tuple[Any, ...]:
    """For reads, derivatives and bits the arguments of the parity tests, as halves; otherwise halves of the domain."""
    if case.row.kind in ("fetch", "derivative") or not _has_floats(case.params):
        return tuple(arg if isinstance(arg, str) else _halves(arg) for arg in case.args)
    rng = np.random.default_rng([16, zlib.crc32(case.title.encode())])
    pool = tuple(_column(case, index, type_, 8 * LANES, rng) for index, type_ in enumerate(case.params))
    inside = case.row.inside or (lambda rt, *args: True)
    if case.name in ROUNDING:
        inside = partial(inside, rounding=ROUNDING[case.name])
    chosen = np.resize(np.flatnonzero(evaluated(inside, widened(pool))), LANES)
    return tuple(arg[..., chosen] for arg in pool)


def _column(case: Case, index: int, type_: Type, count: int, rng: np.random.Generator) -> Array:
    """A random argument: uniform in value or in magnitude, with zeros."""
    size, kind = (*shape_of(type_), count), kind_of(type_)
    if kind == "bool":
        return rng.random(size) < 0.5
    if kind != "float":
        return rng.integers(-9 if kind == "int" else 0, 10, size).astype(np.int32 if kind == "int" else np.uint32)
    if isinstance(type_, Matrix) and case.row.samples.invertible:
        return _halves(2.0 * np.eye(type_.columns)[..., None] + rng.uniform(-0.5, 0.5, size))
    low, high = _ends(case.name, index)
    sizes = 2.0 ** rng.uniform(np.log2(LEAST), np.log2(LARGEST), size) * rng.choice([-1.0, 1.0], size)
    value = np.where(rng.random(size) < 0.5, rng.uniform(low, high, size), np.clip(sizes, low, high))
    value = np.where(np.abs(value) < LEAST, 0.0, value)
    if index in case.row.samples.unit:
        value = value / np.linalg.norm(value, axis=0) if value.ndim > 1 else np.sign(value)
    if case.row.samples.special:
        value = np.where(rng.random(size) < 0.5, value, rng.choice([np.nan, np.inf, -np.inf], size))
    return _halves(value)


def _ends(name: str, index: int) -> tuple[float, float]:
    samples = Samples(DOMAINS[name]) if name in DOMAINS else BUILTINS[name].samples
    low, high = samples.interval(index) or (-LARGEST, LARGEST)
    return max(low, -LARGEST), min(high, LARGEST)


def _halves(value: Array) -> Array:
    return value.astype(np.float16).astype(np.float32) if value.dtype.kind == "f" else value
