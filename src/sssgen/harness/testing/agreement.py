"""A technique on one back end against the oracle, as one check."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.harness.backends import Array, Backend, get
from sssgen.harness.evaluate import evaluation as evaluate
from sssgen.harness.evaluate.deviation import GOAL, blur, deviation, errors
from sssgen.harness.evaluate.evaluation import Inputs
from sssgen.harness.evaluate.probes import Subject
from sssgen.harness.testing.outcome import Outcome
from sssgen.support.diagnostics import failure


def check_tolerance(given: Any) -> float:
    """A tolerance. Raises SssgenError where it is none."""
    good = isinstance(given, int | float) and not isinstance(given, bool) and math.isfinite(given) and given >= 0.0
    if not good:
        raise failure(f"{given!r} is no tolerance", f"a number from 0; {GOAL:g} is usual")
    return float(given)


def against_oracle(
    subject: Subject,
    inputs: Inputs,
    backend: Backend,
    tolerance: float = GOAL,
    oracle: Mapping[str, Array] | None = None,
) -> tuple[dict[str, Array], Outcome]:
    """The back end's outputs, lanes first, and whether they are the oracle's within `tolerance`, relative above 1.

    Lanes that float32 itself must blur are excused as in `sssgen.harness.deviation`. `oracle` has its outputs, where
    they are known already. Raises SssgenError for a back end that refuses.
    """
    right = evaluate.run(subject, inputs, get("numpy")) if oracle is None else oracle
    found = evaluate.run(subject, inputs, backend)
    apart = deviation(found, right, lambda: blur(subject, inputs, right))
    excused = f", float32 blurs {apart.excused} more by up to {apart.furthest:.2g}" if apart.excused else ""
    if apart.largest <= tolerance:
        return found, Outcome("passed", f"{backend.name} deviates by {apart.largest:.2g} at most{excused}")
    where = f"{apart.output}[{apart.lane}] is {apart.got.tolist()}, and in float64 {apart.wanted.tolist()}"
    return found, Outcome("failed", f"{backend.name} deviates by {apart.largest:.2g}, more than {tolerance:g}", where)


def known(oracle: Mapping[str, Array], wanted: Mapping[str, Any], tolerance: float) -> Outcome:
    """Whether the oracle's outputs are numbers known from elsewhere. Raises SssgenError for what cannot be compared."""
    for name, given in wanted.items():
        if name not in oracle:
            raise failure(f"there is no output '{name}'", f"outputs: {', '.join(oracle)}")
        got = np.atleast_1d(oracle[name])
        try:
            right = np.broadcast_to(np.asarray(given, np.float64), got.shape)
        except (ValueError, TypeError):
            shape = "×".join(map(str, got.shape))
            raise failure(f"output '{name}' cannot be compared with what is given", f"numbers, {shape}") from None
        apart = errors(got, right)
        lane = int(np.argmax(apart))
        if not apart[lane] <= tolerance:
            where = f"{name}[{lane}] is {got[lane].tolist()}, and {right[lane].tolist()} was given"
            return Outcome("failed", f"the oracle deviates by {apart[lane]:.2g}, more than {tolerance:g}", where)
    return Outcome("passed", f"{len(wanted)} outputs as given")
