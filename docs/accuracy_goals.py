"""The goals of docs/accuracy.md, with what a chart's record shows of them."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import median
from typing import NamedTuple

from sssgen.lab.chart.picking import choose, is_allowed, limit_of
from sssgen.lab.chart.record import Point, Record, measures
from sssgen.lab.gpu.gpu_timing import TimesRecord

FIXED = "fixed-light"


class InteriorTimes(TimesRecord):
    """The times of chains that know the light inside a body."""

    added_ms: float
    """What the published thinness adds to its scene"""
    of_thinness: dict[str, float]
    """The times of chains, by label, relative to `added_ms`"""


class Goal(NamedTuple):
    """A median error over the scenes that some chain reaches within a cost."""

    error: float
    cost: float
    fixed: bool
    """Whether the light may be fixed to the body"""


GOALS = (
    Goal(0.31, 120, False), Goal(0.25, 250, False), Goal(0.16, 500, False),
    Goal(0.09, 400, True), Goal(0.06, 1000, True),
)  # fmt: skip
VOLUMES = {"translucency": 1.5, "material": 3.0}
"""How often the hypervolume of all baselines together fits into the library's."""
VOLUME_WITH_BOUNDARY = 2.0
"""The same of materials with a refracting boundary"""
NOTABLE = 0.98
"""The largest ratio of an error to that of the cheaper chains for which a chain is listed."""
PICKED = 0.15
BOUNDARY = 1.25
"""The largest ratio of an error with a refracting boundary and the goal."""


GPU_GOALS = {
    "interior_octaves": 0.06, "fluence_relit": 0.10, "fluence_factored_4": 0.125, "fluence_factored_8": 0.125,
}  # fmt: skip
"""A chain's last technique, and the largest share of the time that the published thinness adds to its scene."""


def table(record: Record, bent: Record | None, interior: InteriorTimes) -> str:
    """The goals; `bent` has the same bodies with a refracting boundary, if they are measured, `interior` the times on a
    GPU."""
    rows = ["| goal | measured | |", "|---|---|---|"]
    rows += [_goal("median error", goal, record) for goal in GOALS]
    if bent is not None:
        bent_goals = [goal._replace(error=round(BOUNDARY * goal.error, 4)) for goal in GOALS]
        rows += [_goal("median error with the boundary", goal, bent) for goal in bent_goals]
    rows += [_volume(f"hypervolume of {role}", record, role, factor) for role, factor in VOLUMES.items()]
    if bent is not None:
        rows.append(_volume("hypervolume of material with the boundary", bent, "material", VOLUME_WITH_BOUNDARY))
    within = {}
    for scene in lit(record):
        points = [point for point in record["points"] if point["scene"] == scene and point["role"] == "material"]
        point, met = choose(list(filter(is_allowed, points)), PICKED, None)
        assert point is not None
        within[scene] = (met, limit_of(point))
    good = sum(met for met, _ in within.values())
    missed = ", ".join(f"{scene} {error:.3f}" for scene, (met, error) in within.items() if not met)
    text = f"{good} of {len(within)}" + (f"; the smallest error elsewhere: {missed}" if missed else "")
    for technique, share in GPU_GOALS.items():
        (label,) = (name for name in interior["of_thinness"] if _last_technique(name) == technique)
        ratio = interior["of_thinness"][label]
        name = (
            f"{label}: at most {share:g} of the time that the published thinness of 30 taps adds to its scene, on a GPU"
        )
        rows.append(_row(name, f"{ratio:.3f}", ratio <= share))
    rows.append(_row(f"`pick --max-error {PICKED:g}` has an answer on 5 of 6 scenes", text, good >= 5))
    return "\n".join(rows)


def _volume(name: str, record: Record, role: str, factor: float) -> str:
    ratios = {
        entry["scene"]: entry["ours"] / max(entry["baselines"], 1e-9)
        for entry in record["hypervolume"]
        if entry["role"] == role and entry["scene"] in lit(record)
    }
    good = sum(ratio >= factor for ratio in ratios.values())
    listed = ", ".join(f"{scene} {ratio:.2f}" for scene, ratio in ratios.items())
    return _row(
        f"{name} ≥ {factor:g} × that of all baselines, on each scene", f"{good} of {len(ratios)}: {listed}",
        good == len(ratios),
    )  # fmt: skip


def _last_technique(label: str) -> str:
    return label.split(" → ")[-1].split(" by ")[0]


class Chain(NamedTuple):
    """A whole material that is measured on all bodies."""

    cost: float
    """The largest on the bodies; chains that evaluate a body's distance function depend on it"""
    error: float
    """The median over the bodies"""
    label: str
    points: Mapping[str, Point]
    """By body"""

    @property
    def baseline(self) -> bool:
        """Whether it is a published shader."""
        return any(point["baseline"] for point in self.points.values())

    @property
    def moving(self) -> bool:
        """Whether the light may move relative to the body."""
        return all(FIXED not in point["requires"] for point in self.points.values())


def chains(record: Record, fixed: bool) -> list[Chain]:
    """The chains that are measured on all bodies, by cost; `fixed` as in Goal."""
    scenes = lit(record)
    found = [
        Chain(
            max(float(point["cost"]["value"]) for point in points.values()),
            median(measures(point)[1] for point in points.values()), label, points,
        )
        for label, points in _by_label(record).items()
        if len(points) == len(scenes)
    ]  # fmt: skip
    return sorted((chain for chain in found if fixed or chain.moving), key=lambda chain: chain[:3])


def medians(record: Record, fixed: bool) -> str:
    """The chains with the smallest median error of all that are not more expensive; `fixed` as in Goal."""
    scenes = lit(record)
    rows = [
        f"| cost | median | {' | '.join(scenes)} | requires | chain |",
        f"|---:|---:|{'---:|' * len(scenes)}---|---|",
    ]
    least = float("inf")
    for cost, error, label, points in chains(record, fixed):
        if error >= NOTABLE * least:
            continue
        least = error
        errors = " | ".join(f"{points[scene]['error']['value']:.3f}" for scene in scenes)
        requires = ", ".join(next(iter(points.values()))["requires"])
        published = " (published)" if next(iter(points.values()))["baseline"] else ""
        rows.append(f"| {cost:.0f} | {error:.3f} | {errors} | {requires} | {label}{published} |")
    return "\n".join(rows)


def lit(record: Record) -> list[str]:
    """The bodies, which have a medium."""
    return [scene["name"] for scene in record["scenes"] if "medium" in scene]


def _by_label(record: Record) -> dict[str, dict[str, Point]]:
    """label → scene → the point of the material, without points that failed."""
    result: dict[str, dict[str, Point]] = {}
    for point in record["points"]:
        if point["role"] == "material" and not point["failed"]:
            result.setdefault(point["label"], {})[point["scene"]] = point
    return result


def _reached(record: Record, goal: Goal) -> tuple[str, bool]:
    """The smallest median within the cost, as text, and whether it is within the goal."""
    allowed = [
        chain
        for chain in chains(record, goal.fixed)
        if chain.cost <= goal.cost and not chain.baseline and all(map(is_allowed, chain.points.values()))
    ]
    if not allowed:
        return "no chain", False
    best = min(allowed, key=lambda chain: (chain.error, chain.cost, chain.label))
    return f"{best.error:.4f} at {best.cost:.0f}: {best.label}", best.error <= goal.error


def _goal(name: str, goal: Goal, record: Record) -> str:
    light = ", with a light that is fixed to the body" if goal.fixed else ""
    return _row(f"{name} ≤ {goal.error:g} for at most {goal.cost:g} operations{light}", *_reached(record, goal))


def _row(name: str, measured: str, met: bool) -> str:
    return f"| {name} | {measured} | {'reached' if met else '**missed**'} |"
