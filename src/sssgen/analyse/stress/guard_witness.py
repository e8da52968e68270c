"""Inputs that show why a guard is needed: with NaN in place of what the guard would change, the result is NaN.

A shading language may compute anything outside a builtin's domain; NaN represents all of it. A guard that no input of
the stress test reaches is reported as unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from sssgen.analyse.stress import boundaries
from sssgen.analyse.stress import dangerous_inputs as dangerous
from sssgen.analyse.stress.contract_inputs import sample_inputs
from sssgen.analyse.stress.result_checks import non_finite
from sssgen.analyse.stress.shrink import lane, line, shrink
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import OUTSIDE, RANDOM, Trial
from sssgen.ir.formats import FLOAT32
from sssgen.passes.ranges.sites import Site
from sssgen.pipeline.programs import library_sites
from sssgen.run.backends import Array, get
from sssgen.run.evaluate.evaluation import Inputs
from sssgen.run.evaluate.evaluation import run as evaluated

SAMPLES = 20_000
"""Random inputs, tried after the rows of the table and the boundary values."""
MAX_FAILING_LANES = 64
"""Inputs of a trial that a witness keeps."""


class Witness(NamedTuple):
    """An input with which an unguarded operation leaves its domain, and the result with it."""

    trial: str
    inputs: Inputs
    """The simplest one found."""
    output: str
    command: str
    """The `sssgen eval` line that computes it without guards."""
    specimen: Specimen
    """The technique with the functions that the trial bound to its slots."""
    failing_inputs: Inputs
    """Some of the inputs of the trial."""


def sites(specimen: Specimen) -> list[Site]:
    """The operations with a domain of a technique, in the order of the source."""
    all_sites = library_sites(specimen.subject.module, specimen.subject.called, specimen.subject.chained)
    return sorted(all_sites, key=lambda site: site.node.span)


def witness(specimen: Specimen, site: Site, seed: int = 0) -> Witness | None:
    """The simplest input found that needs the guard of this operation, on NumPy in float32; None if none was found."""
    poison = only(site.operation, site.place, "poison")
    for trial in _trials(specimen, seed):
        lanes_by_output = _failing_lanes(trial.specimen, trial.inputs, poison)
        for output, lanes in lanes_by_output.items():
            if lanes.any():
                start = lane(trial.inputs, int(np.argmax(lanes)))
                small = shrink(trial.specimen, start, partial(_fails, trial.specimen, poison, output))
                command = line(trial.specimen, small, "numpy-f32").replace(
                    "sssgen eval", "sssgen eval --guards none", 1
                )
                return Witness(trial.name, small, output, command, trial.specimen, _failing_inputs(trial.inputs, lanes))
    return None


def _failing_inputs(inputs: Inputs, lanes: Array) -> Inputs:
    """The first of the lanes that fail."""
    failing = np.flatnonzero(lanes)[:MAX_FAILING_LANES]
    values = {name: value if value.shape[-1] == 1 else value[..., failing] for name, value in inputs.values.items()}
    return Inputs(values, inputs.textures, len(failing))


def _fails(specimen: Specimen, change: Callable[[Site], str], output: str, inputs: Inputs) -> Array:
    return _failing_lanes(specimen, inputs, change)[output]


@cache
def only(operation: str, place: str, change: str) -> Callable[[Site], str]:
    """What to do with each guard: `change` for the one named, `keep` for all others."""
    return lambda site: change if (site.operation, site.place) == (operation, place) else "keep"


def _trials(specimen: Specimen, seed: int) -> Iterator[Trial]:
    """The table's rows and the boundary values, then random inputs."""
    rows = dangerous.trials(specimen) if specimen.subject.chained else ()
    every = [*rows, *boundaries.trials(specimen, seed)]
    yield from (trial for trial in every if trial.counts or trial.name == OUTSIDE)
    rng = np.random.default_rng([seed, 4])
    yield Trial(RANDOM, specimen, sample_inputs(specimen, SAMPLES, rng, FLOAT32))


def _failing_lanes(specimen: Specimen, inputs: Inputs, change: Callable[[Site], str]) -> dict[str, Array]:
    """The lanes of each output that are NaN or infinite with the change, but finite with every guard."""
    numpy = get("numpy-f32")
    with np.errstate(all="ignore"):
        changed = evaluated(specimen.subject, inputs, numpy, "auto", change)
        lanes_by_output = {
            name: _lanes(value, inputs.lanes) for name, value in changed.items() if value.dtype.kind == "f"
        }
        if any(bad.any() for bad in lanes_by_output.values()):
            guarded = evaluated(specimen.subject, inputs, numpy, "auto")
            lanes_by_output = {
                name: bad & ~_lanes(guarded[name], inputs.lanes) for name, bad in lanes_by_output.items()
            }
    return lanes_by_output


def _lanes(value: Array, count: int) -> Array:
    value = np.broadcast_to(value, (count, *value.shape[1:])) if value.ndim else np.broadcast_to(value, (count,))
    bad: Array = np.asarray(non_finite(np.ascontiguousarray(value)).reshape(count, -1).any(axis=1))
    return bad
