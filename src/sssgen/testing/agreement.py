"""Compares a technique on one back end with the oracle, as one check."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.run.backends import Array, Backend, get
from sssgen.run.evaluate import evaluation as evaluate
from sssgen.run.evaluate.deviation import GOAL, deviation, errors, rounding_deviation
from sssgen.run.evaluate.evaluation import Inputs
from sssgen.run.evaluate.probes import Subject
from sssgen.support.diagnostics import failure
from sssgen.testing.outcome import Outcome


def check_tolerance(value: Any) -> float:
    """The value as a tolerance. Raises SssgenError if it is not a finite number from 0."""
    good = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value >= 0.0
    if not good:
        raise failure(f"{value!r} is not a tolerance", f"a number from 0; {GOAL:g} is usual")
    return float(value)


def against_oracle(
    subject: Subject,
    inputs: Inputs,
    backend: Backend,
    tolerance: float = GOAL,
    oracle: Mapping[str, Array] | None = None,
) -> tuple[dict[str, Array], Outcome]:
    """The back end's outputs, lanes first, and whether they agree with the oracle within `tolerance`.

    The deviation is relative above 1; ill-conditioned lanes are excluded as in `sssgen.run.evaluate.deviation`.
    `oracle` has the oracle's outputs if they are already computed. Raises SssgenError for a back end that refuses.
    """
    expected = evaluate.run(subject, inputs, get("numpy")) if oracle is None else oracle
    outputs = evaluate.run(subject, inputs, backend)
    apart = deviation(outputs, expected, lambda: rounding_deviation(subject, inputs, expected))
    excluded = f", {apart.excluded} ill-conditioned lanes by up to {apart.furthest:.2g}" if apart.excluded else ""
    if apart.largest <= tolerance:
        return outputs, Outcome("passed", f"{backend.name} deviates by {apart.largest:.2g} at most{excluded}")
    where = f"{apart.output}[{apart.lane}] is {apart.actual.tolist()}; float64 gives {apart.expected.tolist()}"
    return outputs, Outcome("failed", f"{backend.name} deviates by {apart.largest:.2g}, more than {tolerance:g}", where)


def against_numbers(oracle: Mapping[str, Array], expected: Mapping[str, Any], tolerance: float) -> Outcome:
    """Compares the oracle's outputs with given numbers. Raises SssgenError for an unknown output or another shape."""
    for name, numbers in expected.items():
        if name not in oracle:
            raise failure(f"there is no output '{name}'", f"outputs: {', '.join(oracle)}")
        actual = np.atleast_1d(oracle[name])
        try:
            right = np.broadcast_to(np.asarray(numbers, np.float64), actual.shape)
        except (ValueError, TypeError):
            shape = "×".join(map(str, actual.shape))
            raise failure(f"output '{name}' cannot be compared with these numbers", f"its shape is {shape}") from None
        apart = errors(actual, right)
        lane = int(np.argmax(apart))
        if not apart[lane] <= tolerance:
            where = f"{name}[{lane}] is {actual[lane].tolist()}, and {right[lane].tolist()} was given"
            return Outcome("failed", f"the oracle deviates by {apart[lane]:.2g}, more than {tolerance:g}", where)
    return Outcome("passed", f"{len(expected)} outputs as given")
