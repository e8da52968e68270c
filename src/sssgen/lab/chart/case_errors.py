"""The errors of chains in cases: a case is both views of a body under the same light."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, results_of
from sssgen.lab.chart.drawn_lights import Case
from sssgen.lab.measure import candidates, fitting, fluence_inputs
from sssgen.lab.measure import error_metric as metrics
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_point import FittedChain, MeasuredPoint
from sssgen.lab.measure.measurement import View, compared, problem_of
from sssgen.lab.measure.problem import Problem
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.support.extras import need

NEAR = 2
"""The pixels within which a point is at the edge of a shadow."""


class CaseErrors(NamedTuple):
    """A chain on a body, in each case."""

    values: tuple[float, ...]
    """The errors over both views"""
    edges: tuple[float, ...]
    """The errors at points near the edge of a shadow, that of the body's dark side included; NaN where there is none"""

    @property
    def median(self) -> float:
        return float(np.median(self.values))

    @property
    def worst(self) -> float:
        return float(np.max(self.values))

    @property
    def edge(self) -> float:
        """The median at the edges of shadows."""
        return float(np.nanmedian(self.edges)) if np.isfinite(self.edges).any() else float("nan")


def errors(
    scenes: Sequence[MeasuredScene],
    chains: Sequence[FittedChain],
    cases: Mapping[str, Sequence[Case]],
    settings: Settings,
) -> dict[str, list[CaseErrors]]:
    """The errors of whole materials in the cases of each scene, by its key: one result for each chain.

    Raises SssgenError for scenes that cannot be measured, and for missing packages.
    """
    fitted = [(candidate_of(chain), fit_of(chain)) for chain in chains]
    if any(candidates.reads_fluence(candidate) for candidate, _ in fitted):
        for scene in scenes:
            with settings.progress_bar() as progress:
                unlit = dataclasses.replace(scene, lights=())
                fluence_inputs.prepare(unlit, settings.scheduler, settings.processes, progress)
    items = [
        Item(f"{__name__}:measure", (tuple(fitted), tuple(case)), f"{scene.name}, light {number}")
        for scene in scenes
        for number, case in enumerate(cases[scene.key])
    ]
    measured = iter(results_of(items, settings))
    results = {}
    for scene in scenes:
        of_cases = [next(measured) for _ in cases[scene.key]]
        results[scene.key] = [
            CaseErrors(*map(tuple, zip(*pairs, strict=True))) for pairs in zip(*of_cases, strict=True)
        ]
    return results


def measure(fitted: Sequence[tuple[Candidate, FitResult]], case: Case) -> list[tuple[float, float]]:
    """The errors of chains over a case's views: at all points, and at the edges of shadows.

    A material without techniques has the albedo that is best in this case.
    """
    # the chains of a case share its inputs, which take most of the time
    results = []
    for candidate, fit in fitted:
        if not candidate.techniques:
            problems = [problem_of("material", view) for view in case]
            fit = fitting.fit([None for _ in case], [problem for problem in problems if problem is not None])
        results.append(case_error([compared(candidate, fit, view) for view in case], case))
    return results


def case_error(results: Sequence[tuple[Array, Problem]], case: Case) -> tuple[float, float]:
    """The errors of values, (3, n) on each view: at all points, and at the edges of shadows."""
    edges = [_edges(view, problem) for view, (_, problem) in zip(case, results, strict=True)]
    whole = [np.ones_like(edge) for edge in edges]
    return _error(results, whole), _error(results, edges)


def _error(results: Sequence[tuple[Array, Problem]], keep: Sequence[Array]) -> float:
    if not any(map(np.any, keep)):
        return float("nan")
    parts = [
        (values[:, kept], problem.target[:, kept], problem.noise[:, kept])
        for (values, problem), kept in zip(results, keep, strict=True)
    ]
    values, target, noise = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
    value = metrics.compare(values, target, noise)["value"]
    return float("nan") if value is None else float(value)


def _edges(view: View, problem: Problem) -> Array:
    """(n,): whether a point has both lit and unlit ones within NEAR pixels."""
    ndimage, valid = need("scipy.ndimage", "scipy", "chart"), points(view.scene).valid
    lit = np.zeros_like(valid)
    lit[valid] = problem.lambert.max(axis=0) > 0.0
    near = [ndimage.maximum_filter(part, 2 * NEAR + 1) for part in (lit, valid & ~lit)]
    edges: Array = (near[0] & near[1])[valid]
    return edges


def cost_of(chain: FittedChain, case: Case, settings: Settings) -> tuple[float, int]:
    """The weighted operations of a chain, and the bytes of its baked textures on a body."""
    function = "sssgen.lab.measure.measurement:measure_candidate"
    item = Item(function, (candidate_of(chain), fit_of(chain), list(case)), f"cost of {chain['label']}")
    points_: list[MeasuredPoint] = results_of([item], settings)
    return float(points_[0]["cost"]["value"]), points_[0]["bytes"]
