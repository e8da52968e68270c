"""The parity of the techniques: each of the library on each back end, on random inputs, against NumPy in float64.

    for case in cases():
        measure(case, backends.get("gl"), lanes=10_000)

A technique that may deviate by more than `deviation.GOAL` declares the reason and its limits: `deviation` and
`deviation_bounds` in its file.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from sssgen.material import library, slots
from sssgen.run.backends import DRIVERS, Array, Backend, get
from sssgen.run.evaluate.deviation import GOAL, Deviation, deviation, rounding_deviation
from sssgen.run.evaluate.evaluation import Inputs, fit_inputs, run
from sssgen.run.evaluate.probes import Subject, subject
from sssgen.run.evaluate.random_inputs import samples

BACKENDS = DRIVERS
LANES, SEED = 10_000, 1
BOUND_LANES = 2_000
"""For a technique with other functions in its slots, where the technique itself has had its `LANES`."""

SHARE = 0.005
"""The share of lanes that may be excluded for any technique: a few lie exactly where a decision changes."""


class Case(NamedTuple):
    """A technique, and what is bound to its slots (slot, function) where that is not the first that fits."""

    technique: str
    bind: tuple[tuple[str, str], ...] = ()


DRIVER_OF = {"tsl": "browser", "tsl-webgl2": "browser"}
"""Back end → the one whose driver computes its results, and whose bounds are declared: three.js runs in Chromium."""


class Limits(NamedTuple):
    """How far the results of a technique may deviate on a back end."""

    largest: float = GOAL
    """The largest deviation of lanes that are not excluded."""
    share: float = SHARE
    """The largest share of lanes that are."""
    bound_share: float = SHARE
    """The same, where other functions are bound to the slots."""


def cases() -> list[Case]:
    """Every technique, and again with each other function of the library that fits one of its slots (no baseline)."""
    cases_of_all = []
    for technique in library.load_all():
        cases_of_all.append(Case(technique.name))
        for slot in technique.slots if not technique.baseline else ():
            cases_of_all += [Case(technique.name, ((slot.name, function),)) for function in slots.candidates(slot)[1:]]
    return cases_of_all


def limits(technique: str, backend: str) -> Limits:
    """The limits of a technique on a back end: the usual ones, or those that its `deviation_bounds` declare."""
    declared = library.load(technique).attributes.deviation_bounds
    driver = DRIVER_OF.get(backend, backend)
    return Limits(**declared.get(driver, declared.get("", {})))


def measure(case: Case, backend: Backend, lanes: int = LANES, seed: int = SEED) -> Deviation:
    """How far a back end is from the oracle. Raises SssgenError where the driver refuses."""
    prepared = _prepared(case, lanes, seed)
    return deviation(run(prepared.subject, prepared.inputs, backend), prepared.oracle, prepared.rounding)


def excess(case: Case, backend: str, measured: Deviation, lanes: int) -> str:
    """The part of a deviation that the limits do not allow, as a message; '' where there is none."""
    limit = limits(case.technique, backend)
    title = " ".join([case.technique, *("=".join(pair) for pair in case.bind)])
    if not measured.largest <= limit.largest:
        where = f"{measured.output}[{measured.lane}] is {measured.actual.tolist()}, not {measured.expected.tolist()}"
        return f"{title} on {backend}: {measured.largest:.2g} where at most {limit.largest:g} is right: {where}"
    share = limit.bound_share if case.bind else limit.share
    if measured.excluded > share * lanes + 3:  # a few lanes vary at random
        count = f"{measured.excluded} of {lanes} lanes are ill-conditioned"
        return f"{title} on {backend}: {count}, of which {share:.1%} may be"
    return ""


class _Prepared:
    """What the back ends share; the rounding deviation is measured once, when it is needed."""

    def __init__(self, case: Case, lanes: int, seed: int) -> None:
        self.subject: Subject = subject(case.technique, dict(case.bind))
        self.inputs: Inputs = fit_inputs(self.subject, samples(self.subject, lanes, seed))
        self.oracle: Mapping[str, Array] = run(self.subject, self.inputs, get("numpy"))
        self._rounding: Any = None

    def rounding(self) -> Mapping[str, Array]:
        if self._rounding is None:
            self._rounding = rounding_deviation(self.subject, self.inputs, self.oracle)
        measured: Mapping[str, Array] = self._rounding
        return measured


@lru_cache(4)
def _prepared(case: Case, lanes: int, seed: int) -> _Prepared:
    return _Prepared(case, lanes, seed)
