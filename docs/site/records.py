"""The records of the charts that docs/accuracy.py has made."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from typing import Any

from menu import ROOT

Point = Mapping[str, Any]

CHARTS = ("chart.json", "chart_refracting.json")


@functools.cache
def points() -> tuple[Point, ...]:
    """The points of all charts; of two charts with the same scene and chain, those of the first."""
    unique: dict[tuple[object, ...], Point] = {}
    for file in CHARTS:
        for point in json.loads((ROOT / "docs" / "accuracy" / file).read_text(encoding="utf-8"))["points"]:
            unique.setdefault((point["role"], point["scene"], point["label"]), point)
    return tuple(unique.values())


def points_of(technique: str) -> list[Point]:
    """The points that measure a technique by itself."""
    return [point for point in points() if point["name"] == technique and point["role"] != "material"]
