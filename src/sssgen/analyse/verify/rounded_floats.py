"""Arrays of float32 numbers with which every operation makes a random error of the size that float32 allows.

A result of several runs with such numbers shows how far two correct implementations in float32 may differ in a lane,
whatever the function: where rounding decides a branch, where nearly equal terms are subtracted, in a hash. A result
that float32 represents exactly has no error, so that whole numbers stay whole; a quotient always has one, unless the
divisor is a power of two, since drivers multiply by a reciprocal. Subnormal results may become 0, and a 0 has any sign.

The numbers are stored in float64, rounded to float32. The functions of the NumPy runtime take them like other arrays.
Who computes with them silences NumPy's warnings about overflow.
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


class _Errors:
    """The errors of one run, as a driver makes them: the same for the same result in the same lane.

    In a sum over a hundred samples of one hash, errors that differ from sample to sample would cancel. Numbers are
    mixed as in splitmix64 (Steele, Lea, Flood 2014, Fast splittable pseudorandom number generators).
    """

    def __init__(self, seed: int) -> None:
        self.generator = np.random.default_rng(seed)
        self.salts = np.zeros(0, np.uint64)
        """A number for each lane: each is another driver."""

    def salts_of(self, lanes: int) -> Array:
        """Those of a value; one that is the same in all lanes has one."""
        if not len(self.salts) or lanes not in (1, len(self.salts)):
            self.salts = self.generator.integers(0, 2**63, lanes, np.uint64)
        return self.salts if lanes > 1 else self.salts[:1]

    def of(self, exact: Array) -> Array:
        """A number in [-1, 1] for each result."""
        mixed = np.ascontiguousarray(exact, np.float64).view(np.uint64) ^ self.salts_of(np.shape(exact)[-1])
        mixed *= _FIRST
        mixed ^= mixed >> _HALF
        mixed *= _SECOND
        return (mixed >> _HALF).astype(np.float64) * 2.0**-31 - 1.0

    def share(self, lanes: int) -> Array:
        """The share of the granted error of builtins that each driver has: all in half of them, else down to 2^-15."""
        salts = self.salts_of(lanes)
        return np.exp2(-((salts & _FOUR_BITS) * ((salts >> _FOUR) & _ONE)).astype(np.float64))


_FIRST, _SECOND, _HALF = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB), np.uint64(32)
_FOUR_BITS, _FOUR, _ONE = np.uint64(15), np.uint64(4), np.uint64(1)
_errors: ContextVar[_Errors] = ContextVar("errors")


@contextmanager
def seed_errors(seed: int) -> Iterator[None]:
    """The errors that follow depend on this seed."""
    token = _errors.set(_Errors(seed))
    try:
        yield
    finally:
        _errors.reset(token)


@contextmanager
def errors_of_lanes(chosen: Array) -> Iterator[None]:
    """The errors are those of the chosen lanes, which are numbers."""
    errors = _errors.get()
    salts = errors.salts
    if len(salts):
        errors.salts = salts[chosen]
    try:
        yield
    finally:
        errors.salts = salts


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
    return value.astype(np.float32).astype(np.float64).view(RoundedArray)


def with_error(value: Array, ulp: float, absolute: Array | float) -> Array:
    """Numbers with an error of at most so many units in the last place, or absolute, whichever is larger."""
    plain = np.asarray(value)
    size = np.maximum(ulp * np.spacing(np.abs(plain).astype(np.float32)), absolute)
    errors = _errors.get()
    return round_floats(plain + errors.of(plain) * errors.share(np.shape(plain)[-1]) * size)


def _wrap(value: Any) -> Any:
    if isinstance(value, np.ndarray) and not isinstance(value, RoundedArray) and value.dtype == np.float64:
        return value.view(RoundedArray)
    return value


def _with_error(exact: Array, ulp: float, always: Array | None = None) -> Array:
    single = exact.astype(np.float32)
    result = single.astype(np.float64)
    inexact = result != exact
    if always is not None:
        inexact |= always & (result != 0.0)
    moved = _errors.get().of(exact)
    moved *= np.spacing(single)  # negative for negative numbers: the error has any sign
    if ulp != 1.0:
        moved *= ulp
    moved += exact
    np.copyto(result, moved.astype(np.float32), where=inexact)
    small = np.abs(result) < SMALLEST
    if small.any():
        chance = _errors.get().of(exact)
        flushed = np.where((chance < -0.5) | (result == 0.0), np.copysign(0.0, chance - 0.25), result)
        result = np.where(small, flushed, result)
    return result.view(RoundedArray)


def draw(shape: tuple[int, ...]) -> Array:
    """Random numbers in [-1, 1]."""
    return _errors.get().generator.uniform(-1.0, 1.0, shape)
