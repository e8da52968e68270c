"""The parity of the builtins: every row of the intrinsic table on a back end, against NumPy in float64.

    figures = measure(backends.get("gl"), cases(2000))
    figures["exp"].ulp, figures["exp"].right

The oracle has the same float32 arguments. An error is counted in ulp: units in the last place, in float32, of the
result's size. The size of a vector or matrix is that of its largest component, for a rounding error in one component
of `normalize` or `cross` is as large as those of the others. Where terms of a sum may cancel, as in `dot`, the size is
that of the terms: the row's `size` says so. A row with `ulp=0` and every int and bool is compared exactly, but for the
sign of zero.

Not measured is what no language defines: arguments outside of the row's `inside`, and results too large for float32.
A target may flush denormals to zero. So where an argument or a result is below `TINY`, each component may be that for
arguments whose denormals are zero, or be off by `TINY`. Such lanes are in no figure of errors; the wrong ones count.
"""

from __future__ import annotations

import keyword
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from qualification.parity_inputs import MAX, MIN, TEXTURE_LANES, Case, cases, evaluated, textures, widened
from sssgen.ir import signatures
from sssgen.ir.intrinsics import Builtin
from sssgen.ir.nodes import Intrinsic
from sssgen.ir.types import Type, Vector, kind_of, spell
from sssgen.ir.walk import all_expressions
from sssgen.lang.loader import load_text
from sssgen.lang.polyfills import polyfill
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import DRIVERS, Array, Backend, Call, Text
from sssgen.run.backends.call_program import grid
from sssgen.targets import numpy_runtime as runtime

__all__ = ["BACKENDS", "FULL", "Case", "Figure", "cases", "measure", "oracle", "run", "supported"]

BACKENDS = (*DRIVERS, "numpy-f32")
"""The back ends that are measured: all that compute in float32."""

FULL = 4000
"""Lanes to an overload in a full measurement."""

TINY = 2.0**-120
"""Smaller numbers are denormals, or their intermediate results may be."""

BATCH = 100
"""Overloads to a program: more of them make drivers slow."""

TEXTURES = 12
"""Textures to a program: drivers take 16."""


class Figure(NamedTuple):
    """The measurement of one builtin on one back end, over all overloads."""

    lanes: int
    ulp: float
    """The largest error; 0 or infinity where results are compared exactly."""
    most: float
    """99.9 of 100 lanes are within this many ulp."""
    absolute: float
    """The largest absolute error of the lanes that the row's `ulp` does not cover; 0 where it covers all."""
    wrong: int
    """Lanes outside of both limits."""
    flushed: int
    """Lanes with denormals, which are not in the figures above, that have no right result."""
    at: str
    """The overload and the arguments of the largest error, the result and the expected one."""

    @property
    def right(self) -> bool:
        return not self.wrong and not self.flushed


class _Lanes(NamedTuple):
    """The lanes of one overload."""

    ulp: Array
    absolute: Array
    measured: Array
    """Which count: no number is below `TINY`, and float32 holds the result."""
    flushed: Array
    """Of those with a number below `TINY`, which are wrong."""


def measure(backend: Backend, chosen: Sequence[Case]) -> dict[str, Figure]:
    """A figure for each builtin that the back end's target has."""
    supported_cases = [case for case in chosen if supported(case, backend)]
    results_by_name: dict[str, list[tuple[Case, Array]]] = {}
    for case, actual in zip(supported_cases, run(backend, supported_cases), strict=True):
        results_by_name.setdefault(case.name, []).append((case, actual))
    return {name: _figure(results) for name, results in results_by_name.items()}


def supported(case: Case, backend: Backend) -> bool:
    """Whether a back end's target has the overload, and the back end its textures."""
    types = [spell(type_) for type_ in (*case.params, case.result)]
    has_types = all(name in backend.target.types and name not in backend.unsupported_types for name in types)
    return has_types and _written(case.name, case.params, backend.target.dialect)


@cache
def _written(name: str, params: tuple[Type, ...], dialect: str) -> bool:
    """Whether a dialect has a builtin, or all that its polyfill calls."""
    if signatures.text(name, dialect, params):
        return True
    try:
        written = polyfill(name, params)
    except KeyError:
        return False
    return all(
        _written(expr.name, tuple([arg.type for arg in expr.args]), dialect)
        for function in written.functions
        for expr in all_expressions(function.body or ())
        if isinstance(expr, Intrinsic)
    )


def run(backend: Backend, chosen: Sequence[Case]) -> list[Array]:
    """The results of the cases, by programs of functions `case_N`."""
    results: list[Array | None] = [None] * len(chosen)
    for is_small in (True, False):
        numbers = [number for number, case in enumerate(chosen) if (case.lanes == TEXTURE_LANES) == is_small]
        for batch in _batches(numbers, chosen):
            for number, actual in zip(batch, _program(backend, [chosen[number] for number in batch]), strict=True):
                results[number] = actual
    return [actual for actual in results if actual is not None]


def _batches(numbers: Sequence[int], chosen: Sequence[Case]) -> Iterator[list[int]]:
    """The numbers of cases, as many as go into a program."""
    batch: list[int] = []
    names: set[str] = set()
    for number in numbers:
        named = {arg for arg in chosen[number].args if isinstance(arg, str)}
        if len(batch) == BATCH or len(names | named) > TEXTURES:
            yield batch
            batch, names = [], set()
        batch.append(number)
        names |= named
    if batch:
        yield batch


def _program(backend: Backend, chosen: Sequence[Case]) -> list[Array]:
    lines, calls = [], []
    for number, case in enumerate(chosen):
        passed_in = [index for index in range(len(case.params)) if index not in case.constant]
        params = ", ".join(f"{spell(case.params[index])} p{index}" for index in passed_in)
        args = [
            f"p{index}" if index in passed_in else _literal(case.params[index], case.args[index])
            for index in range(len(case.params))
        ]
        lines.append(f"{spell(case.result)} case_{number}({params}) {{ return {case.name}({', '.join(args)}); }}")
        passed = (
            tuple(case.params[index] for index in passed_in),
            case.result,
            tuple(case.args[index] for index in passed_in),
        )
        calls.append(Call(f"case_{number}", *passed))
    compiled = transpile(load_text("\n".join(lines), "intrinsics/cases"), backend.target.name, "cases")
    text = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    renames = compiled.reflection["renames"]
    calls = [call._replace(function=renames.get(call.function, call.function)) for call in calls]
    return backend.run(Text(text), calls, textures())


def _literal(type_: Type, value: Array) -> str:
    """A constant argument, an int or a vector of them, as the program has it."""
    numbers = ", ".join(str(part) for part in np.atleast_2d(value)[:, 0])
    return f"{spell(type_)}({numbers})" if isinstance(type_, Vector) else numbers


def oracle(case: Case, flush: bool = False) -> Array:
    """NumPy's result in float64; with `flush` for arguments whose denormals are replaced by zero."""
    args: list[Any] = [textures()[arg] if isinstance(arg, str) else arg for arg in widened(case.args)]
    if flush:
        args = list(_flushed(tuple(args)))
    shape = grid(case.lanes)
    with runtime.precision("float64"), runtime.grid(shape.rows, shape.width):
        return np.asarray(getattr(runtime, case.name + "_" * keyword.iskeyword(case.name))(*args))


def _flushed(args: tuple[Any, ...]) -> tuple[Any, ...]:
    """Arguments with zeros of the same sign for denormals."""
    return tuple(np.where(np.abs(arg) < MIN, np.copysign(0.0, arg), arg) if _floats(arg) else arg for arg in args)


def _floats(arg: object) -> bool:
    return isinstance(arg, np.ndarray) and arg.dtype.kind == "f"


def _figure(results: Sequence[tuple[Case, Array]]) -> Figure:
    row = results[0][0].row
    lanes_of_cases = [lanes_of(case, actual) for case, actual in results]
    ulp = np.concatenate([lanes.ulp[lanes.measured] for lanes in lanes_of_cases])
    absolute = np.concatenate([lanes.absolute[lanes.measured] for lanes in lanes_of_cases])
    beyond = ulp > row.ulp
    flushed = sum(int(lanes.flushed.sum()) for lanes in lanes_of_cases)
    at = ""
    worst = [float(np.max(_badness(row, lanes), initial=0.0)) for lanes in lanes_of_cases]
    if max(worst) > 0.0:
        worst_case = int(np.argmax(worst))
        at = _described(*results[worst_case], int(np.argmax(_badness(row, lanes_of_cases[worst_case]))))
    return Figure(
        lanes=len(ulp),
        ulp=float(ulp.max(initial=0.0)),
        most=float(np.quantile(ulp, 0.999, method="lower")) if len(ulp) else 0.0,
        absolute=float(absolute[beyond].max(initial=0.0)),
        wrong=int((beyond & ~(absolute <= row.absolute)).sum()),
        flushed=flushed,
        at=at,
    )


def _badness(row: Builtin, lanes: _Lanes) -> Array:
    """The sort key of lanes: first those beyond all limits, then by error."""
    wrong = (lanes.ulp > row.ulp) & ~(lanes.absolute <= row.absolute)
    size = np.minimum(np.nan_to_num(lanes.ulp, nan=np.inf, posinf=1e30), 1e30)
    return np.where(lanes.measured, size + 1e30 * wrong, 1e29 * lanes.flushed)


def lanes_of(case: Case, actual: Array) -> _Lanes:
    """The errors of one overload, lane by lane."""
    exact = kind_of(case.result) != "float"
    actual = np.broadcast_to(actual, (*actual.shape[:-1], case.lanes))
    expected: Array = np.broadcast_to(oracle(case), actual.shape)
    tiny = _any_lane(expected, case.lanes)
    for arg in case.args:
        tiny |= _any_lane(arg, case.lanes)
    error = _error(actual, expected, exact)
    ulp, absolute = _in_ulp(case, error, expected, exact)
    wrong = np.zeros(case.lanes, bool)
    if tiny.any():
        flushed = np.broadcast_to(oracle(case, flush=True), actual.shape)
        least, most = _in_ulp(case, np.minimum(error, _error(actual, flushed, exact)), expected, exact)
        wrong = tiny & (least > case.row.ulp) & ~(most <= max(case.row.absolute, 0.0 if exact else TINY))
        wrong &= _each_lane(np.isfinite(flushed), case.lanes)
        if case.row.inside:
            wrong &= evaluated(case.row.inside, _flushed(widened(case.args)))
    measured = ~tiny
    if not exact:
        with np.errstate(over="ignore"):
            measured &= _each_lane(np.isfinite(expected.astype(np.float32)), case.lanes)
    return _Lanes(ulp, absolute, measured, wrong)


def _error(actual: Array, expected: Array, exact: bool) -> Array:
    """The absolute error of each component: 0 or infinity for what is compared exactly."""
    if exact:
        return np.where(actual == expected.astype(actual.dtype), 0.0, np.inf)
    with np.errstate(all="ignore"):
        apart = np.where(actual == expected, 0.0, np.abs(actual.astype(np.float64) - expected))
    return np.nan_to_num(apart, nan=np.inf, posinf=np.inf)


def _in_ulp(case: Case, error: Array, expected: Array, exact: bool) -> tuple[Array, Array]:
    """(in ulp, absolute), lane by lane, of components' errors."""
    error = error.reshape(-1, case.lanes).max(axis=0)
    if exact or case.row.ulp == 0.0:
        return np.where(error > 0.0, np.inf, 0.0), error
    if case.row.size:
        size = evaluated(case.row.size, widened(case.args))
    else:
        size = np.abs(expected).reshape(-1, case.lanes).max(axis=0)
    with np.errstate(all="ignore"):
        unit = np.spacing(np.minimum(np.nan_to_num(size), MAX).astype(np.float32))
        return np.where(error == 0.0, 0.0, error / unit), error


def _any_lane(value: Any, lanes: int) -> Array:
    """Lanes in which a float is below `TINY`."""
    if not _floats(value):
        return np.zeros(lanes, bool)
    size = np.abs(value.astype(np.float64)).reshape(-1, lanes)
    return np.asarray(((size > 0.0) & (size < TINY)).any(axis=0))


def _each_lane(good: Array, lanes: int) -> Array:
    """Lanes that are good in all components."""
    return np.asarray(good.reshape(-1, lanes).all(axis=0))


def _described(case: Case, actual: Array, lane: int) -> str:
    args = ", ".join(arg if isinstance(arg, str) else str(arg[..., lane].tolist()) for arg in case.args)
    expected = np.broadcast_to(oracle(case), actual.shape)[..., lane]
    return f"{case.title} at {args}: {actual[..., lane].tolist()} is not {expected.tolist()}"
