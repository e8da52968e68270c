"""The levels of detail of a scene: the chain for each distance of the camera that keeps a budget of a frame.

A distance is relative to that of the scene's camera. The body covers a share of the screen that falls with the square
of the distance, so that a chain that is too expensive nearby may be used further away. There the body is seen in fewer
pixels, and the error of the chain is that of a picture with as many.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from sssgen.lab.chart.picking import choose, cost_of, limit_of
from sssgen.lab.chart.record import Point
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points

ROWS, COLUMNS = 1080, 1920
"""The pixels of the screen."""
DISTANCES = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
VISIBLE = 0.1
"""The relative error below which a cheaper chain is enough."""


class Goal(NamedTuple):
    """A distance at which a chain is chosen."""

    distance: float
    pixels: float
    """Of the screen, that the body covers"""
    rows: int
    """Of the screen, in which the scene's whole view is seen"""
    max_cost: float
    """Nanoseconds per pixel that the budget allows"""


class Level(NamedTuple):
    """The choice for a range of distances. Its figures are the largest of the distances at which it was chosen."""

    begin: float
    end: float | None
    """The first distance of the next level; None for the last level"""
    point: Point
    ms: float
    """Predicted milliseconds of a frame"""
    error: float
    low: float
    high: float
    """The error and its bar, at the size at which the body is seen there; each is the largest of the views"""
    within: bool
    """Whether the error is below the limit; if not, it is the least one within the budget"""

    @property
    def range_text(self) -> str:
        """The distances, as `0.5 to 2`, or `from 2`."""
        return f"from {self.begin:g}" if self.end is None else f"{self.begin:g} to {self.end:g}"


def goals(scene: MeasuredScene, budget_ms: float, distances: Sequence[float]) -> tuple[Goal, ...]:
    """The goals for increasing distances. Raises SssgenError for a scene whose camera does not see its body."""
    height = scene.size[1]
    covered = points(scene).count * (ROWS / height) ** 2
    result = []
    for distance in distances:
        pixels = min(covered / distance**2, ROWS * COLUMNS)
        rows = max(round(ROWS / distance), 1)
        result.append(Goal(distance, pixels, min(rows, height), budget_ms * 1e6 / pixels))
    return tuple(result)


def seen_at(point: Point, rows: int) -> Point:
    """The point with its errors at the size at which the screen shows the view in `rows` rows."""
    return {**point, "views": point["views_at"][str(rows)]}


def low_of(point: Point) -> float:
    """The lower end of the error bar of the worst view."""
    return max(float(view["low"] or 0.0) for view in point["views"].values())


def choice(candidates: Sequence[Point], max_cost: float, max_error: float) -> Point:
    """The cheapest point within the error, of those within the cost. Without one: the most accurate, or the cheapest
    one whose bar meets that of the most accurate. Without any within the cost: the cheapest of all."""
    allowed = [point for point in candidates if cost_of(point) <= max_cost]
    best, met = choose(allowed or candidates, max_error, None) if allowed else choose(candidates, None, max_cost)
    assert best is not None
    if not allowed or met:
        return best
    return min((point for point in allowed if low_of(point) <= limit_of(best)), key=cost_of)


def levels(candidates: Sequence[Point], wanted: Sequence[Goal], max_error: float) -> list[Level]:
    """The levels, the nearest first; neighbouring distances with the same chain are one level.

    The candidates' cost is in nanoseconds per pixel.
    """
    choices = []
    for goal in wanted:
        seen = [seen_at(point, goal.rows) for point in candidates]
        choices.append((goal, choice(seen, goal.max_cost, max_error)))
    groups = [list(group) for _, group in groupby(choices, key=lambda choice: choice[1]["label"])]
    ends = [group[0][0].distance for group in groups[1:]]
    result = []
    for group, end in zip(groups, (*ends, None), strict=True):
        worst = max((point for _, point in group), key=limit_of)
        error = max(float(view["value"] or 0.0) for view in worst["views"].values())
        nearest, point = group[0]
        result.append(
            Level(
                nearest.distance, end, point, cost_of(point) * nearest.pixels * 1e-6, error,
                low_of(worst), limit_of(worst), limit_of(worst) <= max_error,
            )
        )  # fmt: skip
    return result
