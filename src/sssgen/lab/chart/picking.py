"""Picks the cheapest chain within an error, or the most accurate chain within a cost.

A chain's error on a scene is the largest of its views, at the upper end of the error bar: two standard errors above the
measured value.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from sssgen.lab.chart.engine_conditions import EVERYTHING, Conditions, usable
from sssgen.lab.chart.record import Point, Record, front
from sssgen.lab.measure.candidates import is_constant, is_published, load, needs
from sssgen.lab.measure.measured_point import ViewError
from sssgen.support.diagnostics import failure


class Role(NamedTuple):
    """The choice for one role."""

    role: str
    technique: str
    """'' if the chain omits the role"""
    why: str


class Pick(NamedTuple):
    """The choice for a scene."""

    scene: str
    chain: Point | None
    """The point of the material; None for a scene without a medium"""
    coordinates: Point | None
    roles: tuple[Role, ...]
    cheaper: Point | None
    """The most accurate of the cheaper points"""
    better: Point | None
    """The cheapest of the more accurate points"""
    met: bool
    """Whether the choice is within the limit; if not, it is the nearest point"""
    excluded: Point | None = None
    """The point that would have been picked if the engine had everything; None if that is the same"""
    excluded_by: str = ""
    """The option that excludes it"""


def limit_of(point: Point) -> float:
    """The upper bound of a point's error: the largest upper end of its views' error bars."""
    errors: list[ViewError] = [*point["views"].values()] or [point["error"]]
    ends = [error.get("high") for error in errors]
    return max(math.inf if end is None else float(end) for end in ends)


def cost_of(point: Point) -> float:
    """The point's cost in the chart."""
    return float(point["cost"]["value"])


def pick(
    record: Record,
    scene: str,
    max_error: float | None,
    max_cost: float | None,
    conditions: Conditions = EVERYTHING,
) -> Pick:
    """The choice for a scene of a chart's record; one of the limits is None. Raises SssgenError without points."""
    points = [point for point in record["points"] if point["scene"] == scene and is_allowed(point)]
    everything = [point for point in points if point["role"] == "material"]
    materials = usable(everything, conditions)
    shifts = [point for point in points if point["role"] == "coordinates"]
    if not materials and not shifts:
        raise failure(f"the chart has no point of the scene '{scene}'", "chart it first: sssgen chart")
    chain, chain_met = choose(materials, max_error, max_cost)
    shift, shift_met = choose(shifts, max_error, max_cost)
    main = chain or shift
    assert main is not None
    front_points = front(materials or shifts)
    cheaper = max((point for point in front_points if cost_of(point) < cost_of(main)), key=cost_of, default=None)
    better = min((point for point in front_points if limit_of(point) < limit_of(main)), key=cost_of, default=None)
    roles = (_coordinates(shift, shifts), *_light(chain, materials))
    excluded, option = _excluded_point(everything, main, max_error, max_cost, conditions)
    met = chain_met and shift_met
    return Pick(scene, chain, shift, roles, cheaper, better, met, excluded, option)


def _excluded_point(
    points: Sequence[Point], main: Point, max_error: float | None, max_cost: float | None, conditions: Conditions
) -> tuple[Point | None, str]:
    """The point that is picked without the conditions, and the option that excludes it; None, '' if it is `main`."""
    best, _ = choose(points, max_error, max_cost)
    option = conditions.missing(best) if best is not None else ""
    return (best, option) if option else (None, "")


def is_allowed(point: Point) -> bool:
    """Whether a point may be picked: it has not failed, and contains no published technique (with errata)."""
    return not point["failed"] and not any(is_published(load(name)) for name in point["chain"])


def choose(points: Sequence[Point], max_error: float | None, max_cost: float | None) -> tuple[Point | None, bool]:
    """The cheapest point within the error, or the most accurate within the cost, and True.

    If there is none: the most accurate, or the cheapest, and False. None without points.
    """
    if not points:
        return None, True

    def by_cost(point: Point) -> tuple[float, float]:
        return cost_of(point), limit_of(point)

    def by_error(point: Point) -> tuple[float, float]:
        return limit_of(point), cost_of(point)

    if max_error is not None:
        within: list[Point] = [point for point in points if limit_of(point) <= max_error]
        key, fallback = by_cost, by_error
    else:
        assert max_cost is not None
        within = [point for point in points if cost_of(point) <= max_cost]
        key, fallback = by_error, by_cost
    return min(within or points, key=key if within else fallback), bool(within)


def _coordinates(shift: Point | None, shifts: Sequence[Point]) -> Role:
    if shift is None:
        return Role("coordinates", "", "omitted: there is no inlay below the surface")
    without = next((limit_of(point) for point in shifts if point["name"] == "none"), None)
    if shift["name"] == "none":
        return Role("coordinates", "", f"omitted: without it the relative error of the offset is {limit_of(shift):.3g}")
    more = f"; without it {without:.3g}" if without is not None else ""
    return Role("coordinates", shift["name"], f"the relative error of the offset is {limit_of(shift):.3g}{more}")


def _light(chain: Point | None, materials: Sequence[Point]) -> list[Role]:
    if chain is None:
        return []
    without = next(limit_of(point) for point in materials if point["name"] == "none")
    if not chain["chain"]:
        return [
            Role("thickness", "", "omitted: no technique reads it"),
            Role("translucency", "", f"omitted: the error without it is {without:.3g}"),
        ]
    names = chain["chain"]
    light = names[-1]
    roles = [Role("translucency", light, f"without transmitted light the error is {without:.3g}")]
    if path := chain.get("path", ""):
        inside = [point for point in materials if point.get("path") and point["path"] != path]
        other = min(map(limit_of, inside), default=None)
        why = f"the best chain with another one has the error {other:.3g}" if other is not None else needs(load(path))
        roles = [Role("light path", path, why), *roles]
    first = next((name for name in names if load(name).role == "thickness"), "")
    if not first:
        best = min(materials, key=limit_of)
        why = f"omitted: {light} reads no thickness; the best chain with one has the error {limit_of(best):.3g}"
        return [Role("thickness", "", why), *roles]
    constant = [point for point in materials if any(is_constant(load(name)) for name in point["chain"])]
    why = needs(load(first))
    if is_constant(load(first)):
        varying = [point for point in materials if point["chain"] and point not in constant]
        closest = min((limit_of(point) for point in varying), default=float("nan"))
        why = f"the same at every point; with a thickness that varies the error would be {closest:.3g}"
    elif constant:
        least = min(limit_of(point) for point in constant)
        why = f"with a constant thickness the error is {least:.3g}" + (f"; it needs {why}" if why else "")
    return [Role("thickness", first, why), *roles]
