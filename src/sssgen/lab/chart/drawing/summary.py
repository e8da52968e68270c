"""One point for each technique and setting: the median over the scenes."""

from __future__ import annotations

import math
from statistics import median
from typing import Any

from sssgen.lab.chart.record import Point, Record, front, measures, points_of

MEDIAN = "median over scenes"
"""What stands in the place of a scene's name."""


def medians(record: Record, role: str) -> list[Point]:
    """Points of a role whose cost and error are medians over the scenes, with their front marked.

    A failure counts as an infinite error: a technique that fails on half of the scenes has failed.
    """
    groups: dict[tuple[str, str], list[Point]] = {}
    for point in points_of(record, role):
        groups.setdefault((point["name"], point["label"]), []).append(point)
    found: list[dict[str, Any]] = []
    for same in groups.values():
        costs, errors = zip(*map(measures, same), strict=True)
        error = median(errors)
        failed = sum(map(math.isinf, errors))
        first = same[0]
        found.append(
            {
                "scene": MEDIAN,
                "role": role,
                "name": first["name"],
                "label": first["label"],
                "baseline": bool(first.get("baseline")),
                "settings": first.get("settings", {}),
                "chain": first.get("chain", []),
                "cost": {"value": median(costs)},
                "error": {"value": error if math.isfinite(error) else None},
                "failed": "" if math.isfinite(error) else f"fails on {failed} of {len(same)} scenes",
            }
        )
    best = {id(point) for point in front(found)}
    return [{**point, "front": id(point) in best} for point in found]
