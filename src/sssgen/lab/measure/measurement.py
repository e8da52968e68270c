"""One point of a chart: a candidate with fitted parameters, its error on a scene's views, and its static cost."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import Array
from sssgen.lab.measure import error_metric as metrics
from sssgen.lab.measure import fitting as fit
from sssgen.lab.measure import problem
from sssgen.lab.measure.candidates import PROBES, Candidate, load, most_counts
from sssgen.lab.measure.fitting import Fitted
from sssgen.lab.measure.measured_chain import Chain, material_of
from sssgen.lab.measure.problem import Problem, Seen
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.scene_body import Body, body
from sssgen.lab.scene.view_points import points
from sssgen.passes.cost import Cost, cost_of
from sssgen.pipeline.compiler import compile
from sssgen.support.diagnostics import failure

COST_TARGET = "glsl-330"
"""The target whose emitted text the static cost is counted on."""

Parameters = Mapping[str, tuple[float, ...]]
"""By the techniques' own names"""


class View(NamedTuple):
    """A scene with its references, and the view's name in the chart."""

    name: str
    scene: MeasuredScene
    seen: tuple[Seen, ...] = ()
    reference: str = ""
    """Samples and seed of the references"""


_problems: dict[tuple[str, str, str, bool], Problem | None] = {}
_MOST_PROBLEMS = 48


def problem_of(role: str, view: View, summed: bool = True) -> Problem | None:
    """The problem of a role on a view, cached for the next candidate; None where the role does not apply."""
    key = (role, view.scene.key, view.reference, summed)
    if key not in _problems:
        if len(_problems) >= _MOST_PROBLEMS:
            _problems.clear()
        _problems[key] = _problem_of(role, view, summed)
    return _problems[key]


def _problem_of(role: str, view: View, summed: bool) -> Problem | None:
    if role == "coordinates":
        return problem.of_coordinates(view.scene)
    if role == "thickness":
        return problem.of_thickness(view.scene)
    if role == "translucency":
        return problem.of_light(view.scene, view.seen)
    return problem.of_material(view.scene, view.seen, summed)


def fitted(candidate: Candidate, training: Sequence[View], before: Parameters | None = None) -> Fitted:
    """Fits the candidate's parameters to the training views, light by light. Raises SssgenError.

    `before` has the parameters of its first technique, if these are known: then that technique is evaluated only once,
    and the rest of the chain is fitted to its output.
    """
    solvable = [(view, one) for view in training if (one := problem_of(candidate.role, view, summed=False)) is not None]
    if not solvable:
        raise failure(
            "no light passes through the bodies for fitting", "the medium does not scatter, or absorbs all light"
        )
    problems = [problem_.thinned(fit.LANES) for _, problem_ in solvable]
    bodies = [body(view.scene.geometry) for view, _ in solvable]
    rest = candidate
    with tempfile.TemporaryDirectory() as folder:
        if before is not None:
            rest, first = split(candidate)
            name = f"measured_{load(candidate.techniques[0]).function.quantity}"
            for index, (shape, unsolved) in enumerate(zip(bodies, problems, strict=True)):
                chain = chain_of(first, shape, folder)
                assert chain is not None
                problems[index] = unsolved.with_output_of(chain, name, fit.exact(before))
        result = fit.fit([chain_of(rest, shape, folder) for shape in bodies], problems)
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


def measured(candidate: Candidate, fit_result: Fitted, views: Sequence[View]) -> dict[str, Any]:
    """The candidate's error over the views of one scene, with fitted parameters, as a point of a chart's record.

    `failed` of the point is not empty where the chain's output has NaN or infinity. Raises SssgenError.
    """
    solvable = [(view, one) for view in views if (one := problem_of(candidate.role, view)) is not None]
    if not solvable:
        raise failure(f"no light passes through the body of '{views[0].scene.name}'", "light it from behind, too")
    problems = [one for _, one in solvable]
    shape = body(views[0].scene.geometry)
    with tempfile.TemporaryDirectory() as folder:
        chain = chain_of(candidate, shape, folder)
        outputs = [_values(chain, fit_result, one) for one in problems]
        cost = static_cost(chain)
        implementation = {
            kind: difference(_values(variant, fit_result, problems[0]), outputs[0])
            for kind, variant in _variants(candidate, shape, folder)
        }
    not_finite = sum(int((~np.isfinite(values)).any(axis=0).sum()) for values in outputs)
    lanes = sum(values.shape[1] for values in outputs)
    pictures = [fit_result.apply(np.nan_to_num(values), one) for values, one in zip(outputs, problems, strict=True)]
    error = metrics.compare(
        np.concatenate(pictures, axis=1),
        np.concatenate([one.target for one in problems], axis=1),
        np.concatenate([one.noise for one in problems], axis=1),
    )
    view_errors = {}
    for picture, (view, one) in zip(pictures, solvable, strict=True):
        view_error = metrics.compare(picture, one.target, one.noise)
        view_errors[view.name] = {key: view_error[key] for key in ("value", "low", "high")}
    if candidate.role == "material":
        flips = [
            metrics.flip(points(view.scene).picture(picture), points(view.scene).picture(one.target))
            for picture, (view, one) in zip(pictures, solvable, strict=True)
        ]
        error["flip"] = float(np.mean(flips))
    return {
        "role": candidate.role, "name": candidate.name, "label": candidate.label, "baseline": candidate.baseline,
        "settings": dict(candidate.settings), "chain": list(candidate.techniques),
        "parameters": {name: list(value) for name, value in fit_result.parameters.items()},
        "scale": list(fit_result.scale), "matte": list(fit_result.matte), "factor": fit_result.factor,
        "training_error": fit_result.error,
        "cost": {"value": float(max(cost.weight, 1)), **cost._asdict(), "gpu_ms": None},
        "error": error, "views": view_errors, "implementation": implementation,
        "failed": f"{not_finite} of {lanes} points are not finite" if not_finite else "",
    }  # fmt: skip


def _variants(candidate: Candidate, shape: Body, folder: str) -> Iterator[tuple[str, Chain | None]]:
    """The chain in float32, and with its counts at their maxima: errors of the implementation, not of the model."""
    if candidate.techniques:
        yield "float32", chain_of(candidate, shape, folder, np.float32)
    if candidate.settings and candidate.role == "thickness":
        yield "counts", chain_of(candidate._replace(settings=most_counts(candidate)), shape, folder)


def difference(values: Array, reference: Array) -> float:
    """The root mean square of the difference, relative to that of the reference, where both are finite."""
    finite = np.isfinite(values) & np.isfinite(reference)
    level = float(np.sqrt((reference[finite] ** 2).mean())) if finite.any() else 0.0
    return float(np.sqrt(((values - reference)[finite] ** 2).mean())) / level if level > 0.0 else 0.0


def _values(chain: Chain | None, fit_result: Fitted, unsolved: Problem) -> Array:
    if chain is None:
        return np.zeros_like(unsolved.target)
    return unsolved.values(chain, fit.exact(fit_result.parameters))


def static_cost(chain: Chain | None) -> Cost:
    """The cost of one evaluation of a chain for one light, without its probes."""
    if chain is None:
        return Cost()
    entries = compile(chain.material, COST_TARGET, "functions").reflection["entries"]
    total = Cost()
    for kind in ("surface", "translucency"):
        if kind in entries:
            total = total.plus(Cost(**entries[kind]["cost"]))
    probes = [
        stage.technique.name for stage in chain.material.stages if os.path.dirname(stage.technique.path) == PROBES
    ]
    return total.plus(_probe_cost(probes[-1]), -1) if probes else total


@cache
def _probe_cost(name: str) -> Cost:
    """The cost of a probe alone."""
    module, function = load(name).module, load(name).function
    return cost_of(module, function.key)
