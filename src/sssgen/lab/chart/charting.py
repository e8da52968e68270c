"""Charts: every candidate on every scene, fitted, measured, and set beside the others, as a record to draw or to pick
from.

    record = charted([measured_scene.load("cube")], Settings())

The points of a scene are kept in the cache folder; what an interrupted run has measured is not measured again.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

from sssgen.lab.chart.record import FORMAT, front, hypervolume
from sssgen.lab.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.jobs.work_items import code_stamp
from sssgen.lab.measure import candidates
from sssgen.lab.measure import scene_references as references
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.fitting import Fitted
from sssgen.lab.measure.measurement import View
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.version import VERSION

PAYS = 0.9
"""A dearer setting of a thickness technique goes into whole chains where its error in the fit is this much less."""

VIEWS = ("own", "held out")
"""What the two views of a scene are called."""

LIT = frozenset(("translucency", "material"))
"""The roles that are held against light transport."""

DEFAULTS = ("cube", "torus", "bracket", "capsule", "mouse", "inlay_plate", "inlay_ball")
"""The scenes of a chart that names none."""


class Settings(NamedTuple):
    """How to measure."""

    samples: int = references.SAMPLES
    """Of each ray and channel of a scene's reference; those of what is fitted to have half as many"""
    seed: int = 0
    roles: tuple[str, ...] = candidates.ROLES
    scheduler: str = ""
    processes: int | None = None
    shown: Callable[[], AbstractContextManager[Progress]] = lambda: nullcontext(lambda *_: None)
    """Makes a progress bar for each stage of the work"""

    def kept(self, one: MeasuredScene) -> str:
        """Where the points of a scene lie in the cache."""
        said = repr((one.key, self.samples, self.seed, self.roles, code_stamp(__name__)))
        return f"chart-{cache.digest(said)}.json"


def charted(scenes: Sequence[MeasuredScene], settings: Settings) -> dict[str, Any]:
    """The record of a chart: all points of these scenes, those of each from the cache where it has them.

    Raises SssgenError for scenes that cannot be measured, and for packages that are missing.
    """
    known = {one.key: kept(one, settings) for one in scenes}
    new = [one for one in {one.key: one for one in scenes}.values() if known[one.key] is None]
    if new:
        for one, made in zip(new, _measured(new, settings), strict=True):
            known[one.key] = made
            cache.write(settings.kept(one), json.dumps(made).encode())
    each = [known[one.key] for one in scenes]
    points = _on_fronts([point for made in each if made for point in made["points"]])
    return {
        "format": FORMAT, "record": about(settings), "cost": "static",
        "cost_unit": "weighted operations",
        "scenes": [made["scene"] for made in each if made],
        "points": points, "hypervolume": hypervolumes(points),
    }  # fmt: skip


def kept(one: MeasuredScene, settings: Settings) -> dict[str, Any] | None:
    """The scene's points from the cache; None where it has none."""
    try:
        found: dict[str, Any] = json.loads(cache.read(settings.kept(one)) or b"null")
    except ValueError:
        return None
    return found


def _measured(scenes: Sequence[MeasuredScene], settings: Settings) -> list[dict[str, Any]]:
    """The points of scenes, measured."""
    views = _views(scenes, settings)
    found: dict[str, list[dict[str, Any]]] = {one.key: [] for one in scenes}
    for role in settings.roles:
        if role == "material":
            continue
        jobs = [(one, candidate) for one in scenes for candidate in _asked(role, one)]
        for one, point in _points(jobs, views, settings, {}):
            found[one.key].append(point)
    if "material" in settings.roles:
        jobs = []
        before: dict[tuple[str, tuple[str, ...], Any], Mapping[str, tuple[float, ...]]] = {}
        for one in scenes:
            if one.medium is not None:
                lengths = paying([point for point in found[one.key] if point["role"] == "thickness"])
                jobs += [(one, candidate) for candidate in candidates.materials(lengths)]
                before |= {(one.key, *first): given for first, given in dear(found[one.key]).items()}
        for one, point in _points(jobs, views, settings, before):
            found[one.key].append(point)
    return [{"scene": _scene(one, views[one.key]), "points": found[one.key]} for one in scenes]


def _asked(role: str, one: MeasuredScene) -> list[Candidate]:
    """The candidates of a role that a scene asks for."""
    if role == "coordinates":
        return candidates.coordinates() if one.inlay is not None else []
    if one.medium is None:
        return []
    return candidates.thickness() if role == "thickness" else candidates.translucency()


Before = Mapping[tuple[str, tuple[str, ...], Any], Mapping[str, tuple[float, ...]]]
"""A scene's key, a technique, its settings → its parameters"""


class _Views(NamedTuple):
    own: tuple[View, ...]
    training: tuple[View, ...]


def _views(scenes: Sequence[MeasuredScene], settings: Settings) -> dict[str, _Views]:
    """Each scene's views and what it is fitted to, with their references."""
    lit = bool(LIT.intersection(settings.roles))
    own = seen_views({one.key: sides(one) for one in scenes}, settings, lit)
    training = {one.key: references.training(one) if one.medium is not None else [] for one in scenes}
    cheap = settings._replace(samples=settings.samples // 2)
    fitted_to = seen_views({key: [(one.name, one) for one in ones] for key, ones in training.items()}, cheap, lit)
    plates = {one.key: (View("plate", references.plate(one)),) for one in scenes if one.inlay is not None}
    return {one.key: _Views(own[one.key], fitted_to[one.key] + plates.get(one.key, ())) for one in scenes}


def sides(one: MeasuredScene) -> list[tuple[str, MeasuredScene]]:
    """A scene's two views, and what they are called."""
    return list(zip(VIEWS, (one, one.held_out()), strict=True))


def seen_views(
    named: Mapping[str, Sequence[tuple[str, MeasuredScene]]], settings: Settings, lit: bool = True
) -> dict[str, tuple[View, ...]]:
    """Views by what they belong to: with their references of light transport where these are asked for (`lit`)."""
    each = {one.key: one for group in named.values() for _, one in group if lit}
    wanted = list(each.values())
    results = _all(references.items(wanted, settings.samples, settings.seed), settings)
    seen = references.by_scene(wanted, results)
    stamp = f"{settings.samples} {settings.seed}"
    return {
        key: tuple(View(name, one, tuple(seen.get(one.key, ())), stamp) for name, one in group)
        for key, group in named.items()
    }


def _points(
    jobs: Sequence[tuple[MeasuredScene, Candidate]], views: dict[str, _Views], settings: Settings, before: Before
) -> Iterable[tuple[MeasuredScene, dict[str, Any]]]:
    """The jobs' points: parameters are fitted once for all scenes that are fitted to the same.

    `before` has those of first techniques that are fitted already.
    """
    fits = [
        Item(
            "sssgen.lab.measure.measurement:fitted",
            (
                candidate,
                _training(candidate, views[one.key]),
                before.get((one.key, candidate.techniques[:1], candidate.settings)),
            ),
            f"fit {candidate.label}",
        )
        for one, candidate in jobs
    ]
    fitted: list[Fitted] = _all(fits, settings)
    measures = [
        Item(
            "sssgen.lab.measure.measurement:measured",
            (candidate, found, views[one.key].own),
            f"{candidate.label} on {one.name}",
        )
        for (one, candidate), found in zip(jobs, fitted, strict=True)
    ]
    points: list[dict[str, Any]] = _all(measures, settings)
    for (one, _), point in zip(jobs, points, strict=True):
        yield one, {"scene": one.name, **point}


def remeasured(
    record: Mapping[str, Any], scenes: Sequence[MeasuredScene], settings: Settings
) -> dict[tuple[str, str], float]:
    """The materials' errors against another reference, as `settings` have it, with the parameters that were fitted.

    (scene, label) → the worst of the views; infinite where a chain fails.
    """
    views = seen_views({one.name: sides(one) for one in scenes}, settings)
    points = [point for point in record["points"] if point["role"] == "material" and point["scene"] in views]
    items = [
        Item(
            "sssgen.lab.measure.measurement:measured",
            (candidate_of(point), fitted_of(point), views[point["scene"]]),
            f"{point['label']} on {point['scene']}, again",
        )
        for point in points
    ]
    found = {}
    for point, again in zip(points, _all(items, settings), strict=True):
        worst = max(float(view["value"]) for view in again["views"].values())
        found[point["scene"], point["label"]] = float("inf") if again["failed"] else worst
    return found


def candidate_of(point: Mapping[str, Any]) -> Candidate:
    """The candidate that a point was measured of."""
    settings, chain = tuple(point["settings"].items()), tuple(point["chain"])
    return Candidate(point["role"], point["name"], point["label"], settings, chain, point["baseline"])


def fitted_of(point: Mapping[str, Any]) -> Fitted:
    """What was fitted for a point."""
    parameters = {name: tuple(value) for name, value in point["parameters"].items()}
    return Fitted(parameters, tuple(point["scale"]), tuple(point["matte"]), point["training_error"], point["factor"])


def _training(candidate: Candidate, views: _Views) -> tuple[View, ...]:
    on_plate = candidate.role == "coordinates"
    return tuple(view for view in views.training if (view.name == "plate") == on_plate)


def _all(items: Sequence[Item], settings: Settings) -> list[Any]:
    """The items' results. Raises SssgenError with those that failed."""
    with settings.shown() as progress:
        results = run(items, settings.scheduler, settings.processes, progress=progress)
    failed: dict[str, dict[str, None]] = {}
    for result in results:
        if isinstance(result, Failure):
            failed.setdefault(result.message, {})[result.name] = None
    if failed:
        told = []
        for message, names in failed.items():  # what is wrong with a scene is wrong with each of its items
            first, more = next(iter(names)), f" and {len(names) - 1} more" if len(names) > 1 else ""
            told.append(failure(f"{first}{more}: {message}").diagnostics[0])
        raise SssgenError(told)
    return results


def dear(points: Sequence[dict[str, Any]]) -> dict[tuple[tuple[str, ...], Any], dict[str, tuple[float, ...]]]:
    """The parameters of the thickness techniques that evaluate a distance: (technique, settings) → as fitted.

    Whole chains keep them, as to fit them anew in each would take hours.
    """
    found: dict[tuple[tuple[str, ...], Any], dict[str, tuple[float, ...]]] = {}
    best: dict[tuple[tuple[str, ...], Any], float] = {}
    for point in points:
        technique = candidates.load(point["chain"][0]) if point["role"] == "thickness" else None
        if technique is None or not technique.slots:
            continue
        key = (technique.name,), tuple(point["settings"].items())
        if point["training_error"] < best.get(key, float("inf")):
            best[key] = point["training_error"]
            found[key] = {name: tuple(value) for name, value in point["parameters"].items()}
    return found


def paying(points: Sequence[dict[str, Any]]) -> list[Candidate]:
    """The thickness candidates for whole chains: of each technique the cheapest setting, and those that pay.

    What was fitted to decides, and not the scene.
    """
    by_label = {candidate.label: candidate for candidate in candidates.thickness()}
    chains: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for point in points:
        chains.setdefault(tuple(point["chain"]), []).append(point)
    found = []
    for of_chain in chains.values():
        best = float("inf")
        for point in sorted(of_chain, key=lambda one: float(one["cost"]["value"])):
            if point["training_error"] < PAYS * best:
                best = point["training_error"]
                found.append(by_label[point["label"]])
    return found


def _scene(one: MeasuredScene, views: _Views) -> dict[str, Any]:
    """What a record says of a scene."""
    found: dict[str, Any] = {"name": one.name, "title": one.title, "key": one.key}
    if one.medium is not None:
        found["medium"] = {"name": one.medium.name, "albedo": list(one.medium.albedo)}
        found["medium"]["extinction"] = list(one.medium.extinction)
        found["fitted_to"] = [view.name for view in views.training]
    return found


def _on_fronts(points: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """The points, each with whether it stands on the front of its scene and role."""
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for point in points:
        groups.setdefault((point["scene"], point["role"]), []).append(point)
    best = {id(point) for group in groups.values() for point in front(group)}
    return [{**point, "front": id(point) in best} for point in points]


def hypervolumes(points: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of each scene and role: how much our points dominate, and how much all baselines together do."""
    found = []
    for scene, role in dict.fromkeys((point["scene"], point["role"]) for point in points):
        of_it = [point for point in points if (point["scene"], point["role"]) == (scene, role)]
        worst = [1.1 * max(float(point["cost"]["value"]) for point in of_it), 1.0]
        ours = [point for point in of_it if not point["baseline"]]
        theirs = [point for point in of_it if point["baseline"] or point["name"] == "none"]
        found.append({
            "scene": scene, "role": role, "reference_point": worst,
            "ours": hypervolume(ours, worst), "baselines": hypervolume(theirs, worst),
        })  # fmt: skip
    return found


def about(settings: Settings) -> dict[str, Any]:
    """What is needed to measure the same again."""
    packages = ("numpy", "scipy", "mitsuba", "embreex", "libigl", "flip-evaluator")
    return {
        "sssgen": VERSION, "commit": _commit(), "versions": {name: _version(name) for name in packages},
        "seed": settings.seed, "samples": settings.samples, "device": "", "driver": "", "software": False,
    }  # fmt: skip


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _commit() -> str:
    """The commit of a checkout, '' elsewhere."""
    here = Path(__file__).parent
    try:
        found = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=here, capture_output=True, text=True, timeout=10, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return found.stdout.strip() if found.returncode == 0 else ""
