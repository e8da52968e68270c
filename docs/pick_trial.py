"""Tests `sssgen pick` on random scenes: each pick is compared with all chains that could be picked.

The true errors come from another reference, with other random numbers and twice the samples. Nothing is tuned on these
scenes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypedDict

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart import charting as chart
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.picking import choose, cost_of, is_allowed
from sssgen.lab.chart.record import Record
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Capsule, Geometry, Torus, Union
from sssgen.scene.measured import media
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light

SCENES = 5
LIMITS = 8
"""Limits per scene, from the smallest error to the error without any translucency."""
LEAST = 0.02
"""The smallest limit: smaller errors are noise, and can be 0."""
MEDIA = ("apple", "chicken1", "ketchup", "skin2", "wholemilk", "spectralon", "jade", "wax")
"""Media that the charts do not use."""
CLOSE = 1.10
"""The largest ratio of the costs of a pick and of the best chain."""
TRUE_SEED, TIMES = 1001, 2


class Row(TypedDict):
    """A pick within a limit on a scene."""

    scene: str
    title: str
    limit: float
    """The largest relative error"""
    picked: str
    """The label of the chain"""
    error: float
    """The true error of the picked chain"""
    cost: float
    """Weighted operations; so is `best`"""
    best: float
    """The cost of the cheapest chain whose true error is within the limit; NaN without one"""


def random_scene(number: int) -> MeasuredScene:
    """A random scene."""
    rng = np.random.default_rng([20, number])
    turn = tuple(float(angle) for angle in rng.uniform(-60.0, 60.0, 3))
    shape = shapes(rng, turn)[number % 5]
    medium = media.preset(MEDIA[number % len(MEDIA)], float(np.exp(rng.uniform(np.log(2.0), np.log(8.0))))).matched()
    lights = []
    for back in (True, False)[: 1 + number % 2]:
        x, y = rng.uniform(-0.9, 0.9, 2)
        direction = np.array([x, y, -1.0 if back else 0.8])
        direction /= np.linalg.norm(direction)
        red, green, blue = (float(part) for part in rng.uniform(0.3, 1.0, 3) * (1.0 if back else 0.4))
        lights.append(Light(None, (float(direction[0]), float(direction[1]), float(direction[2])), (red, green, blue)))
    camera = Camera((0.0, float(rng.uniform(-0.5, 1.2)), 3.4), (0.0, 0.0, 0.0), 28.0)
    name = f"random scene {number + 1}"
    title = f"{type(shape).__name__.lower()} of {medium.name}"
    return MeasuredScene(name, title, shape, camera, tuple(lights), medium, None)


def shapes(rng: np.random.Generator, turn: Any) -> list[Geometry]:
    """A shape of each kind."""
    a, b, c = (float(side) for side in rng.uniform(0.3, 1.1, 3))
    tube = float(rng.uniform(0.12, 0.25))
    offset = float(rng.uniform(0.3, 0.5))
    parts = (Ball(0.35, position=(-offset, 0.0, 0.0)), Box(size=(0.4, a, 0.5), position=(offset, 0.0, 0.0)))
    return [
        Box(size=(a, b, c), rotation=turn), Torus(0.45, tube, rotation=turn), Capsule(0.5 * b, a, rotation=turn),
        Union(parts, rotation=turn), Ball(0.3 + 0.3 * a),
    ]  # fmt: skip


def trial_rows(settings: Settings) -> list[Row]:
    """A row for each scene and limit."""
    scenes = [random_scene(number) for number in range(SCENES)]
    record = chart.chart_record(scenes, settings._replace(roles=("thickness", "material")))
    truth = settings._replace(samples=TIMES * settings.samples, seed=TRUE_SEED)
    true = errors_of(record, scenes, truth)
    rows: list[Row] = []
    for scene in scenes:
        points = [point for point in record["points"] if point["scene"] == scene.name and point["role"] == "material"]
        candidates = [point for point in points if is_allowed(point)]
        errors = [true[scene.name, point["label"]] for point in candidates]
        without = next(true[scene.name, point["label"]] for point in candidates if point["name"] == "none")
        for limit in np.geomspace(max(1.02 * min(errors), LEAST), 0.98 * without, LIMITS):
            picked, _ = choose(candidates, float(limit), None)
            assert picked is not None
            within = [cost_of(point) for point, error in zip(candidates, errors, strict=True) if error <= limit]
            rows.append({
                "scene": scene.name, "title": scene.title, "limit": float(limit), "picked": picked["label"],
                "error": true[scene.name, picked["label"]], "cost": cost_of(picked),
                "best": min(within, default=math.nan),
            })  # fmt: skip
    return rows


def errors_of(record: Record, scenes: Sequence[MeasuredScene], settings: Settings) -> dict[tuple[str, str], float]:
    """The errors of a record's materials, with their fitted parameters, against references with other settings.

    (scene, label) → the largest error of the views; infinite for a chain that fails.
    """
    views = chart.with_references({scene.name: chart.two_views(scene) for scene in scenes}, settings)
    points = [point for point in record["points"] if point["role"] == "material" and point["scene"] in views]
    items = [
        Item(
            "sssgen.lab.measure.measurement:measure_candidate",
            (chart.candidate_of(point), chart.fit_of(point), views[point["scene"]]),
            f"{point['label']} on {point['scene']}, measured again",
        )
        for point in points
    ]
    errors = {}
    for point, result in zip(points, chart.results_of(items, settings), strict=True):
        largest = max(float(view["value"]) for view in result["views"].values())
        errors[point["scene"], point["label"]] = float("inf") if result["failed"] else largest
    return errors


def table(rows: Sequence[Row]) -> str:
    """The rows, and their summary."""
    accurate = [row["error"] <= row["limit"] for row in rows]
    ratios = np.array([row["cost"] / row["best"] for row in rows])
    close = ratios <= CLOSE
    both = np.array(accurate) & close
    lines = [
        f"{len(rows)} cases, {SCENES} scenes: the true error is within the limit in {100.0 * np.mean(accurate):.1f} %, "
        f"the cost within {CLOSE:.2f} × of the cheapest chain within it in {100.0 * np.mean(close):.1f} % (median "
        f"ratio {np.median(ratios):.3f}, mean {np.mean(ratios):.3f}), both in {100.0 * np.mean(both):.1f} %.",
        "",
        "| scene | limit | picked | true error | cost | cheapest within the limit |",
        "|---|---:|---|---:|---:|---:|",
    ]  # fmt: skip
    for row, good in zip(rows, both, strict=True):
        mark = "" if good else " (!)"
        lines.append(
            f"| {row['scene']}: {row['title']} | {row['limit']:.3f} | {row['picked']}{mark} | {row['error']:.3f} | "
            f"{row['cost']:.0f} | {row['best']:.0f} |"
        )
    return "\n".join(lines)
