"""Removes guards one by one: which fault follows, and on which back ends it shows.

A guard is needed where an input within the contract leaves the operation's domain and changes the result (`witness`).
Whether that shows depends on the driver: what a language leaves undefined may come out right by chance.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from sssgen.analyse.stress.guard_witness import Witness, only, sites, witness
from sssgen.analyse.stress.result_checks import non_finite
from sssgen.analyse.stress.stress_run import Machines
from sssgen.analyse.stress.subject import Specimen
from sssgen.passes.ranges.sites import Site
from sssgen.run.backends import Array, Backend
from sssgen.run.evaluate.deviation import errors
from sssgen.run.evaluate.evaluation import run as evaluated
from sssgen.support.diagnostics import SssgenError

CHANGED = 1e-3
"""A result that differs by more than this, relative to the larger of its size and 1, counts as another value."""


class Mutant(NamedTuple):
    """A technique with one of its guards removed."""

    specimen: Specimen
    site: Site
    witness: Witness | None
    """None: no input was found that needs the guard."""
    faults: dict[str, str]
    """Back end → the fault: `non-finite`, `another value`, or '' where none shows."""


def mutants(specimen: Specimen, machines: Machines) -> Iterable[Mutant]:
    """Each guard of a technique, removed."""
    for site in sites(specimen):
        if not site.proven:
            evidence = witness(specimen, site)
            faults = (
                {name: _fault(evidence, site, backend) for name, backend in machines.backends.items()}
                if evidence
                else {}
            )
            yield Mutant(specimen, site, evidence, faults)


def _fault(evidence: Witness, site: Site, backend: Backend) -> str:
    """The fault of the witness's inputs without the guard, compared with the result with it."""
    subject, change = evidence.specimen.subject, only(site.operation, site.place, "drop")
    try:
        right = evaluated(subject, evidence.failing_inputs, backend, "auto")
        actual = evaluated(subject, evidence.failing_inputs, backend, "auto", change)
    except SssgenError as error:
        return error.diagnostics[0].message
    values = [(actual[name], right[name]) for name in right if right[name].dtype.kind == "f"]
    if any(_non_finite(left) for left, _ in values):
        return "non-finite"
    return "another value" if any(_apart(left, other) > CHANGED for left, other in values) else ""


def _non_finite(value: Array) -> bool:
    return bool(non_finite(np.ascontiguousarray(value)).any())


def _apart(actual: Array, right: Array) -> float:
    return float(errors(np.atleast_1d(actual), np.atleast_1d(right)).max())
