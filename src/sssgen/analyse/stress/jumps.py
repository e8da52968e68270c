"""Jumps: how far an output changes for a small step of one input, compared with the oracle's change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from sssgen.analyse.stress.contract_inputs import fixed_value
from sssgen.analyse.stress.result_checks import JUMP
from sssgen.analyse.stress.shrink import lane
from sssgen.analyse.stress.subject import Specimen
from sssgen.ir.types import Sampler, kind_of
from sssgen.run.backends import Array
from sssgen.run.evaluate.deviation import errors
from sssgen.run.evaluate.evaluation import Inputs, fit_inputs
from sssgen.run.evaluate.random_inputs import samples

LANES = 1024
STEP = 1e-4
"""The step of an input, relative to the larger of its size and 1."""
LONG_STEP = 1e-2
"""The same, where jumps of the formula are looked for."""
STEEPEST, PARTS, DIVISIONS = 16, 16, 6
"""How many of the longer steps are divided, into how many parts, and how often, to distinguish jumps from slopes."""


class ModelJump(NamedTuple):
    """A place where the formula itself jumps, in float64."""

    input: str
    output: str
    size: float
    """The jump for a step of nearly 0, relative to the larger of the output's size and 1."""
    inputs: Inputs
    """One lane, just before it."""


Run = Callable[[Inputs], dict[str, Array]]


def largest_jump(specimen: Specimen, run: Run, oracle: Run) -> tuple[float, str, Inputs | None]:
    """The largest step of an output on a back end where the oracle's own is small; of which input, and where.

    The oracle's change is its largest over the step and the steps before and after it: where float32 decides a little
    earlier or later than float64, the formula jumps and not the back end.
    """
    worst: tuple[float, str, Inputs | None] = (0.0, "", None)
    for name, (before, first, second, behind) in _walks(specimen):
        exact = [oracle(inputs) for inputs in (before, first, second, behind)]
        actual = [run(inputs) for inputs in (first, second)]
        for output, value in actual[0].items():
            if value.dtype.kind != "f" or not value.ndim:
                continue
            own = np.max([_apart(a[output], b[output]) for a, b in pairwise(exact)], axis=0)
            moved = np.where(own < 0.1 * JUMP, _apart(value, actual[1][output]), 0.0)
            worst_lane = int(np.argmax(moved))
            if moved[worst_lane] > worst[0]:
                worst = float(moved[worst_lane]), name, lane(first, worst_lane)
    return worst


def of_model(specimen: Specimen, run: Run) -> tuple[ModelJump, ...]:
    """The largest jump of the formula itself, as `run` computes it, along each input; empty for most.

    The steps with the largest changes are divided until the change of a slope, however steep, vanishes.
    """
    model_jumps = []
    for name, (_, first, second, _) in _walks(specimen, LONG_STEP):
        a, b = run(first), run(second)
        for output, value in a.items():
            if value.dtype.kind != "f" or not value.ndim:
                continue
            moved = _apart(value, b[output])
            worst = np.argsort(moved)[-STEEPEST:]
            if moved[worst[-1]] > JUMP:
                sizes, places = _divide(run, _lanes(first, worst), _lanes(second, worst), name, output)
                largest_lane = int(np.argmax(sizes))
                if sizes[largest_lane] > JUMP:
                    model_jumps.append(ModelJump(name, output, float(sizes[largest_lane]), lane(places, largest_lane)))
    return tuple(model_jumps)


def _divide(run: Run, first: Inputs, second: Inputs, name: str, output: str) -> tuple[Array, Inputs]:
    """The changes that remain after repeated division of the steps; each time the part that changes most is kept."""
    a, b = (inputs.values[name] for inputs in (first, second))
    count, share = a.shape[-1], np.linspace(0.0, 1.0, PARTS + 1)
    lanes = np.repeat(np.arange(count), PARTS + 1)
    for _ in range(DIVISIONS):
        along = a[..., None] + (b - a)[..., None] * share
        points = _with(_lanes(first, lanes), name, along.reshape(*along.shape[:-2], -1))
        value = run(points)[output].reshape(count, PARTS + 1, -1)
        changes = np.stack([_apart(value[:, part + 1], value[:, part]) for part in range(PARTS)])
        part = changes.argmax(axis=0)
        a, b = along[..., np.arange(count), part], along[..., np.arange(count), part + 1]
    return changes.max(axis=0), _with(first, name, a)


def _walks(specimen: Specimen, step: float = STEP) -> Iterator[tuple[str, tuple[Inputs, Inputs, Inputs, Inputs]]]:
    """For each float input four neighbouring values, a step apart, drawn from what scenes contain."""
    base = fit_inputs(specimen.subject, samples(specimen.subject, LANES))
    base = base._replace(values=base.values | {name: fixed_value(specimen, name) for name in specimen.settings})
    for name, param in specimen.subject.params.items():
        if isinstance(param.type, Sampler) or kind_of(param.type) != "float" or name in specimen.settings:
            continue
        value = base.values[name]
        along = step * np.random.default_rng(3).choice([-1.0, 1.0], value.shape)
        way = along * np.maximum(np.abs(value), 1.0)
        low, high = value.min(), value.max()
        before, first, second, behind = (
            _with(base, name, np.clip(value + count * way, low, high)) for count in (-1, 0, 1, 2)
        )
        yield name, (before, first, second, behind)


def _lanes(inputs: Inputs, chosen: Array) -> Inputs:
    values = {name: value[..., chosen] if value.shape[-1] > 1 else value for name, value in inputs.values.items()}
    return Inputs(values, inputs.textures, len(chosen))


def _with(inputs: Inputs, name: str, value: Array) -> Inputs:
    return inputs._replace(values={**inputs.values, name: value})


def _apart(a: Array, b: Array) -> Array:
    with np.errstate(invalid="ignore"):
        relative = errors(np.atleast_1d(a), np.atleast_1d(b))
    return np.where(np.isfinite(relative), relative, 0.0)
