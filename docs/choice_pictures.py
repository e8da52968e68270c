"""Pictures of scenes: the reference, the best baseline, and the cheapest choice within each of some errors."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

from sssgen.jobs.executor import Item
from sssgen.lab.chart import charting
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.picking import choose, is_allowed, limit_of
from sssgen.lab.chart.record import Point, Record
from sssgen.lab.measure.error_metric import flip
from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene

SIDE = 144
"""Pixels along each side of a picture."""


class Choice(NamedTuple):
    """A point of a chart and its picture."""

    title: str
    point: Point
    met: bool
    """Whether the point is within the limit of the title"""
    picture: Array
    """(height, width, 3), linear light"""
    flip: float


class ScenePictures(NamedTuple):
    """The pictures of a scene, exposed alike."""

    scene: str
    title: str
    reference: Array
    choices: tuple[Choice, ...]


def scene_pictures(
    record: Record, scenes: Sequence[MeasuredScene], limits: Sequence[float], settings: Settings
) -> list[ScenePictures]:
    """The pictures of those scenes of a record that have a medium. Raises SssgenError as `charting.chart_record`."""
    lit = [scene for scene in scenes if scene.medium is not None]
    larger = {scene.name: [("picture", dataclasses.replace(scene, size=(SIDE, SIDE)))] for scene in lit}
    views = charting.with_references(larger, settings)
    choices = {scene.name: _points(record, scene.name, limits) for scene in lit}
    items = [
        Item(
            "sssgen.lab.measure.measurement:pictures_of",
            (charting.candidate_of(point), charting.fit_of(point), views[name][0]),
            f"picture of {name}",
        )
        for name, points in choices.items()
        for _, point, _ in points
    ]
    pictures = iter(charting.results_of(items, settings))
    result = []
    for scene in lit:
        pairs = [next(pictures) for _ in choices[scene.name]]
        rows = [
            Choice(title, point, met, picture, flip(picture, reference))
            for (title, point, met), (picture, reference) in zip(choices[scene.name], pairs, strict=True)
        ]
        result.append(ScenePictures(scene.name, scene.title, pairs[0][1], tuple(rows)))
    return result


def _points(record: Record, scene: str, limits: Sequence[float]) -> list[tuple[str, Point, bool]]:
    """Title, point and whether it is within the limit: the most accurate baseline, then the choice for each limit."""
    points = [point for point in record["points"] if point["scene"] == scene and point["role"] == "material"]
    baselines = [point for point in points if point["baseline"] and not point["failed"]]
    result = [("best published", min(baselines, key=limit_of), True)]
    for limit in limits:
        point, met = choose(list(filter(is_allowed, points)), limit, None)
        assert point is not None
        result.append((f"error ≤ {limit:g}", point, met))
    return result
