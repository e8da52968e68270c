"""Picks the cheapest chain within an error, or the most accurate chain within a cost.

A chain's error on a scene is the largest of its views, at the upper end of the error bar: two standard errors above the
measured value.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.lab.chart.record import front
from sssgen.lab.measure.candidates import is_constant, is_published, load, needs
from sssgen.support.diagnostics import failure

Point = Mapping[str, Any]


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
    """Whether the choice is within the limit; otherwise it is the nearest to it"""


def limit_of(point: Point) -> float:
    """The upper bound of a point's error, see the module."""
    views = point["views"].values()
    return max((float(view["high"]) for view in views), default=float(point["error"]["high"]))


def cost_of(point: Point) -> float:
    """The point's cost in the chart."""
    return float(point["cost"]["value"])


def pick(record: Mapping[str, Any], scene: str, max_error: float | None, max_cost: float | None) -> Pick:
    """The choice for a scene of a chart's record; one of the limits is None. Raises SssgenError without points."""
    points = [point for point in record["points"] if point["scene"] == scene and allowed(point)]
    materials = [point for point in points if point["role"] == "material"]
    slides = [point for point in points if point["role"] == "coordinates"]
    if not materials and not slides:
        raise failure(f"the chart has no point of the scene '{scene}'", "chart it first: sssgen chart")
    chain, chain_met = chosen(materials, max_error, max_cost)
    slide, slide_met = chosen(slides, max_error, max_cost)
    main = chain or slide
    assert main is not None
    line = front(materials or slides)
    cheaper = max((point for point in line if cost_of(point) < cost_of(main)), key=cost_of, default=None)
    better = min((point for point in line if limit_of(point) < limit_of(main)), key=cost_of, default=None)
    roles = (_coordinates(slide, slides), *_light(chain, materials))
    return Pick(scene, chain, slide, roles, cheaper, better, chain_met and slide_met)


def allowed(point: Point) -> bool:
    """Whether a point may be picked: it has not failed, and contains no baseline, which has its source's errata."""
    return not point["failed"] and not any(is_published(load(name)) for name in point["chain"])


def chosen(points: Sequence[Point], max_error: float | None, max_cost: float | None) -> tuple[Point | None, bool]:
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
        best, otherwise = by_cost, by_error
    else:
        assert max_cost is not None
        within = [point for point in points if cost_of(point) <= max_cost]
        best, otherwise = by_error, by_cost
    key: Callable[[Point], tuple[float, float]] = best if within else otherwise
    return min(within or points, key=key), bool(within)


def _coordinates(slide: Point | None, slides: Sequence[Point]) -> Role:
    if slide is None:
        return Role("coordinates", "", "left out: nothing lies below the surface")
    without = next((limit_of(point) for point in slides if point["name"] == "none"), None)
    if slide["name"] == "none":
        return Role("coordinates", "", f"left out: without it the picture is off by {limit_of(slide):.3g} of the way")
    more = f"; without it by {without:.3g}" if without is not None else ""
    return Role("coordinates", slide["name"], f"the picture is off by {limit_of(slide):.3g} of the way{more}")


def _light(chain: Point | None, materials: Sequence[Point]) -> list[Role]:
    if chain is None:
        return []
    without = next(limit_of(point) for point in materials if point["name"] == "none")
    if not chain["chain"]:
        return [
            Role("thickness", "", "left out: nothing reads it"),
            Role("translucency", "", f"left out: the error without it is {without:.3g}"),
        ]
    names = chain["chain"]
    light = names[-1]
    roles = [Role("translucency", light, f"without light that comes through the error is {without:.3g}")]
    first = next((name for name in names if load(name).role == "thickness"), "")
    if not first:
        best = min(materials, key=limit_of)
        why = f"left out: {light} reads none; the best chain that has one errs by {limit_of(best):.3g}"
        return [Role("thickness", "", why), *roles]
    plain = [point for point in materials if any(is_constant(load(name)) for name in point["chain"])]
    why = needs(load(first))
    if is_constant(load(first)):
        measured = [point for point in materials if point["chain"] and point not in plain]
        closest = min((limit_of(point) for point in measured), default=float("nan"))
        why = f"one number for all of the body: measured where light passes the error would be {closest:.3g}"
    elif plain:
        least = min(limit_of(point) for point in plain)
        why = f"with the same thickness everywhere the error is {least:.3g}" + (f"; it needs {why}" if why else "")
    return [Role("thickness", first, why), *roles]
