"""Arrays of float32 numbers with which every operation makes a random error of the size that float32 allows.

A result of several runs with such numbers shows how far two correct implementations in float32 may differ in a lane,
whatever the function: where rounding decides a branch, where nearly equal terms are subtracted, in a hash. A result
that float32 represents exactly has no error, so that whole numbers stay whole; a quotient always has one, unless the
divisor is a power of two, since drivers multiply by a reciprocal. Subnormal results may become 0, and a 0 has any sign.

The numbers are stored in float64, rounded to float32. The functions of the NumPy runtime take them like other arrays.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np

from sssgen.run.backends import Array

DIVISION = 2.5
"""The error of a quotient, in units in the last place: what WGSL and Vulkan allow."""
SMALLEST = 2.0**-126
"""The smallest normal float32."""
_EXACT = frozenset(
    {np.floor, np.ceil, np.trunc, np.rint, np.absolute, np.negative, np.positive, np.sign, np.minimum, np.maximum}
)

_generator: ContextVar[np.random.Generator] = ContextVar("errors")


@contextmanager
def seed_errors(seed: int) -> Iterator[None]:
    """The errors that follow depend on this seed."""
    token = _generator.set(np.random.default_rng(seed))
    try:
        yield
    finally:
        _generator.reset(token)


class RoundedArray(np.ndarray):
    """The numbers; integers and bools that NumPy derives from them are plain again."""

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, out: Any = None, **options: Any) -> Any:
        plain = [value.view(np.ndarray) if isinstance(value, RoundedArray) else value for value in inputs]
        if method == "reduce" and ufunc is np.add and plain[0].dtype.kind == "f":
            axis = options.get("axis", 0)
            parts = [np.asarray(part) for part in np.moveaxis(plain[0], axis if isinstance(axis, int) else axis[0], 0)]
            total: Any = round_floats(parts[0])
            for part in parts[1:]:
                total = total + part
            return total
        result = getattr(ufunc, method)(*plain, **options)
        if not isinstance(result, np.ndarray) or result.dtype != np.float64:
            return result
        if ufunc in _EXACT:
            return result.view(RoundedArray)
        if ufunc is np.divide:
            halves = np.abs(np.frexp(np.asarray(plain[1], np.float64))[0]) == 0.5
            return _with_error(result, DIVISION, ~np.broadcast_to(halves, result.shape))
        return _with_error(result, 1.0)

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        result = super().__array_function__(function, types, args, options)
        if isinstance(result, list | tuple):
            return type(result)(map(_wrap, result))
        return _wrap(result)


def round_floats(value: Array) -> Array:
    """Numbers rounded to float32; other arrays as they are."""
    if isinstance(value, RoundedArray) or not isinstance(value, np.ndarray) or value.dtype.kind != "f":
        return value
    with np.errstate(all="ignore"):
        return value.astype(np.float32).astype(np.float64).view(RoundedArray)


def with_error(value: Array, ulp: float, absolute: Array | float) -> Array:
    """Numbers with a random error: of so many units in the last place, or absolute, whichever is larger."""
    with np.errstate(all="ignore"):
        plain = np.asarray(value)
        size = np.maximum(ulp * np.spacing(np.abs(plain).astype(np.float32)), absolute)
        return round_floats(plain + _draw(plain.shape) * size)


def _wrap(value: Any) -> Any:
    if isinstance(value, np.ndarray) and not isinstance(value, RoundedArray) and value.dtype == np.float64:
        return value.view(RoundedArray)
    return value


def _with_error(exact: Array, ulp: float, always: Array | None = None) -> Array:
    with np.errstate(all="ignore"):
        single = exact.astype(np.float32)
        result = single.astype(np.float64)
        inexact = result != exact
        if always is not None:
            inexact |= always & (result != 0.0)
        if inexact.any():
            moved = _draw(exact.shape)
            moved *= np.spacing(single)  # negative for negative numbers: the error has any sign
            moved *= ulp
            moved += exact
            result = np.where(inexact, moved.astype(np.float32).astype(np.float64), result)
        small = np.abs(result) < SMALLEST
        if small.any():
            draw = _draw(exact.shape)
            flushed = np.where((draw < -0.5) | (result == 0.0), np.copysign(0.0, draw - 0.25), result)
            result = np.where(small, flushed, result)
    return result.view(RoundedArray)


def _draw(shape: tuple[int, ...]) -> Array:
    return _generator.get().uniform(-1.0, 1.0, shape)
