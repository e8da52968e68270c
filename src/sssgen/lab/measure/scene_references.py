"""The light transport references of each scene, light by light, and its training scenes of the same medium."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from sssgen.jobs.executor import Item
from sssgen.lab.measure.problem import LightReference
from sssgen.lab.reference.eye_paths import Eye, Sky, readings
from sssgen.lab.reference.first_light import Lamp
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.transport import radiance_along
from sssgen.lab.reference.transport_mitsuba import Light as Beam
from sssgen.scene.bounds import world_corners
from sssgen.scene.camera import Camera
from sssgen.scene.environment import Environment
from sssgen.scene.geometry import Ball, Capsule, Geometry, Slab
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene import Light

SAMPLES = 512
"""Per ray and channel."""
TRAINING_SIDE = 40

ROUND_LIGHTS = ((0.0, 0.15, -1.0), (0.75, 0.2, -0.65), (-0.95, 0.3, 0.1), (0.35, 0.5, 0.8))
SLAB_LIGHTS = ((0.0, 0.0, -1.0), (0.6, 0.35, -0.72), (-0.3, 0.5, 0.8))
"""Directions towards lights behind, beside and in front of the body."""


def transport(scene: MeasuredScene, light: int, samples: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The reference of a light on a scene's points: mean and standard error of π L / E, (3, n) in float32."""
    assert scene.medium is not None
    visible, direction = points(scene), scene.lights[light].direction
    assert direction is not None
    origins = np.broadcast_to(visible.origin, (visible.count, 3))
    rays = np.ascontiguousarray(-visible.inputs["V"].T)
    result = radiance_along(scene.geometry, scene.medium, Beam(direction), origins, rays, Sampling(samples, seed))
    return result.mean.T.astype(np.float32), result.error.T.astype(np.float32)


def trace(scene: MeasuredScene, samples: int, seed: int) -> list[LightReference]:
    """The references of all lights of a scene at once, as `transport`; that of its environment is the last.

    Readings of a point light are those of an irradiance of 1 at distance 1, those of an environment are π L.
    """
    return _readings(scene, [Sky(scene.environment.sky())] if scene.environment is not None else [], samples, seed)


def trace_environments(
    scene: MeasuredScene, environments: tuple[Environment, ...], samples: int, seed: int
) -> list[LightReference]:
    """Two references of each environment in the place of the scene's light: the light that is scattered in the body,
    and all light, with what is seen through the body."""
    skies = [Sky(each.sky(), seen_through) for each in environments for seen_through in (False, True)]
    return _readings(dataclasses.replace(scene, lights=()), skies, samples, seed)


def _readings(scene: MeasuredScene, skies: Sequence[Sky], samples: int, seed: int) -> list[LightReference]:
    assert scene.medium is not None
    inputs = points(scene).inputs
    eye = Eye(*(np.ascontiguousarray(part.T) for part in (inputs["P"], inputs["N"], -inputs["V"])))
    lamps = [Lamp(light.direction, light.position) for light in scene.lights]
    result = readings(scene.geometry, scene.medium, eye, lamps, skies, Sampling(samples, seed))
    return [
        (mean.T.astype(np.float32), error.T.astype(np.float32))
        for mean, error in zip(result.mean, result.error, strict=True)
    ]


def by_eye_paths(scene: MeasuredScene) -> bool:
    """Whether the references are traced from the eye for all lights at once, and not by Mitsuba light by light."""
    medium = scene.medium
    other_lights = scene.environment is not None or any(light.position is not None for light in scene.lights)
    return medium is not None and (medium.ior != 1.0 or other_lights)


def items(scenes: Sequence[MeasuredScene], samples: int = SAMPLES, seed: int = 0) -> list[Item]:
    """The work items of the references in order: one per scene or one per light. Scenes without a medium have none."""
    result = []
    for scene in scenes:
        label = f"reference of {scene.name}"
        if by_eye_paths(scene):
            result.append(Item("sssgen.lab.measure.scene_references:trace", (scene, samples, seed), label))
        elif scene.medium is not None:
            function = "sssgen.lab.measure.scene_references:transport"
            result += [Item(function, (scene, light, samples, seed), label) for light in range(len(scene.lights))]
    return result


def by_scene(scenes: Sequence[MeasuredScene], results: Sequence[Any]) -> dict[str, list[LightReference]]:
    """The results of `items` by their scenes' keys."""
    references: dict[str, list[LightReference]] = {}
    remaining = iter(results)
    for scene in scenes:
        if by_eye_paths(scene):
            references[scene.key] = next(remaining)
        elif scene.medium is not None:
            references[scene.key] = [next(remaining) for _ in scene.lights]
    return references


def training_scenes(scene: MeasuredScene, side: int = TRAINING_SIDE) -> list[MeasuredScene]:
    """The training scenes: balls and bars of the scene's medium, as large as its body and smaller, and a small slab.

    Light leaves a bar to all sides, and a slab to none: a large slab would outweigh the others, and no body is one.
    Sizes are powers of two, so that scenes with the same medium share them. Their views have `side` × `side` pixels.
    """
    assert scene.medium is not None
    corners = world_corners(scene.geometry)
    size = 2.0 ** round(float(np.log2(max(np.ptp(corners, axis=0).max(), 1e-6))))
    result = []
    small = 0.4 * size
    for part in (size, small):
        ball, bar = Ball(0.5 * part), Capsule(0.14 * part, 0.7 * part, rotation=(0.0, 0.0, 35.0))
        result.append(lit_body("ball", ball, scene.medium, (0.0, 0.4 * part, 3.2 * part), ROUND_LIGHTS))
        result.append(lit_body("bar", bar, scene.medium, (0.5 * part, 0.4 * part, 3.1 * part), ROUND_LIGHTS))
    slab = Slab(1.4 * small, 1.4 * small, 0.3 * small)
    result.append(lit_body("slab", slab, scene.medium, (0.9 * small, 0.7 * small, 3.0 * small), SLAB_LIGHTS))
    return [dataclasses.replace(each, size=(side, side)) for each in result]


def lit_body(
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
