"""The light transport references of each scene, light by light, and its training scenes of the same medium."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from sssgen.harness.scenes.bounds import placed_corners
from sssgen.harness.scenes.camera import Camera
from sssgen.harness.scenes.geometry import Ball, Geometry, Slab
from sssgen.harness.scenes.scene import Light
from sssgen.lab.jobs.executor import Item
from sssgen.lab.measure.problem import LightReference
from sssgen.lab.reference.transport import radiance_along
from sssgen.lab.reference.transport_mitsuba import Light as Beam
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.media import Medium
from sssgen.lab.scene.view_points import points

SAMPLES = 512
"""Per ray and channel."""
TRAINING_SIDE = 40

BALL_LIGHTS = ((0.0, 0.15, -1.0), (0.75, 0.2, -0.65), (-0.95, 0.3, 0.1), (0.35, 0.5, 0.8))
SLAB_LIGHTS = ((0.0, 0.0, -1.0), (0.6, 0.35, -0.72), (-0.3, 0.5, 0.8))
"""Directions towards lights behind, beside and in front of the body."""


def transport(scene: MeasuredScene, light: int, samples: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The reference of a light on a scene's points: mean and standard error of π L / E, (3, n) in float32."""
    assert scene.medium is not None
    visible, direction = points(scene), scene.lights[light].direction
    assert direction is not None
    origins = np.broadcast_to(visible.origin, (visible.count, 3))
    rays = np.ascontiguousarray(-visible.inputs["V"].T)
    result = radiance_along(scene.geometry, scene.medium, Beam(direction), origins, rays, samples, seed)
    return result.mean.T.astype(np.float32), result.error.T.astype(np.float32)


def items(scenes: Sequence[MeasuredScene], samples: int = SAMPLES, seed: int = 0) -> list[Item]:
    """The work items of the references, one per light, in order; scenes without a medium have none."""
    return [
        Item(
            "sssgen.lab.measure.scene_references:transport", (scene, light, samples, seed), f"reference of {scene.name}"
        )
        for scene in scenes
        if scene.medium is not None
        for light in range(len(scene.lights))
    ]


def by_scene(scenes: Sequence[MeasuredScene], results: Sequence[LightReference]) -> dict[str, list[LightReference]]:
    """The results of `items` by their scenes' keys."""
    references: dict[str, list[LightReference]] = {}
    remaining = iter(results)
    for scene in scenes:
        if scene.medium is not None:
            references[scene.key] = [next(remaining) for _ in scene.lights]
    return references


def training(scene: MeasuredScene) -> list[MeasuredScene]:
    """The training scenes: balls and slabs of the scene's medium, as large as its body and smaller.

    Sizes are powers of two, so that scenes with the same medium share them.
    """
    assert scene.medium is not None
    corners = placed_corners(scene.geometry)
    size = 2.0 ** round(float(np.log2(max(np.ptp(corners, axis=0).max(), 1e-6))))
    result = []
    for part in (size, 0.4 * size):
        ball, slab = Ball(0.5 * part), Slab(1.4 * part, 1.4 * part, 0.3 * part)
        result.append(_lit("ball", ball, scene.medium, (0.0, 0.4 * part, 3.2 * part), BALL_LIGHTS))
        result.append(_lit("slab", slab, scene.medium, (0.9 * part, 0.7 * part, 3.0 * part), SLAB_LIGHTS))
    return result


def _lit(
    name: str, geometry: Geometry, medium: Medium, eye: tuple[float, float, float], lights: Sequence[Sequence[float]]
) -> MeasuredScene:
    directions = [np.array(light) / np.linalg.norm(light) for light in lights]
    lamps = tuple(Light(None, (float(x), float(y), float(z)), (1.0, 1.0, 1.0)) for x, y, z in directions)
    view = Camera(eye, (0.0, 0.0, 0.0), 26.0)
    return MeasuredScene(name, name, geometry, view, lamps, medium, None, (TRAINING_SIDE, TRAINING_SIDE))


def plate(scene: MeasuredScene) -> MeasuredScene:
    """The training scene of parallax: a plane above the scene's inlay, at many view angles."""
    assert scene.inlay is not None
    depth = scene.inlay.depth
    slab = Slab(400.0 * depth, 400.0 * depth, 10.0 * depth)
    eye = (12.0 * depth, 6.0 * depth, 20.0 * depth)
    view = Camera(eye, (0.0, 0.0, 5.0 * depth), 60.0)
    return dataclasses.replace(scene, name="plate", title="plate", geometry=slab, camera=view, contents="")
