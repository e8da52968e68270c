"""Measures a scene for one pick: chains race by the rule of `race`, so that few of them are measured fully.

    with ProgressBar() as bar:
        progress = WholeProgress(bar, STAGES)
        result = race_record(measured_scene.load("cube"), Settings(), Limits(max_error=0.15), progress)

Fits use small training views with few samples. What is expensive comes late: light is baked, and lengths are fitted,
only where a chain that needs them is still in the race. Every item's result is stored, so that an interrupted race
continues.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from typing import NamedTuple

from sssgen.jobs.executor import Failure, Item, completed
from sssgen.jobs.work_items import code_stamp
from sssgen.lab.chart import charting, drawn_lights, race
from sssgen.lab.chart.case_errors import CaseErrors, errors
from sssgen.lab.chart.charting import Settings, fit_of, results_of, two_views, with_references
from sssgen.lab.chart.engine_conditions import EVERYTHING, Conditions
from sssgen.lab.chart.levels import Goal, low_of, seen_at
from sssgen.lab.chart.picking import choose, is_allowed, limit_of
from sssgen.lab.chart.record import Point, Record, check_record
from sssgen.lab.chart.whole_progress import WholeProgress
from sssgen.lab.measure import candidates, fluence_inputs
from sssgen.lab.measure import scene_references as references
from sssgen.lab.measure.candidates import Candidate
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measured_point import MeasuredPoint, PointCost
from sssgen.lab.measure.measurement import Price, View
from sssgen.lab.measure.problem import LENGTHS
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support import cache

FIRST = 128
"""Samples of the first level, which are the fewest of a reference by Mitsuba; each level has twice as many."""
TRAINING_SIDE = 24
"""The side of the training views: about the lanes that a fit uses."""
LIGHTS = 6
"""Lights that are drawn at random: in the race for light that moves, and again as many for the error beside it."""
TIERS = (150.0, 400.0, 1600.0, float("inf"))
"""The operations of lengths that are fitted together: expensive ones only where no chain with a cheap one is enough."""
NO_BAKE, LIGHT, DIRECTIONS = range(3)
"""The light that a chain needs baked: none, that of the scene's lights, that of all directions."""
STAGES = {
    "references": 15, "alone": 10, "lengths": 20, "chains": 20, "bakes": 10, "samples": 10, "lights": 10, "picture": 5,
}  # fmt: skip
"""The stages of a pick and their shares of its time, in percent, as profiles have them."""


class Limits(NamedTuple):
    """What is picked; one of both limits is None. With goals, the error is that of each of them."""

    max_error: float | None = None
    max_cost: float | None = None
    conditions: Conditions = EVERYTHING
    cost: Callable[[PointCost], float] | None = None
    """The cost of static counts; None for the weighted operations"""
    cost_name: str = ""
    """Differs between functions that differ"""
    goals: tuple[Goal, ...] = ()
    """The distances of a budget"""

    @property
    def rows(self) -> tuple[int, ...]:
        """The sizes at which errors are measured."""
        return tuple(dict.fromkeys(goal.rows for goal in self.goals))


class Provisional(NamedTuple):
    """The answer of an unfinished race."""

    point: Point
    seconds: float
    """Since the race began"""
    met: bool
    """Whether it is within the limit; if not, it is the nearest so far, before something that takes long"""


Report = Callable[[Provisional], None]


@dataclasses.dataclass(eq=False)
class Runner:
    """A chain in the race."""

    candidate: Candidate
    price: Price
    cost: float
    point: Point | None = None
    level: int = 0

    def entrant(self, rows: int | None = None) -> race.Entrant:
        """The chain as the rule sees it, at the size `rows`."""
        if self.point is None:
            return race.Entrant(self.cost)
        if self.point["failed"]:
            return race.Entrant(self.cost, self.level, float("inf"))
        point = self.point if rows is None else seen_at(self.point, rows)
        return race.Entrant(self.cost, self.level, low_of(point), limit_of(point))

    def baked_light(self) -> int:
        if not candidates.reads_fluence(self.candidate):
            return NO_BAKE
        return LIGHT if "fixed-light" in self.price.requires else DIRECTIONS


def race_record(
    scene: MeasuredScene,
    settings: Settings,
    limits: Limits,
    progress: WholeProgress,
    report: Report = lambda _: None,
) -> Record:
    """The record of the chains that were measured for this pick, from the cache or measured. Raises SssgenError."""
    name = _cache_name(scene, settings, limits)
    try:
        stored = json.loads(cache.read(name) or b"null")
    except ValueError:
        stored = None
    if stored is not None:
        return check_record(stored)
    points = _Race(scene, settings, limits, report, progress).run()
    if scene.inlay is not None:
        points += charting.chart_record([scene], settings._replace(roles=("coordinates",)))["points"]
    training = [one.name for one in references.training_scenes(scene)]
    record = charting.record_of(settings, [charting.scene_entry(scene, training)], points)
    cache.write(name, json.dumps(record).encode())
    return record


def is_stored(scene: MeasuredScene, settings: Settings, limits: Limits) -> bool:
    """Whether the race has been run."""
    return bool(cache.read(_cache_name(scene, settings, limits)))


def _cache_name(scene: MeasuredScene, settings: Settings, limits: Limits) -> str:
    chosen = limits.max_error, limits.max_cost, limits.conditions, limits.cost_name, limits.goals
    return f"race-{cache.digest(repr((scene.key, settings.samples, settings.seed, chosen, code_stamp(__name__))))}.json"


def levels(samples: int) -> list[int]:
    """The samples of each level."""
    result = [min(FIRST, samples)]
    while result[-1] < samples:
        result.append(min(2 * result[-1], samples))
    return result


def unseen_errors(scene: MeasuredScene, point: Point, settings: Settings, first: int = 0) -> CaseErrors | None:
    """The errors of a chain under lights that neither its fit nor its race used; None for one that needs its light
    baked. The first `first` lights are left out."""
    if "fixed-light" in point["requires"]:
        return None
    half = small(scene)
    views = drawn_lights.drawn_views([half], LIGHTS, settings, first)
    return errors([half], [point], {half.key: drawn_lights.cases_of(views[half.key])}, settings)[half.key][0]


def small(scene: MeasuredScene) -> MeasuredScene:
    """The scene in half of its size: there are many lights."""
    width, height = scene.size
    return dataclasses.replace(scene, size=(max(width // 2, 8), max(height // 2, 8)))


class _Race:
    def __init__(
        self, scene: MeasuredScene, settings: Settings, limits: Limits, report: Report, progress: WholeProgress
    ) -> None:
        self.scene, self.settings, self.limits = scene, settings, limits
        self.report, self.progress = report, progress
        self.levels = levels(settings.samples)
        self.own: dict[int, tuple[View, ...]] = {}
        self.training: tuple[View, ...] = ()
        self.before: dict[tuple[charting.Techniques, charting.Counts], charting.FittedParameters] = {}
        self.runners: list[Runner] = []
        self.lengths: list[tuple[Candidate, Price]] | None = None
        self.fitted: list[Point] = []
        self.tier = 0
        self.best: Runner | None = None
        """The best chain within the limit so far"""
        self.nearest = ""
        """The label of the chain that was reported while none was within the limit"""

    def run(self) -> list[Point]:
        """The points of the chains that were measured."""
        self._trace_training()
        self._views(1)
        self._add(candidates.materials([]), "alone")
        while (wanted := self._next()) or self._needs_lengths([]):
            new = [runner for runner in wanted if runner.level == 0]
            plain = [runner for runner in new if runner.baked_light() == NO_BAKE]
            if plain:
                self._measure_first(plain, NO_BAKE)
            elif self._needs_lengths(new):
                if self.tier:
                    self._report_nearest()
                self._add_lengths()
            elif new:
                self._report_nearest()
                kind = min(runner.baked_light() for runner in new)
                self._measure_first([runner for runner in new if runner.baked_light() == kind], kind)
            else:
                self._measure_again(wanted)
        return [runner.point for runner in self.runners if runner.point is not None]

    def _next(self) -> list[Runner]:
        """The chains to measure next, by the rule of the race."""
        last = len(self.levels)
        if self.limits.goals:
            return self._next_of_goals(last)
        entrants = [runner.entrant() for runner in self.runners]
        if self.limits.max_error is not None:
            return [self.runners[number] for number in race.within_error(entrants, self.limits.max_error, last)]
        assert self.limits.max_cost is not None
        return [self.runners[number] for number in race.within_cost(entrants, self.limits.max_cost, last)]

    def _next_of_goals(self, last: int) -> list[Runner]:
        """The chains to measure next for all goals of a budget together: those of the lowest level, the cheapest
        first."""
        assert self.limits.max_error is not None
        wanted: set[int] = set()
        for goal in self.limits.goals:
            entrants = [runner.entrant(goal.rows) for runner in self.runners]
            wanted.update(race.within_budget(entrants, goal.max_cost, self.limits.max_error, last))
        runners = sorted((self.runners[number] for number in wanted), key=lambda runner: runner.cost)
        level = min((runner.level for runner in runners), default=0)
        return [runner for runner in runners if runner.level == level]

    # --- what is measured ---

    def _trace_training(self) -> None:
        scenes = [(one.name, one) for one in references.training_scenes(self.scene, TRAINING_SIDE)]
        few = self._settings("references", 0.5)._replace(samples=max(min(FIRST, self.settings.samples // 2), 2))
        self.training = with_references({"": scenes}, few)[""]

    def _views(self, level: int) -> tuple[View, ...]:
        """The views that count for the limit, with the samples of a level."""
        if level not in self.own:
            stage, part = ("references", 0.5) if level == 1 else ("samples", 1.0 / len(self.levels))
            settings = self._settings(stage, part)._replace(samples=self.levels[level - 1])
            views = list(with_references({"": two_views(self.scene)}, settings)[""])
            if self.limits.conditions.light == "moving":
                (drawn,) = drawn_lights.drawn_views([small(self.scene)], LIGHTS, settings).values()
                for number, lit in enumerate(drawn_lights.cases_of(drawn)):
                    views += [view._replace(name=f"light {number + 1}, {view.name}") for view in lit]
            self.own[level] = tuple(views)
        return self.own[level]

    def _add(self, chains: Iterable[Candidate], stage: str) -> None:
        """Adds chains that can be used and are not in the race."""
        present = {runner.candidate for runner in self.runners}
        fresh = [
            candidate
            for candidate in chains
            if candidate not in present and self._applies(candidate) and not has_published(candidate)
        ]
        for candidate, price in zip(fresh, self._prices(fresh, stage), strict=True):
            if not self._lacks(candidate, price):
                self.runners.append(Runner(candidate, price, self._cost(price)))

    def _needs_lengths(self, new: Sequence[Runner]) -> bool:
        """Whether chains with more expensive lengths come next: such a chain can cost less than the answer so far and
        than the chains that wait for a bake."""
        if self.tier == len(TIERS):
            return False
        least = self._least_cost()
        return least < self._cost_limit() and all(least < runner.cost for runner in new)

    def _least_cost(self) -> float:
        """The cost of the cheapest length that is not fitted yet."""
        if self.lengths is None:
            lengths = [*candidates.thickness(), *candidates.view_thickness()]
            lengths = [one for one in lengths if self._applies(one) and not has_published(one)]
            prices = self._prices(lengths, "lengths")
            self.lengths = [pair for pair in zip(lengths, prices, strict=True) if not self._lacks(*pair)]
        floor = TIERS[self.tier - 1] if self.tier else 0.0
        costs = [self._cost(price) for _, price in self.lengths if price.cost["value"] > floor]
        return min(costs, default=float("inf"))

    def _add_lengths(self) -> None:
        """Fits the lengths of the next tier, and adds the chains that have them."""
        assert self.lengths is not None
        floor, ceiling = TIERS[self.tier - 1] if self.tier else 0.0, TIERS[self.tier]
        self.tier += 1
        priced = [
            (length, price)
            for length, price in self.lengths
            if floor < price.cost["value"] <= ceiling and self._cost(price) < self._cost_limit()
        ]
        items = [_fit_item(length, self._unlit_training()) for length, _ in priced]
        fits: list[FitResult] = results_of(items, self._settings("lengths", 0.4))
        self.fitted += [_fitted_length(*pair, fit) for pair, fit in zip(priced, fits, strict=True)]
        self.before = charting.distance_function_parameters(self.fitted)
        all_lengths = [length for length, _ in self.lengths]
        useful = charting.useful_lengths(self.fitted, all_lengths)
        thick = [length for length in useful if length.role == "thickness"]
        views = [length for length in useful if length.role != "thickness"]
        self._add(candidates.materials(thick, views, charting.useful_paths(self.fitted)), "chains")

    def _measure_first(self, runners: Sequence[Runner], kind: int) -> None:
        """Bakes, fits and measures chains that need the same light baked, the cheapest first."""
        if kind != NO_BAKE:
            body = self.scene if kind == LIGHT else dataclasses.replace(self.scene, lights=())
            scheduler, processes = self.settings.scheduler, self.settings.processes
            progress = self.progress.part("bakes")
            fluence_inputs.prepare(body, scheduler, processes, progress, directions=kind == DIRECTIONS)
        self._measure(runners, [self._first_item(runner) for runner in runners], 1)

    def _first_item(self, runner: Runner) -> Item:
        candidate = runner.candidate
        calibrated = candidates.is_calibrated(candidate)
        training = () if calibrated else self.training
        before = self.before.get((candidate.techniques[:1], candidate.settings))
        arguments = (candidate, training, before, self._views(1), self.limits.rows)
        return Item("sssgen.lab.measure.measurement:fit_and_measure", arguments, candidate.label)

    def _measure_again(self, runners: Sequence[Runner]) -> None:
        """Measures fitted chains with the samples of the next level."""
        level = runners[0].level + 1
        items = []
        for runner in runners:
            assert runner.point is not None
            arguments = (runner.candidate, fit_of(runner.point), self._views(level), False, self.limits.rows)
            items.append(Item("sssgen.lab.measure.measurement:measure_candidate", arguments, runner.candidate.label))
        self._measure(runners, items, level)

    def _measure(self, runners: Sequence[Runner], items: Sequence[Item], level: int) -> None:
        stage = "samples" if level > 1 else "chains" if self.tier else "alone"
        settings, failed = self._settings(stage, 0.5), []
        with settings.progress_bar() as progress:
            results = completed(items, settings.scheduler, settings.processes, progress=progress)
            with closing(results):
                for number, result in results:
                    if isinstance(result, Failure):
                        failed.append(result)
                        continue
                    runner = runners[number]
                    measured: MeasuredPoint = result
                    point: Point = {"scene": self.scene.name, **measured}
                    runner.point, runner.level = point, level
                    self._report()
                    if not any(other in runners and other.level < level for other in self._next()):
                        break
        charting.raise_failures(failed)

    def _report(self) -> None:
        """Reports the best chain so far, if it is a new one and there is one for all distances."""
        if self.limits.goals:
            return
        best, met = choose(self._points(), self.limits.max_error, self.limits.max_cost)
        runner = self._runner_of(best) if best is not None and met else None
        if runner is not None and (self.best is None or runner.candidate != self.best.candidate):
            assert best is not None
            self.report(Provisional(best, self.progress.seconds, True))
        self.best = runner

    def _report_nearest(self) -> None:
        """Reports the nearest chain so far where none is within the limit, before something that takes long."""
        if self.limits.goals:
            return
        best, met = choose(self._points(), self.limits.max_error, self.limits.max_cost)
        if best is not None and not met and best["label"] != self.nearest:
            self.nearest = best["label"]
            self.report(Provisional(best, self.progress.seconds, False))

    def _runner_of(self, point: Point) -> Runner:
        return next(one for one in self.runners if one.point is not None and one.point["label"] == point["label"])

    def _points(self) -> list[Point]:
        points = [runner.point for runner in self.runners if runner.point is not None and is_allowed(runner.point)]
        cost = self.limits.cost
        if cost is None:
            return points
        return [{**point, "cost": {**point["cost"], "value": cost(point["cost"])}} for point in points]

    # --- what is known of a candidate ---

    def _prices(self, chains: Sequence[Candidate], stage: str) -> list[Price]:
        items = [
            Item("sssgen.lab.measure.measurement:price", (candidate, self.scene), f"cost of {candidate.label}")
            for candidate in chains
        ]
        return results_of(items, self._settings(stage, 0.2))

    def _cost(self, price: Price) -> float:
        return self.limits.cost(price.cost) if self.limits.cost is not None else float(price.cost["value"])

    def _cost_limit(self) -> float:
        """The cost from which a chain cannot be the answer."""
        if self.limits.goals:
            return max(map(self._cost_limit_of, self.limits.goals))
        if self.limits.max_cost is not None:
            return self.limits.max_cost
        return self.best.cost if self.best is not None else float("inf")

    def _cost_limit_of(self, goal: Goal) -> float:
        """The same for one distance."""
        assert self.limits.max_error is not None
        entrants = [runner.entrant(goal.rows) for runner in self.runners]
        inside = [entrant.cost for entrant in entrants if entrant.high <= self.limits.max_error]
        return min((*inside, goal.max_cost))

    def _lacks(self, candidate: Candidate, price: Price) -> bool:
        """Whether the engine lacks what a chain needs."""
        return bool(self.limits.conditions.missing(_unmeasured(candidate, price)))

    def _applies(self, candidate: Candidate) -> bool:
        wanted, last = self.settings.techniques, candidate.techniques[-1:]
        selected = not wanted or candidate.role in LENGTHS or not last or last[0] in wanted
        return selected and charting.applies(self.scene, candidate)

    def _unlit_training(self) -> tuple[View, ...]:
        """The training views of lengths, which have no reference by light transport."""
        return tuple(view._replace(references=(), stamp="") for view in self.training)

    def _settings(self, stage: str, part: float) -> Settings:
        return self.progress.of(self.settings, stage, part)


def has_published(candidate: Candidate) -> bool:
    """Whether a chain contains a published form, which is never picked."""
    return any(candidates.is_published(candidates.load(name)) for name in candidate.techniques)


def _fit_item(candidate: Candidate, training: tuple[View, ...]) -> Item:
    return Item("sssgen.lab.measure.measurement:fit_candidate", (candidate, training, None), f"fit {candidate.label}")


def _unmeasured(candidate: Candidate, price: Price) -> Point:
    """The point of a candidate that is not measured."""
    return {
        "scene": "", "role": candidate.role, "name": candidate.name, "label": candidate.label,
        "settings": dict(candidate.settings), "chain": list(candidate.techniques), "path": candidate.path,
        "path_settings": dict(candidate.path_settings), "requires": list(price.requires), "bytes": price.bytes,
        "cost": price.cost, "error": {"value": None},
    }  # fmt: skip


def _fitted_length(candidate: Candidate, price: Price, fit: FitResult) -> Point:
    point = _unmeasured(candidate, price)
    point["parameters"] = {name: list(value) for name, value in fit.parameters.items()}
    point["training_error"] = fit.error
    return point
