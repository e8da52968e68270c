"""What an engine offers: which points of a chart it can use, by what they require and the bytes of their bakes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sssgen.lab.chart.record import Point, Record, fronts_of
from sssgen.support.diagnostics import failure

LIGHTS = ("fixed", "moving")
BODIES = {"rigid": (), "skinned": ("rigid",), "deforming": ("rigid", "rest-pose")}
"""Each kind of body with the requirements that it does not meet."""


class Conditions(NamedTuple):
    """The conditions of an engine and a scene; by default it has everything."""

    max_bytes: int | None = None
    """The largest sum of a chain's baked textures"""
    light: str = "fixed"
    """moving: it moves relative to the body"""
    body: str = "rigid"
    """skinned: bones bend it, and the engine knows its rest pose; deforming: it does not keep its shape"""
    without: tuple[str, ...] = ()
    """Of `material.attributes.OMISSIONS`"""

    def missing(self, point: Point) -> str:
        """Why a point cannot be used, as an option of the commands; '' if it can."""
        requires = point.get("requires", ())
        for name in self.without:
            if name in requires:
                return f"--without {name}"
        if self.light == "moving" and "fixed-light" in requires:
            return "--light moving"
        if any(name in requires for name in BODIES[self.body]):
            return f"--body {self.body}"
        if self.max_bytes is not None and point.get("bytes", 0) > self.max_bytes:
            return f"--max-bytes {self.max_bytes}"
        return ""


EVERYTHING = Conditions()


def usable(points: Sequence[Point], conditions: Conditions) -> list[Point]:
    """The points that can be used under the conditions. Raises SssgenError if only empty chains are left."""
    kept = [point for point in points if not conditions.missing(point)]
    if any(point["name"] != "none" for point in points) and all(point["name"] == "none" for point in kept):
        options = list(dict.fromkeys(filter(None, map(conditions.missing, points))))
        raise failure("no technique is left under these conditions", f"omit {' or '.join(options)}")
    return kept


def under(record: Record, conditions: Conditions) -> Record:
    """The record with the points that can be used, their fronts and hypervolumes. Raises SssgenError as `usable`."""
    if conditions == EVERYTHING:
        return record
    kept = usable(record["points"], conditions)
    return fronts_of({**record, "points": kept, "conditions": conditions._asdict()})


def by_bytes(record: Record) -> Record:
    """The record with the bytes of bakes as the cost; nothing baked is drawn as one byte."""
    points: list[Point] = [
        {**point, "cost": {**point["cost"], "static": point["cost"]["value"], "value": max(point.get("bytes", 0), 1)}}
        for point in record["points"]
    ]
    return fronts_of({**record, "points": points, "cost": "bytes", "cost_unit": "bytes baked"})
