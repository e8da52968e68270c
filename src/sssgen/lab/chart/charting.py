"""Fits and measures every candidate on every scene, and returns the record of a chart, for drawing and picking.

    record = chart_record([measured_scene.load("cube")], Settings())

The cache folder keeps the points of a scene and the results of an interrupted run.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple, TypedDict

from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.jobs.work_items import code_stamp
from sssgen.lab.chart.record import FORMAT, Measurement, Point, Record, SceneEntry, hypervolumes, on_fronts
from sssgen.lab.measure import candidates, fluence_inputs
from sssgen.lab.measure import scene_references as references
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_point import FittedChain, MeasuredPoint
from sssgen.lab.measure.measurement import View
from sssgen.lab.measure.problem import LENGTHS
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.scene_body import span
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.version import VERSION

WORTHWHILE = 0.5
"""Complete chains use a more expensive length that requires the same data if it lowers the training error to this
share. Chains combine two lengths, so that a larger share measures many chains that hardly differ."""

VIEWS = ("own", "held out")
"""The names of a scene's two views."""

LIT = frozenset(("translucency", "material"))
"""The roles whose reference is light transport."""

DEFAULTS = ("cube", "torus", "bracket", "capsule", "mouse", "inlay_plate", "inlay_ball", "inlay_torus")
"""The default scenes of a chart."""


class Settings(NamedTuple):
    """How to measure."""

    samples: int = references.SAMPLES
    """Per ray and channel of a scene's reference; the training scenes have half as many"""
    seed: int = 0
    roles: tuple[str, ...] = candidates.ROLES
    scheduler: str = ""
    processes: int | None = None
    progress_bar: Callable[[], AbstractContextManager[Progress]] = lambda: nullcontext(lambda *_: None)
    """Returns the progress bar of a stage of the work, as a context"""
    techniques: frozenset[str] = frozenset()
    """Of the candidates of translucency and of coordinates, those to measure; empty for all"""

    def cache_name(self, scene: MeasuredScene) -> str:
        """The file of a scene's points in the cache."""
        chosen = self.roles, sorted(self.techniques)
        key = repr((scene.key, self.samples, self.seed, chosen, code_stamp(__name__)))
        return f"chart-{cache.digest(key)}.json"


class ScenePoints(TypedDict):
    """A scene and its points, as the cache has them."""

    scene: SceneEntry
    points: list[Point]


def chart_record(scenes: Sequence[MeasuredScene], settings: Settings) -> Record:
    """The record of a chart: all points of these scenes, from the cache or measured.

    Raises SssgenError for scenes that cannot be measured, and for missing packages.
    """
    settings = settings._replace(roles=candidates.complete(settings.roles))
    by_key = {scene.key: cached_points(scene, settings) for scene in scenes}
    new = [scene for scene in {scene.key: scene for scene in scenes}.values() if by_key[scene.key] is None]
    if new:
        for scene, entry in zip(new, _measure(new, settings), strict=True):
            by_key[scene.key] = entry
            cache.write(settings.cache_name(scene), json.dumps(entry).encode())
    results = [result for scene in scenes if (result := by_key[scene.key])]
    points = [point for result in results for point in result["points"]]
    return record_of(settings, [result["scene"] for result in results], points)


def record_of(settings: Settings, scenes: list[SceneEntry], points: Sequence[Point]) -> Record:
    """The record of measured points."""
    charted = on_fronts(points)
    return {
        "format": FORMAT, "record": conditions(settings), "cost": "static", "cost_unit": "weighted operations",
        "scenes": scenes, "points": charted, "hypervolume": hypervolumes(charted),
    }  # fmt: skip


def cached_points(scene: MeasuredScene, settings: Settings) -> ScenePoints | None:
    """The scene's points from the cache, or None."""
    try:
        result: ScenePoints | None = json.loads(cache.read(settings.cache_name(scene)) or b"null")
    except ValueError:
        return None
    return result


def _measure(scenes: Sequence[MeasuredScene], settings: Settings) -> list[ScenePoints]:
    """Measures the points of scenes."""
    views = _views(scenes, settings)
    points: dict[str, list[Point]] = {scene.key: [] for scene in scenes}
    for role in settings.roles:
        if role == "material":
            continue
        jobs = [(scene, candidate) for scene in scenes for candidate in _candidates(role, scene, points[scene.key])]
        jobs = [job for job in jobs if applies(*job) and _is_selected(job[1], settings)]
        for scene, point in _points(jobs, views, settings, {}):
            points[scene.key].append(point)
    if "material" in settings.roles:
        jobs = []
        before: dict[tuple[str, Techniques, Counts], FittedParameters] = {}
        for scene in scenes:
            if scene.medium is not None:
                whole = candidates.materials(
                    useful_lengths(points[scene.key], candidates.thickness()),
                    useful_lengths(points[scene.key], candidates.view_thickness()),
                    useful_paths(points[scene.key]),
                )
                jobs += [(scene, candidate) for candidate in whole if applies(scene, candidate)]
                before |= {
                    (scene.key, *key): values for key, values in distance_function_parameters(points[scene.key]).items()
                }
        for scene, point in _points(jobs, views, settings, before):
            points[scene.key].append(point)
    return [
        {"scene": scene_entry(scene, [view.name for view in views[scene.key].training]), "points": points[scene.key]}
        for scene in scenes
    ]


def _candidates(role: str, scene: MeasuredScene, measured: Sequence[Point]) -> list[Candidate]:
    """The candidates of a role that apply to a scene; `measured` has its points of the roles before."""
    if role == "coordinates":
        return candidates.coordinates() if scene.inlay is not None else []
    if scene.medium is None:
        return []
    if role == "translucency":
        if not scene.lights:  # no point faces away from an environment
            return []
        charted = any(point["role"] == "thickness" for point in measured)
        return candidates.translucency(useful_paths(measured) if charted else None)
    return candidates.thickness() if role == "thickness" else candidates.view_thickness()


def applies(scene: MeasuredScene, candidate: Candidate) -> bool:
    """Whether a candidate is charted on a scene.

    Refraction only where the body refracts or a technique is for both, light that is baked without refraction only
    elsewhere, maps of lights from afar only where all lights are, and marches that reach through it.
    """
    if not candidates.reaches(candidate, span(scene.geometry)):
        return False
    if any(light.position is not None for light in scene.lights) and candidates.needs_distant_light(candidate):
        return False
    if candidate.role == "coordinates" or scene.medium is None:
        return True
    if scene.medium.ior == 1.0:
        return candidates.is_for_matched(candidate)
    return candidates.refracts(candidate) or not candidates.is_calibrated(candidate)


def _is_selected(candidate: Candidate, settings: Settings) -> bool:
    """Whether a candidate of one technique is to be measured."""
    wanted = settings.techniques
    return not wanted or candidate.role in LENGTHS or candidate.name in wanted


Techniques = tuple[str, ...]
Counts = tuple[tuple[str, int], ...]
FittedParameters = dict[str, tuple[float, ...]]
Before = Mapping[tuple[str, Techniques, Counts], FittedParameters]
"""(a scene's key, a technique, its settings) → the technique's parameters"""


class _Views(NamedTuple):
    own: tuple[View, ...]
    training: tuple[View, ...]


def _views(scenes: Sequence[MeasuredScene], settings: Settings) -> dict[str, _Views]:
    """Each scene's views and training views, with their references."""
    lit = bool(LIT.intersection(settings.roles))
    own = with_references({scene.key: two_views(scene) for scene in scenes}, settings, lit)
    training = {scene.key: references.training_scenes(scene) if scene.medium is not None else [] for scene in scenes}
    cheap = settings._replace(samples=settings.samples // 2)
    named = {key: [(scene.name, scene) for scene in group] for key, group in training.items()}
    lit_views = with_references(named, cheap, lit)
    plates = {scene.key: (View("plate", references.plate(scene)),) for scene in scenes if scene.inlay is not None}
    return {scene.key: _Views(own[scene.key], lit_views[scene.key] + plates.get(scene.key, ())) for scene in scenes}


def two_views(scene: MeasuredScene) -> list[tuple[str, MeasuredScene]]:
    """A scene's two views with their names."""
    return list(zip(VIEWS, (scene, scene.held_out()), strict=True))


def with_references(
    named: Mapping[str, Sequence[tuple[str, MeasuredScene]]], settings: Settings, lit: bool = True
) -> dict[str, tuple[View, ...]]:
    """The named views of each group; if `lit`, with their references by light transport."""
    lit_scenes = list({scene.key: scene for group in named.values() for _, scene in group if lit}.values())
    results = results_of(references.items(lit_scenes, settings.samples, settings.seed), settings)
    by_scene = references.by_scene(lit_scenes, results)
    stamp = f"{settings.samples} {settings.seed}"
    return {
        key: tuple(View(name, scene, tuple(by_scene.get(scene.key, ())), stamp) for name, scene in group)
        for key, group in named.items()
    }


def _points(
    jobs: Sequence[tuple[MeasuredScene, Candidate]], views: dict[str, _Views], settings: Settings, before: Before
) -> Iterable[tuple[MeasuredScene, Point]]:
    """The points of the jobs. Scenes with the same training views share the fit.

    `before` has the parameters of first techniques that are fitted already.
    """
    fits = [
        Item(
            "sssgen.lab.measure.measurement:fit_candidate",
            (
                candidate,
                _training_views(candidate, views[scene.key]),
                before.get((scene.key, candidate.techniques[:1], candidate.settings)),
            ),
            f"fit {candidate.label}",
        )
        for scene, candidate in jobs
    ]
    fitted: list[FitResult] = results_of(fits, settings)
    bodies = {scene.key: scene for scene, candidate in jobs if candidates.reads_fluence(candidate)}
    for scene in bodies.values():
        with settings.progress_bar() as progress:
            fluence_inputs.prepare(scene, settings.scheduler, settings.processes, progress)
    measures = [
        Item(
            "sssgen.lab.measure.measurement:measure_candidate",
            (candidate, fit, views[scene.key].own),
            f"{candidate.label} on {scene.name}",
        )
        for (scene, candidate), fit in zip(jobs, fitted, strict=True)
    ]
    points: list[MeasuredPoint] = results_of(measures, settings)
    for (scene, _), point in zip(jobs, points, strict=True):
        yield scene, {"scene": scene.name, **point}


def candidate_of(point: FittedChain) -> Candidate:
    """The candidate of a point."""
    settings, chain = tuple(point["settings"].items()), tuple(point["chain"])
    path, path_settings = point.get("path", ""), tuple(point.get("path_settings", {}).items())
    return Candidate(
        point["role"], point["name"], point["label"], settings, chain, point["baseline"], path, path_settings
    )


def fit_of(point: FittedChain) -> FitResult:
    """The result of a point's fit."""
    parameters = {name: tuple(value) for name, value in point["parameters"].items()}
    return FitResult(parameters, tuple(point["scale"]), tuple(point["matte"]), point["training_error"], point["factor"])


def _training_views(candidate: Candidate, views: _Views) -> tuple[View, ...]:
    on_plate = candidate.role == "coordinates"
    return tuple(view for view in views.training if (view.name == "plate") == on_plate)


def results_of(items: Sequence[Item], settings: Settings) -> list[Any]:
    """The items' results. Raises SssgenError with all failures."""
    with settings.progress_bar() as progress:
        results = run(items, settings.scheduler, settings.processes, progress=progress)
    raise_failures([result for result in results if isinstance(result, Failure)])
    return results


def raise_failures(failures: Sequence[Failure]) -> None:
    """Raises SssgenError with all failures, if there are any."""
    failed: dict[tuple[str, str], dict[str, None]] = {}
    for result in failures:
        failed.setdefault((result.message, result.hint), {})[result.name] = None
    if failed:
        diagnostics = []
        for (message, hint), names in failed.items():  # an error of a scene appears in all of its items
            first, more = next(iter(names)), f" and {len(names) - 1} more" if len(names) > 1 else ""
            diagnostics.append(failure(f"{first}{more}: {message}", hint).diagnostics[0])
        raise SssgenError(diagnostics)


def distance_function_parameters(
    points: Sequence[Point],
) -> dict[tuple[Techniques, Counts], FittedParameters]:
    """The fitted parameters of the lengths that evaluate a distance function: by technique and settings.

    Complete chains use them unchanged, because fitting them again in each chain would take hours.
    """
    parameters: dict[tuple[Techniques, Counts], FittedParameters] = {}
    best: dict[tuple[Techniques, Counts], float] = {}
    for point in points:
        technique = candidates.load(point["chain"][0]) if point["role"] in LENGTHS else None
        if technique is None or not technique.slots:
            continue
        key = (technique.name,), tuple(point["settings"].items())
        if point["training_error"] < best.get(key, float("inf")):
            best[key] = point["training_error"]
            parameters[key] = {name: tuple(value) for name, value in point["parameters"].items()}
    return parameters


def useful_paths(points: Sequence[Point]) -> list[Candidate]:
    """The useful thicknesses among those that can be measured from a point inside the body."""
    return useful_lengths(points, list(filter(candidates.fits_path, candidates.thickness())))


def useful_lengths(points: Sequence[Point], lengths: Sequence[Candidate]) -> list[Candidate]:
    """Those of `lengths` for complete chains: of those that require the same data the cheapest, and more expensive ones
    with a lower error.

    The training error decides, not the error on the scene.
    """
    by_label = {(candidate.role, candidate.label): candidate for candidate in lengths}
    groups: dict[tuple[str, ...], list[Point]] = {}
    for point in points:
        if (point["role"], point["label"]) in by_label:
            groups.setdefault(tuple(point["requires"]), []).append(point)
    chosen = []
    for group in groups.values():
        best = float("inf")
        for point in sorted(group, key=lambda point: float(point["cost"]["value"])):
            if point["training_error"] < WORTHWHILE * best:
                best = point["training_error"]
                chosen.append(by_label[point["role"], point["label"]])
    return chosen


def scene_entry(scene: MeasuredScene, fitted_to: list[str]) -> SceneEntry:
    """A scene's entry in the record, with the names of its training views."""
    entry: SceneEntry = {"name": scene.name, "title": scene.title, "key": scene.key}
    if (medium := scene.medium) is not None:
        entry["medium"] = {
            "name": medium.name, "albedo": list(medium.albedo), "extinction": list(medium.extinction),
            "ior": medium.ior, "roughness": medium.roughness,
        }  # fmt: skip
        entry["lights"] = scene.lit_by
        entry["fitted_to"] = fitted_to
    return entry


def conditions(settings: Settings) -> Measurement:
    """The conditions for repeating the measurement: versions, seed, samples."""
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
    """The commit of a checkout, otherwise ''."""
    folder = Path(__file__).parent
    try:
        result = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, timeout=10, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return result.stdout.strip() if result.returncode == 0 else ""
