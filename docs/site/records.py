"""What the site quotes of the charts' records, as docs/accuracy_points.py has written it."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from typing import Any

from menu import ROOT

Point = Mapping[str, Any]


@functools.cache
def _quoted() -> Mapping[str, Any]:
    quoted: Mapping[str, Any] = json.loads((ROOT / "docs" / "accuracy" / "points.json").read_text(encoding="utf-8"))
    return quoted


def points_of(technique: str) -> list[Point]:
    """The points that measure a technique by itself: on each scene, with each of its settings."""
    return [point for point in _quoted()["alone"] if point["name"] == technique]


def best_point(technique: str) -> Point | None:
    """The most accurate chain with the technique, on one scene, that needs no baked texture."""
    point: Point | None = _quoted()["best"].get(technique)
    return point
