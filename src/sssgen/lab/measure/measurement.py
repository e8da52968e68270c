"""A point of a chart: a candidate with fitted parameters, its error on a scene's views, and its static cost."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.lab.measure import error_metric as metrics
from sssgen.lab.measure import fitting
from sssgen.lab.measure.candidates import PROBES, Candidate, converged_counts, is_calibrated, load
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_chain import Chain, material_of
from sssgen.lab.measure.measured_point import MeasuredPoint, PointCost, ViewError
from sssgen.lab.measure.needed_data import NeededData, needed_data
from sssgen.lab.measure.problem import (
    LENGTHS,
    LightReference,
    Problem,
    coordinates_problem,
    material_problem,
    thickness_problem,
    translucency_problem,
    view_thickness_problem,
)
from sssgen.lab.measure.seen_size import error_at
from sssgen.passes.cost import Cost, cost_of
from sssgen.pipeline.compiler import compile
from sssgen.run.backends import Array
from sssgen.scene.geometry import Geometry
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import Body, body
from sssgen.scene.measured.view_points import points
from sssgen.support.diagnostics import failure

COST_TARGET = "glsl-330"
"""The target whose emitted text the static cost is counted on."""

Parameters = Mapping[str, tuple[float, ...]]
"""Names as in the techniques"""


class View(NamedTuple):
    """A scene with its references, and the view's name in the chart."""

    name: str
    scene: MeasuredScene
    references: tuple[LightReference, ...] = ()
    """One per light"""
    stamp: str = ""
    """Samples and seed of the references"""


_problems: dict[tuple[str, str, str, bool], Problem | None] = {}
_MOST_PROBLEMS = 48


def problem_of(role: str, view: View, summed: bool = True) -> Problem | None:
    """The problem of a role on a view, cached for the next candidate; None where the role does not apply."""
    key = (role, view.scene.key, view.stamp, summed)
    if key not in _problems:
        if len(_problems) >= _MOST_PROBLEMS:
            _problems.clear()
        _problems[key] = _problem_of(role, view, summed)
    return _problems[key]


def _problem_of(role: str, view: View, summed: bool) -> Problem | None:
    if role == "coordinates":
        return coordinates_problem(view.scene)
    if role == "thickness":
        return thickness_problem(view.scene)
    if role == "view_thickness":
        return view_thickness_problem(view.scene)
    if role == "translucency":
        return translucency_problem(view.scene, view.references)
    return material_problem(view.scene, view.references, summed)


def fit_candidate(candidate: Candidate, training: Sequence[View], before: Parameters | None = None) -> FitResult:
    """Fits the candidate's parameters to the training views, light by light. Raises SssgenError.

    `before` has the parameters of its first technique, if they have been fitted: then that technique is evaluated only
    once, and the rest of the chain is fitted to its output.
    """
    if is_calibrated(candidate):
        return FitResult({}, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), math.nan)
    solvable = [
        (view, problem) for view in training if (problem := problem_of(candidate.role, view, summed=False)) is not None
    ]
    if not solvable:
        raise failure(
            "no light passes through the bodies for fitting", "the medium does not scatter, or absorbs all light"
        )
    problems = [problem.thin_out(fitting.LANES) for _, problem in solvable]
    bodies = [body(view.scene.geometry) for view, _ in solvable]
    rest = candidate
    with tempfile.TemporaryDirectory() as folder:
        if before is not None:
            rest, first = split(candidate)
            name = f"measured_{load(candidate.techniques[0]).function.quantity}"
            for index, (shape, problem) in enumerate(zip(bodies, problems, strict=True)):
                chain = chain_of(first, shape, folder)
                assert chain is not None
                problems[index] = problem.with_output_of(chain, name, fitting.chain_values(before))
        result = fitting.fit([chain_of(rest, shape, folder) for shape in bodies], problems)
    return result._replace(parameters={**(before or {}), **result.parameters})


def split(candidate: Candidate) -> tuple[Candidate, Candidate]:
    """The chain with its first technique replaced by a parameter, and a chain that shows that technique's output."""
    quantity = load(candidate.techniques[0]).function.quantity
    rest = candidate._replace(techniques=(f"given_{quantity}", *candidate.techniques[1:]))
    return rest, candidate._replace(techniques=(candidate.techniques[0], f"shown_{quantity}"))


def chain_of(candidate: Candidate, shape: Body, folder: str, dtype: Any = np.float64) -> Chain | None:
    """The candidate's compiled chain for a body; None if the candidate has no techniques. Raises SssgenError."""
    if not candidate.techniques:
        return None
    for name, text in shape.files.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return Chain(material_of(candidate.stages(shape), folder), dtype)


def measure_candidate(
    candidate: Candidate, fitted: FitResult, views: Sequence[View], thorough: bool = True, rows: Sequence[int] = ()
) -> MeasuredPoint:
    """The candidate's error over the views of one scene, with fitted parameters, as a point of a chart's record.

    The errors of a material are measured at the sizes `rows`, too (`seen_size.error_at`). If it
    is not `thorough`, the point is without FLIP and without the errors of the implementation, which take most of
    the time. `failed` of the point is not empty if the chain's output has NaN or infinity. Raises SssgenError.
    """
    solvable = [(view, problem) for view in views if (problem := problem_of(candidate.role, view)) is not None]
    if not solvable:
        raise failure(f"no light passes through the body of '{views[0].scene.name}'", "light it from behind, too")
    problems = [problem for _, problem in solvable]
    shape = body(views[0].scene.geometry)
    with tempfile.TemporaryDirectory() as folder:
        chain = chain_of(candidate, shape, folder)
        outputs = [_values(chain, fitted, problem) for problem in problems]
        cost = _point_cost(chain, candidate.role)
        data = needed_data(chain.material.stages, views[0].scene) if chain is not None else NeededData()
        implementation = {
            kind: difference(_values(variant, fitted, problems[0]), outputs[0])
            for kind, variant in (_variants(candidate, shape, folder) if thorough else ())
        }
    not_finite = sum(int((~np.isfinite(values)).any(axis=0).sum()) for values in outputs)
    lanes = sum(values.shape[1] for values in outputs)
    pictures = [_fitted_values(values, fitted, problem) for values, problem in zip(outputs, problems, strict=True)]
    error = metrics.compare(
        np.concatenate(pictures, axis=1),
        np.concatenate([problem.target for problem in problems], axis=1),
        np.concatenate([problem.noise for problem in problems], axis=1),
    )
    view_errors: dict[str, ViewError] = {}
    for picture, (view, problem) in zip(pictures, solvable, strict=True):
        view_error = metrics.compare(picture, problem.target, problem.noise)
        view_errors[view.name] = {"value": view_error["value"], "low": view_error["low"], "high": view_error["high"]}
    if thorough and candidate.role == "material":
        flips = [
            metrics.flip(points(view.scene).picture(picture), points(view.scene).picture(problem.target))
            for picture, (view, problem) in zip(pictures, solvable, strict=True)
        ]
        error["flip"] = float(np.mean(flips))
    return {
        "role": candidate.role, "name": candidate.name, "label": candidate.label, "baseline": candidate.baseline,
        "settings": dict(candidate.settings), "chain": list(candidate.techniques),
        "path": candidate.path, "path_settings": dict(candidate.path_settings),
        "parameters": {name: list(value) for name, value in fitted.parameters.items()},
        "scale": list(fitted.scale), "matte": list(fitted.matte), "factor": fitted.factor,
        "training_error": fitted.error,
        "requires": list(data.requires), "bytes": data.bytes,
        "cost": cost,
        "error": error, "views": view_errors, "implementation": implementation,
        "views_at": {
            str(size): {
                view.name: error_at(size, points(view.scene).valid, picture, problem.target, problem.noise)
                for picture, (view, problem) in zip(pictures, solvable, strict=True)
            }
            for size in rows
        },
        "failed": f"{not_finite} of {lanes} points are not finite" if not_finite else "",
    }  # fmt: skip


class Price(NamedTuple):
    """What is known of a candidate on a scene before it is fitted."""

    cost: PointCost
    requires: tuple[str, ...]
    """Of `material.attributes.REQUIREMENTS`"""
    bytes: int
    """Of its baked textures"""


def price(candidate: Candidate, scene: MeasuredScene) -> Price:
    """The static cost of a candidate, and the data that it needs. Raises SssgenError."""
    with tempfile.TemporaryDirectory() as folder:
        chain = chain_of(candidate, body(scene.geometry), folder)
        data = needed_data(chain.material.stages, scene) if chain is not None else NeededData()
        return Price(_point_cost(chain, candidate.role), data.requires, data.bytes)


def _point_cost(chain: Chain | None, role: str) -> PointCost:
    cost = static_cost(chain)
    result: PointCost = {
        "value": float(max(cost.weight, 1)), "operations": cost.operations,
        "transcendentals": cost.transcendentals, "fetches": cost.fetches, "volume_fetches": cost.volume_fetches,
        "distance_evaluations": cost.distance_evaluations, "gpu_ms": None,
    }  # fmt: skip
    if role == "material":
        result["once"] = _entry_cost(chain, ("surface",))._asdict()
    return result


def fit_and_measure(
    candidate: Candidate,
    training: Sequence[View],
    before: Parameters | None,
    views: Sequence[View],
    rows: Sequence[int] = (),
) -> MeasuredPoint:
    """`fit_candidate`, then `measure_candidate`, which is not thorough."""
    return measure_candidate(candidate, fit_candidate(candidate, training, before), views, False, rows)


def pictures_of(candidate: Candidate, fitted: FitResult, view: View) -> tuple[Array, Array]:
    """A view of a material by its chain and by the reference: (height, width, 3) each, linear light, exposed alike."""
    values, problem = compared(candidate, fitted, view)
    visible = points(view.scene)
    return visible.picture(values), visible.picture(problem.target)


def compared(candidate: Candidate, fitted: FitResult, view: View) -> tuple[Array, Problem]:
    """The values of a material on a view, (3, n), and the problem with the reference, exposed alike."""
    problem = problem_of("material", view)
    assert problem is not None
    return compared_with(problem, candidate, fitted, view.scene.geometry), problem


def compared_with(problem: Problem, candidate: Candidate, fitted: FitResult, geometry: Geometry) -> Array:
    """The values of a material for a problem on a body, (3, n)."""
    with tempfile.TemporaryDirectory() as folder:
        values = _values(chain_of(candidate, body(geometry), folder), fitted, problem)
    return _fitted_values(values, fitted, problem)


def _fitted_values(values: Array, fitted: FitResult, problem: Problem) -> Array:
    return fitted.apply(np.nan_to_num(values), problem)


def _variants(candidate: Candidate, shape: Body, folder: str) -> Iterator[tuple[str, Chain | None]]:
    """The chain in float32, and with its counts at their maxima: errors of the implementation, not of the model."""
    if candidate.techniques:
        yield "float32", chain_of(candidate, shape, folder, np.float32)
    if candidate.settings and candidate.role in LENGTHS:
        yield "counts", chain_of(candidate._replace(settings=converged_counts(candidate)), shape, folder)


def difference(values: Array, reference: Array) -> float:
    """The root mean square of the difference, relative to that of the reference, where both are finite."""
    finite = np.isfinite(values) & np.isfinite(reference)
    level = float(np.sqrt((reference[finite] ** 2).mean())) if finite.any() else 0.0
    return float(np.sqrt(((values - reference)[finite] ** 2).mean())) / level if level > 0.0 else 0.0


def _values(chain: Chain | None, fitted: FitResult, problem: Problem) -> Array:
    if chain is None:
        return np.zeros_like(problem.target)
    return problem.values(chain, fitting.chain_values(fitted.parameters))


def static_cost(chain: Chain | None) -> Cost:
    """The cost of an evaluation of a chain for one light, without its probes."""
    total = _entry_cost(chain, ("surface", "translucency"))
    if chain is None:
        return total
    probes = [
        stage.technique.name for stage in chain.material.stages if os.path.dirname(stage.technique.path) == PROBES
    ]
    return total.plus(_probe_cost(probes[-1]), -1) if probes else total


def _entry_cost(chain: Chain | None, kinds: Sequence[str]) -> Cost:
    """The cost of functions that a shell calls: `surface` once, `translucency` for each light."""
    total = Cost()
    if chain is not None:
        entries = compile(chain.material, COST_TARGET, "functions").reflection["entries"]
        for kind in kinds:
            if kind in entries:
                total = total.plus(Cost(**entries[kind]["cost"]))
    return total


@cache
def _probe_cost(name: str) -> Cost:
    """The cost of a probe alone."""
    module, function = load(name).module, load(name).function
    return cost_of(module, function.key)
