"""How far the result of a lane may move because of rounding: what a deviation is compared with.

The function is run in float64, and many times with a random error of each operation (`rounded_floats`). No input moves:
all drivers get the same numbers. The errors of builtins are a few units in the last place, or, for another language
or driver, those that the table of builtins grants.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.evaluate.deviation import errors
from sssgen.harness.verify.lane_interpreter import GrantedRun, Program, RoundedRun, Run
from sssgen.harness.verify.plain_inputs import taken
from sssgen.harness.verify.rounded_floats import seeded

CHUNK = 8192
"""How many lanes are run together."""


def noise(
    program: Program, keys: Sequence[str], values: Mapping[str, Array], textures: Mapping[str, Any], lanes: Array,
    draws: int, granted: bool, seed: int = 0,
) -> list[Array]:  # fmt: skip
    """For the result of each function the largest movement in these lanes, relative as that of `errors`.

    It is infinite where rounding makes an operation undefined.
    """
    chosen = dict(values) if program.neighbours else taken(dict(values), lanes)
    count = next(value.shape[-1] for value in chosen.values())
    repeats = 1 if program.neighbours else max(1, min(draws, CHUNK // max(count, 1)))
    repeated = {name: np.tile(value, repeats) for name, value in chosen.items()}
    results = []
    for key in keys:
        exact, _ = result(Run, program, key, chosen, textures)
        largest = np.zeros(count)
        if granted:  # compilers may compute constants in higher precision
            other = Run(program, count, {**textures, **chosen}, exact_literals=True)
            largest = _apart(_first(other.result(key, {**textures, **chosen})), exact)
        wanted = np.concatenate([exact] * repeats)
        for draw in range(-(-draws // repeats)):
            with seeded(1000 * seed + draw):
                got, undefined = result(GrantedRun if granted else RoundedRun, program, key, repeated, textures)
            moved = np.where(undefined, np.inf, _apart(got, wanted)).reshape(repeats, count).max(axis=0)
            largest = np.maximum(largest, moved)
        results.append(largest[lanes] if program.neighbours else largest)
    return results


def result(
    kind: type[Run], program: Program, key: str, values: Mapping[str, Array], textures: Mapping[str, Any]
) -> tuple[Array, Array]:
    """The result of a function, lanes first, and the lanes in which it is undefined."""
    lanes = next(value.shape[-1] for value in values.values())
    run = kind(program, lanes, {**textures, **values})
    value = run.result(key, {**textures, **values})
    return _first(value), run.undefined | run.endless


def _apart(one: Array, other: Array) -> Array:
    """How far two results are apart, relative to the smaller one, as the result in question may be either."""
    return np.maximum(errors(one, other), errors(other, one))


def _first(value: Array) -> Array:
    """Lanes first."""
    return np.moveaxis(np.asarray(value), -1, 0)
