"""Lights under which chains are measured though no fit used them: from afar, lamps close by, and surroundings.

Directions are drawn at random, the same for all bodies. A case is both views of a body under the same light.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, results_of, two_views, with_references
from sssgen.lab.measure.measurement import View
from sssgen.scene.arrays import Vector
from sssgen.scene.bounds import bounds
from sssgen.scene.environment import Environment
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light

SHARE = 4
"""A reference of a drawn light has the samples of a chart divided by this: there are many, and noise is subtracted."""
SEED = 34
"""The seed of the directions."""
WHITE = (1.0, 1.0, 1.0)
HALVINGS = 24
"""Of the interval in which a lamp is placed."""

Case = Sequence[View]


def directions(count: int) -> list[Vector]:
    """Unit directions that are uniform on the sphere; the first ones do not depend on how many follow."""
    rng = np.random.default_rng(SEED)
    drawn = rng.normal(size=(count, 3))
    return [(float(x), float(y), float(z)) for x, y, z in drawn / np.linalg.norm(drawn, axis=1, keepdims=True)]


def drawn_views(scenes: Sequence[MeasuredScene], count: int, settings: Settings, first: int = 0) -> dict[str, Case]:
    """Both views of each scene (by its key) under `count` lights from afar, after the `first` ones, with their
    references."""
    lights = tuple(Light(None, direction, WHITE) for direction in directions(first + count)[first:])
    return _lit_views({scene.key: dataclasses.replace(scene, lights=lights) for scene in scenes}, settings)


def lamp_views(scenes: Sequence[MeasuredScene], count: int, settings: Settings) -> dict[str, Case]:
    """Both views of each scene (by its key) under `count` lamps at one radius from the surface, with their references.

    A body's radius is half of the longest side of its box.
    """
    lit = {}
    for scene in scenes:
        lamps = tuple(Light(_lamp(scene, direction), None, WHITE) for direction in directions(count))
        lit[scene.key] = dataclasses.replace(scene, lights=lamps)
    return _lit_views(lit, settings)


def _lamp(scene: MeasuredScene, direction: Vector) -> Vector:
    """The place in a direction from the body's middle at one radius from its surface."""
    geometry = scene.geometry
    low, high = bounds(geometry)
    middle, radius = 0.5 * (low + high), 0.5 * float((high - low).max())
    way = geometry.to_object()[:3, :3] @ direction
    way /= np.linalg.norm(way)
    near, far = 0.0, 4.0 * radius
    for _ in range(HALVINGS):
        half = 0.5 * (near + far)
        close_by = geometry.distance((middle + half * way)[None])[0] < radius
        near, far = (half, far) if close_by else (near, half)
    x, y, z, _ = geometry.to_world() @ [*(middle + far * way), 1.0]
    return float(x), float(y), float(z)


def _lit_views(scenes: Mapping[str, MeasuredScene], settings: Settings) -> dict[str, Case]:
    # the references of some scenes are traced for all lights at once
    named = {key: two_views(dataclasses.replace(scene, environment=None)) for key, scene in scenes.items()}
    return dict(with_references(named, settings._replace(samples=max(settings.samples // SHARE, 2))))


def cases_of(views: Case, size: int = 1) -> list[Case]:
    """The cases of views with many lights, with `size` lights each; those that are left over are in none."""
    count = len(views[0].scene.lights) // size
    return [
        [
            view._replace(
                scene=dataclasses.replace(view.scene, lights=view.scene.lights[first : first + size]),
                references=view.references[first : first + size],
            )
            for view in views
        ]
        for first in range(0, count * size, size)
    ]


def environment_cases(
    scenes: Sequence[MeasuredScene], environments: Sequence[Environment], settings: Settings
) -> tuple[dict[str, list[Case]], dict[str, list[Case]]]:
    """The cases of each scene (by its key) in the surroundings alone: with references of the light that is scattered in
    the body, and of all light, with what is seen through the body."""
    named = {scene.key: two_views(dataclasses.replace(scene, lights=(), environment=None)) for scene in scenes}
    items = [
        Item(
            "sssgen.lab.measure.scene_references:trace_environments",
            (scene, tuple(environments), settings.samples, settings.seed),
            f"reference of {scene.name} in surroundings",
        )
        for views in named.values()
        for _, scene in views
    ]
    traced = iter(results_of(items, settings))
    references = {key: [next(traced) for _ in views] for key, views in named.items()}

    def cases(key: str, seen_through: int) -> list[Case]:
        return [
            [
                View(
                    name,
                    dataclasses.replace(scene, environment=environment),
                    (result[2 * number + seen_through],),
                    f"{settings.samples} {settings.seed} {seen_through}",
                )
                for (name, scene), result in zip(named[key], references[key], strict=True)
            ]
            for number, environment in enumerate(environments)
        ]

    return {key: cases(key, 0) for key in named}, {key: cases(key, 1) for key in named}
