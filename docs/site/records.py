"""What the site quotes of the charts' records, as docs/accuracy_points.py has written it."""

from __future__ import annotations

import functools
import json
from typing import TypedDict

from menu import ROOT
from sssgen.lab.chart.record import Point


class Quoted(TypedDict):
    """Points with those of their keys that the site needs."""

    alone: list[Point]
    best: dict[str, Point]
    """By technique"""


@functools.cache
def _quoted() -> Quoted:
    quoted: Quoted = json.loads((ROOT / "docs" / "accuracy" / "points.json").read_text(encoding="utf-8"))
    return quoted


def points_of(technique: str) -> list[Point]:
    """The points that measure a technique by itself: on each scene, with each of its settings."""
    return [point for point in _quoted()["alone"] if point["name"] == technique]


def best_point(technique: str) -> Point | None:
    """The most accurate chain with the technique, on one scene, that needs no baked texture."""
    return _quoted()["best"].get(technique)
