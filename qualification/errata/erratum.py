"""One erratum: a technique as published and its replacement, on the same inputs, with the theory of both."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from sssgen.run.backends import Array, Backend
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.run.evaluate.probes import Subject, subject

Outputs: TypeAlias = Mapping[str, Array]
Figures: TypeAlias = tuple[float, ...]

NONE: Mapping[str, str] = MappingProxyType({})


def flat_result(outputs: Outputs) -> Figures:
    """Every number of the result, lane by lane."""
    return tuple(float(value) for value in np.ravel(outputs["result"]))


class Measure(NamedTuple):
    """A technique on given inputs, and the figures made of what it returns."""

    technique: str
    runs: tuple[Mapping[str, Any], ...]
    """The inputs of each evaluation, as `evaluate` takes them; the figures stand one behind another."""
    figures: Callable[[Outputs], Figures] = flat_result
    bind: Mapping[str, str] = NONE
    """Slot → function."""


class Right(NamedTuple):
    """Where a figure must lie, from `low` to `high`."""

    low: float
    high: float


def about(value: float, tolerance: float) -> Right:
    """`value`, give or take `tolerance`."""
    return Right(value - tolerance, value + tolerance)


class Erratum(NamedTuple):
    """A fault of a source, with the numbers that show it."""

    name: str
    source: str
    """The short name of the source."""
    demonstration: str
    """The inputs, and the meaning of the figures."""
    published: Measure
    theory: Figures
    """The result of the formula as published, which may be NaN or infinite; () where it is undefined."""
    correction: Measure
    right: tuple[Right, ...]
    """The correct result, as the bounds that ours keeps."""
    everywhere: bool = True
    """Whether every back end agrees with theory; otherwise they differ, and at least one is wrong."""
    tolerance: float = 1e-4
    """How far the published figures may be from theory, relative to those above 1."""


def as_published(erratum: Erratum, backend: Backend) -> Figures:
    """The figures of the technique as published, without our guards. Raises SssgenError where the back end refuses."""
    return _figures(erratum.published, backend, "none")


def as_corrected(erratum: Erratum, backend: Backend) -> Figures:
    """The figures of ours, as it is emitted. Raises SssgenError where the back end refuses."""
    return _figures(erratum.correction, backend, "auto")


def _figures(measure: Measure, backend: Backend, guards: str) -> Figures:
    chosen = subject_of(measure.technique, tuple(sorted(measure.bind.items())))
    every = (evaluate(chosen, inputs, backend, guards) for inputs in measure.runs)
    return tuple(figure + 0.0 for outputs in every for figure in measure.figures(outputs))  # + 0: no -0


def shows(erratum: Erratum, figures: Figures) -> bool:
    """Whether figures of the published technique agree with theory."""
    return len(figures) == len(erratum.theory) and all(
        math.isclose(actual, expected, rel_tol=erratum.tolerance, abs_tol=erratum.tolerance)
        or (math.isnan(actual) and math.isnan(expected))
        or (math.isinf(expected) and not math.isfinite(actual))
        for actual, expected in zip(figures, erratum.theory, strict=True)
    )


def holds(erratum: Erratum, figures: Figures) -> bool:
    """Whether all figures are within their bounds; NaN never is."""
    return len(figures) == len(erratum.right) and all(
        right.low <= figure <= right.high for figure, right in zip(figures, erratum.right, strict=True)
    )


@lru_cache(64)
def subject_of(technique: str, bind: tuple[tuple[str, str], ...] = ()) -> Subject:
    """A technique of the library, kept for the next back end."""
    return subject(technique, dict(bind))
