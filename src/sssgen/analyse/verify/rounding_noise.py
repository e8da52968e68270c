"""How far the result of a lane may move because of rounding: what a deviation is compared with.

The function is run in float64, and many times with a random error of each operation (`rounded_floats`), and with random
numbers in variables that were not written, which have any number in a driver. No input moves: all drivers get the same
numbers. The errors of builtins are a few units in the last place, or, for another language or driver, those that the
table of builtins grants; derivatives of another driver may be those of one row or column of a quad.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from sssgen.analyse.verify.branch_edges import Edges, branch_distance, edges_of, on_side
from sssgen.analyse.verify.branch_outcomes import Outcomes
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.lane_values import DTYPES, Value, build_value
from sssgen.analyse.verify.plain_inputs import select_lanes
from sssgen.analyse.verify.rounded_floats import draw, errors_of_lanes, round_floats, seed_errors, with_error
from sssgen.ir.intrinsics.table import LARGEST
from sssgen.ir.nodes import Intrinsic
from sssgen.ir.types import Type
from sssgen.run.backends import Array
from sssgen.run.backends.call_program import grid
from sssgen.run.evaluate.deviation import GOAL, MARGIN, errors
from sssgen.targets import numpy_runtime as rt

CHUNK = 8192
"""How many lanes are run together."""
EDGE_DRAWS = 8
"""How many runs measure how far the operands of comparisons move."""


UNDETERMINED = 0.5
"""Where rounding moves a result by more than this, relative to its size, it may also become infinite or NaN: in the
direction of a vector that is only rounding errors."""


NEARLY_LARGEST = 2.0**-8 * LARGEST


class RoundedRun(Run):
    """A run with a random error of each operation; `granted` adds those that the table grants to builtins."""

    granted = False
    edges: Edges | None = None
    """The comparisons that may have any outcome."""

    def number(self, value: Value) -> Value:
        return round_floats(value)

    @contextmanager
    def of_lanes(self, chosen: Array) -> Iterator[None]:
        edges = self.edges
        self.edges = edges.of_lanes(chosen) if edges is not None else None
        try:
            with errors_of_lanes(chosen):
                yield
        finally:
            self.edges = edges

    def compared(self, node: object, comparison: int, left: Value, right: Value) -> tuple[Value, Value]:
        left, right = super().compared(node, comparison, left, right)
        if self.edges is None or np.asarray(left).dtype.kind != "f":
            return left, right
        distance = self.edges.moved(node, comparison, left - right)
        return distance, np.zeros_like(distance)

    def on_side(self, expr: Intrinsic, args: list[Value], result: Value) -> Value:
        result = super().on_side(expr, args, result)
        distance = branch_distance(expr.name, args) if self.edges is not None else None
        if self.edges is None or distance is None:
            return result
        return on_side(expr.name, args, self.edges.moved(expr, 0, distance))

    def finite(self, value: Value) -> Value:
        self.require_size(np.asarray(value), NEARLY_LARGEST)  # in another order, its terms may overflow
        return value

    def unwritten(self, type_: Type) -> Value:
        def numbers(shape: tuple[int, ...], kind: str) -> Array:
            values = draw((*shape, self.lanes))
            magnitudes = np.exp2(24.0 * draw(values.shape))
            return round_floats(magnitudes * values) if kind == "float" else (2.0 * (values > 0.0)).astype(DTYPES[kind])

        return build_value(type_, numbers)

    def inexact(self, row: Any, args: list[Value], result: Value) -> Value:
        if row.ulp == 0.0 or row.kind == "derivative" or any(np.asarray(arg).dtype == bool for arg in args):
            return result
        if self.granted and row.size is not None:  # other formulas are allowed, whose terms cancel: x + (y - x) * a
            size = np.abs(np.asarray(row.size(rt, *[np.asarray(arg) for arg in args]))).astype(np.float32)
            moved = with_error(result, 0.0, row.ulp * np.spacing(size))
            if branch_distance(row.name, args) is None:
                return moved
            plain = np.asarray(result)  # what a branch sets to 0 is 0 in every driver
            return np.where((plain == 0.0).all(axis=0) if plain.ndim > 1 else plain == 0.0, 0.0, moved)
        if row.kind == "alu" and row.ulp <= 4.0:
            return result
        if not self.granted:
            return result if row.kind == "fetch" else with_error(result, min(row.ulp, 4.0), 0.0)
        absolute: Any = row.absolute
        if row.name in ("sin", "cos", "tan"):
            absolute = np.maximum(absolute, 2.0**-22 * np.abs(np.asarray(args[0])))
        return with_error(result, row.ulp, absolute)

    def read_from(self, row: Any, args: list[Value]) -> list[Value]:
        if row.kind != "fetch" or not self.granted:
            return args
        return [
            with_error(arg, 2.0, 2.0**-12) if isinstance(arg, np.ndarray) and arg.dtype.kind == "f" else arg
            for arg in args
        ]


class GrantedRun(RoundedRun):
    """A run with the errors that other drivers may make."""

    granted = True

    def inexact(self, row: Any, args: list[Value], result: Value) -> Value:
        if row.kind != "derivative" or np.shape(result)[-1:] != (self.lanes,):
            return super().inexact(row, args, result)
        if row.axis:
            return round_floats(self.of_a_quad(np.asarray(result), row.axis))
        along = zip((rt.dFdx, rt.dFdy), "xy", strict=True)
        changes = [np.abs(self.of_a_quad(np.asarray(change(args[0])), axis)) for change, axis in along]
        return round_floats(changes[0] + changes[1])

    def of_a_quad(self, derivatives: Array, axis: str) -> Array:
        """Derivatives as another device may have them: of one row (column) of a quad of pixels in both."""
        chance = float(draw(()))
        if chance < -0.5:
            return derivatives
        shape = grid(self.lanes)
        image = derivatives.reshape(*derivatives.shape[:-1], shape.rows, shape.width)
        across = {"x": -2, "y": -1}[axis]
        count = image.shape[across]
        places = np.minimum(np.arange(count) // 2 * 2 + int(chance > 0.25), count - 1)
        taken: Array = np.take(image, places, across).reshape(derivatives.shape)
        return taken


def is_explained(error: Array, limit: Array) -> Array:
    """Whether rounding, which moves a result by `limit`, explains a deviation; or whether there is none."""
    result: Array = (error <= GOAL) | (error <= MARGIN * limit) | (np.isinf(error) & (limit > UNDETERMINED))
    return result


def noise(
    program: Program, keys: Sequence[str], values: Mapping[str, Array], textures: Mapping[str, Any], lanes: Array,
    draws: int, granted: bool, seed: int = 0, at_edges: bool = False,
) -> list[Array]:  # fmt: skip
    """For the result of each function the largest movement in these lanes, relative as that of `errors`.

    It is infinite where rounding makes an operation undefined. With `at_edges`, comparisons that rounding decides have
    any outcome (`branch_edges`), and the movement is 0 in functions without such a comparison.
    """
    kind = GrantedRun if granted else RoundedRun
    chosen = dict(values) if program.neighbours else select_lanes(dict(values), lanes)
    count = next(value.shape[-1] for value in chosen.values())
    repeats = 1 if program.neighbours else max(1, min(draws, CHUNK // max(count, 1)))
    repeated = {name: np.tile(value, repeats) for name, value in chosen.items()}
    results = []
    for key in keys:
        exact, _ = result(Run, program, key, chosen, textures)
        largest = np.zeros(count)
        edges = find_edges(program, key, chosen, textures, kind, seed) if at_edges else None
        if edges is not None:
            edges = edges.of_lanes(np.tile(np.arange(count), repeats))
        elif at_edges:
            results.append(largest[lanes] if program.neighbours else largest)
            continue
        if granted:  # compilers may compute constants in higher precision
            other = Run(program, count, {**textures, **chosen}, exact_literals=True)
            largest = _apart(_first(other.result(key, {**textures, **chosen})), exact)
        expected = np.concatenate([exact] * repeats)
        for number in range(-(-draws // repeats)):
            with seed_errors(1000 * seed + number):
                actual, undefined = result(kind, program, key, repeated, textures, edges)
            moved = np.where(undefined, np.inf, _apart(actual, expected)).reshape(repeats, count).max(axis=0)
            largest = np.maximum(largest, moved)
        results.append(largest[lanes] if program.neighbours else largest)
    return results


def find_edges(
    program: Program, key: str, values: Mapping[str, Array], textures: Mapping[str, Any], kind: type[RoundedRun],
    seed: int,
) -> Edges | None:  # fmt: skip
    """The comparisons of a function that rounding decides in some lane."""
    everything = {**textures, **values}
    lanes = next(value.shape[-1] for value in values.values())

    def outcomes(kind: type[Run]) -> Outcomes:
        outcomes = Outcomes(lanes)
        kind(program, lanes, everything, outcomes).result(key, everything)
        return outcomes

    rounded = []
    for number in range(EDGE_DRAWS):
        with seed_errors(1000 * seed + number):
            rounded.append(outcomes(kind))
    return edges_of(outcomes(Run), rounded)


def result(
    kind: type[Run], program: Program, key: str, values: Mapping[str, Array], textures: Mapping[str, Any],
    edges: Edges | None = None,
) -> tuple[Array, Array]:  # fmt: skip
    """The result of a function, lanes first, and the lanes in which it is undefined."""
    lanes = next(value.shape[-1] for value in values.values())
    run = kind(program, lanes, {**textures, **values})
    if isinstance(run, RoundedRun):
        run.edges = edges
    value = run.result(key, {**textures, **values})
    return _first(value), run.undefined | run.endless


def _apart(left: Array, right: Array) -> Array:
    """How far two results are apart, relative to the smaller one, as the result in question may be either."""
    return np.maximum(errors(left, right), errors(right, left))


def _first(value: Array) -> Array:
    """Lanes first."""
    return np.moveaxis(np.asarray(value), -1, 0)
