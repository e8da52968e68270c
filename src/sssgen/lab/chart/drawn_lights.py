"""The errors of chains under lights that no fit used: directions drawn at random, the same for all bodies."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, candidate_of, fit_of, results_of, two_views, with_references
from sssgen.lab.measure import candidates, fluence_inputs
from sssgen.lab.measure.measured_point import FittedChain, MeasuredPoint
from sssgen.lab.measure.measurement import View
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light

SHARE = 4
"""A reference of a drawn light has the samples of a chart divided by this: there are many, and noise is subtracted."""
SEED = 34
"""The seed of the directions."""


class DrawnErrors(NamedTuple):
    """A chain on a body, under each light."""

    values: tuple[float, ...]
    """The errors over both views"""
    cost: float
    """Weighted operations"""
    bytes: int
    """Of its baked textures"""

    @property
    def median(self) -> float:
        return float(np.median(self.values))

    @property
    def worst(self) -> float:
        return float(np.max(self.values))


def directions(count: int) -> list[tuple[float, float, float]]:
    """Unit directions that are uniform on the sphere; the first ones do not depend on how many follow."""
    rng = np.random.default_rng(SEED)
    drawn = rng.normal(size=(count, 3))
    return [(float(x), float(y), float(z)) for x, y, z in drawn / np.linalg.norm(drawn, axis=1, keepdims=True)]


def drawn_views(
    scenes: Sequence[MeasuredScene], count: int, settings: Settings, first: int = 0
) -> dict[str, tuple[View, ...]]:
    """Both views of each scene (by its key) under `count` lights after the `first` ones, with their references."""
    lights = tuple(Light(None, direction, (1.0, 1.0, 1.0)) for direction in directions(first + count)[first:])
    # the references of some scenes are traced for all lights at once
    named = {scene.key: two_views(dataclasses.replace(scene, lights=lights, environment=None)) for scene in scenes}
    return with_references(named, settings._replace(samples=max(settings.samples // SHARE, 2)))


def errors(
    scenes: Sequence[MeasuredScene],
    chains: Mapping[str, Sequence[FittedChain]],
    count: int,
    settings: Settings,
    first: int = 0,
) -> dict[str, list[DrawnErrors]]:
    """The errors of each scene's `chains` (by its key; whole materials) over both views, for `count` lights after the
    `first` ones.

    Raises SssgenError for scenes that cannot be measured, and for missing packages.
    """
    views = drawn_views(scenes, count, settings, first)
    items = []
    for scene in scenes:
        fitted = [(candidate_of(chain), fit_of(chain)) for chain in chains[scene.key]]
        if any(candidates.reads_fluence(candidate) for candidate, _ in fitted):
            with settings.progress_bar() as progress:
                unlit = dataclasses.replace(scene, lights=())
                fluence_inputs.prepare(unlit, settings.scheduler, settings.processes, progress)
        items += [
            Item(
                "sssgen.lab.measure.measurement:measure_candidate",
                (candidate, fit, views_of_light(views[scene.key], number)),
                f"{candidate.label} on {scene.name}, light {number}",
            )
            for candidate, fit in fitted
            for number in range(count)
        ]
    points: list[MeasuredPoint] = results_of(items, settings)
    measured = iter([points[first : first + count] for first in range(0, len(points), count)])
    return {scene.key: [_errors(next(measured)) for _ in chains[scene.key]] for scene in scenes}


def views_of_light(views: Sequence[View], number: int) -> list[View]:
    """Views under one of their lights."""
    return [
        view._replace(
            scene=dataclasses.replace(view.scene, lights=view.scene.lights[number : number + 1]),
            references=view.references[number : number + 1],
        )
        for view in views
    ]


def _errors(points: Sequence[MeasuredPoint]) -> DrawnErrors:
    errors_of_lights = [point["error"]["value"] for point in points]
    values = tuple(np.nan if error is None else float(error) for error in errors_of_lights)
    return DrawnErrors(values, float(points[0]["cost"]["value"]), points[0]["bytes"])
