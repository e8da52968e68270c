"""One point of a chart: a candidate's parameters fitted, its error on a scene's views, and its static cost."""

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
"""The target whose text static cost is counted on."""


Parameters = Mapping[str, tuple[float, ...]]
"""By the techniques' own names"""


class View(NamedTuple):
    """A scene with its references, and what the chart calls it."""

    name: str
    scene: MeasuredScene
    seen: tuple[Seen, ...] = ()
    reference: str = ""
    """What the references were made with: samples and seed"""


_problems: dict[tuple[str, str, str, bool], Problem | None] = {}
_KEPT = 48


def problem_of(role: str, view: View, summed: bool = True) -> Problem | None:
    """What a role is asked for on a view; None where the view does not ask. Kept for the next candidate."""
    key = (role, view.scene.key, view.reference, summed)
    if key not in _problems:
        if len(_problems) >= _KEPT:
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
    """The candidate's parameters over the training views, light by light. Raises SssgenError.

    `before` are those of its first technique, where that is fitted already: then it is measured once, and the rest is
    fitted to what it gives.
    """
    asked = [(view, one) for view in training if (one := problem_of(candidate.role, view, summed=False)) is not None]
    if not asked:
        raise failure("no light comes through what is fitted to", "the medium scatters nothing, or absorbs all")
    problems = [one.thinned(fit.LANES) for _, one in asked]
    bodies = [body(view.scene.geometry) for view, _ in asked]
    rest = candidate
    with tempfile.TemporaryDirectory() as folder:
        if before is not None:
            rest, first = split(candidate)
            name = f"measured_{load(candidate.techniques[0]).function.quantity}"
            for at, (of, one) in enumerate(zip(bodies, problems, strict=True)):
                chain = chain_of(first, of, folder)
                assert chain is not None
                problems[at] = one.given(name, chain, fit.exact(before))
        found = fit.fit([chain_of(rest, of, folder) for of in bodies], problems)
    return found._replace(parameters={**(before or {}), **found.parameters})


def split(candidate: Candidate) -> tuple[Candidate, Candidate]:
    """A chain without its first technique, which is given, and that technique alone, which is shown."""
    quantity = load(candidate.techniques[0]).function.quantity
    rest = candidate._replace(techniques=(f"given_{quantity}", *candidate.techniques[1:]))
    return rest, candidate._replace(techniques=(candidate.techniques[0], f"shown_{quantity}"))


def chain_of(candidate: Candidate, of: Body, folder: str, dtype: Any = np.float64) -> Chain | None:
    """The candidate's chain for a body, compiled; None where nothing is left of it. Raises SssgenError."""
    if not candidate.techniques:
        return None
    for name, text in of.files.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return Chain(material_of(candidate.stages(of), folder), dtype)


def measured(candidate: Candidate, found: Fitted, views: Sequence[View]) -> dict[str, Any]:
    """The candidate's error over views of one scene, with the parameters fitted, as a point of a chart's record.

    A chain that gives NaN or infinity anywhere has `failed`, and no error. Raises SssgenError.
    """
    asked = [(view, one) for view in views if (one := problem_of(candidate.role, view)) is not None]
    if not asked:
        raise failure(f"no light comes through the body of '{views[0].scene.name}'", "light it from behind, too")
    with tempfile.TemporaryDirectory() as folder:
        chain = chain_of(candidate, body(views[0].scene.geometry), folder)
        given = [_values(chain, found, one) for _, one in asked]
        cost = static_cost(chain)
        own = asked[0][1]
        implementation = {
            kind: apart(_values(other, found, own), given[0])
            for kind, other in _others(candidate, body(views[0].scene.geometry), folder)
        }
    bad = sum(int((~np.isfinite(values)).any(axis=0).sum()) for values in given)
    lanes = sum(values.shape[1] for values in given)
    pictures = [found.apply(np.nan_to_num(values), one) for values, (_, one) in zip(given, asked, strict=True)]
    error = metrics.compare(
        np.concatenate(pictures, axis=1),
        np.concatenate([one.target for _, one in asked], axis=1),
        np.concatenate([one.noise for _, one in asked], axis=1),
    )
    each = {}
    for picture, (view, one) in zip(pictures, asked, strict=True):
        of_view = metrics.compare(picture, one.target, one.noise)
        each[view.name] = {key: of_view[key] for key in ("value", "low", "high")}
    if candidate.role == "material":
        flips = [
            metrics.flip(points(view.scene).picture(picture), points(view.scene).picture(one.target))
            for picture, (view, one) in zip(pictures, asked, strict=True)
        ]
        error["flip"] = float(np.mean(flips))
    return {
        "role": candidate.role, "name": candidate.name, "label": candidate.label, "baseline": candidate.baseline,
        "settings": dict(candidate.settings), "chain": list(candidate.techniques),
        "parameters": {name: list(value) for name, value in found.parameters.items()},
        "scale": list(found.scale), "matte": list(found.matte), "factor": found.factor,
        "training_error": found.error,
        "cost": {"value": float(max(cost.weight, 1)), **cost._asdict(), "gpu_ms": None},
        "error": error, "views": each, "implementation": implementation,
        "failed": f"{bad} of {lanes} points are not finite" if bad else "",
    }  # fmt: skip


def _others(candidate: Candidate, of: Body, folder: str) -> Iterator[tuple[str, Chain | None]]:
    """The chain as rounding and its counts leave it: in float32, and with as many steps as it may have."""
    if candidate.techniques:
        yield "float32", chain_of(candidate, of, folder, np.float32)
    if candidate.settings and candidate.role == "thickness":
        yield "counts", chain_of(candidate._replace(settings=most_counts(candidate)), of, folder)


def apart(values: Array, others: Array) -> float:
    """How far values are from others of the same chain: the root mean square of the difference, over that of both."""
    both = np.isfinite(values) & np.isfinite(others)
    level = float(np.sqrt((others[both] ** 2).mean())) if both.any() else 0.0
    return float(np.sqrt(((values - others)[both] ** 2).mean())) / level if level > 0.0 else 0.0


def _values(chain: Chain | None, found: Fitted, asked: Problem) -> Array:
    if chain is None:
        return np.zeros_like(asked.target)
    return asked.values(chain, fit.exact(found.parameters))


def static_cost(chain: Chain | None) -> Cost:
    """What one evaluation of a chain does for one light; a probe is none of the chain's work."""
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
    return total.plus(_of_probe(probes[-1]), -1) if probes else total


@cache
def _of_probe(name: str) -> Cost:
    """What a probe alone costs."""
    module, function = load(name).module, load(name).function
    return cost_of(module, function.key)
