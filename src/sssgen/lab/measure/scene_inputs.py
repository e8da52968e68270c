"""What a scene gives to a chain that is measured on it: textures baked from the body, and parameters of its geometry.

Maps are ideal: each point reads its own texel, with the exact value there, so that a technique's error is its own and
not a bake's.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.evaluate.evaluation import half
from sssgen.harness.scenes.light_view import from_afar
from sssgen.lab.reference.inside_lengths import intervals, thickness
from sssgen.lab.scene import scene_body as body
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.view_points import points
from sssgen.targets.numpy_textures import Texture

RAYS = 32
"""Inward rays of a point's mean chord."""
DEPTH_MAP = 256
"""Texels along a side of a light's depth map."""


@dataclass(eq=False)
class SceneInputs:
    """Parameters and textures by the names that techniques give them; inputs that take the place of the points'."""

    values: dict[str, Any] = field(default_factory=dict)
    textures: dict[str, Texture] = field(default_factory=dict)
    inputs: dict[str, Array] = field(default_factory=dict)


@lru_cache(48)
def of_scene(scene: MeasuredScene) -> SceneInputs:
    """What does not depend on a light."""
    geometry, at = scene.geometry, points(scene)
    distances = body.distance_texture(geometry)
    chord = mean_chord(scene)
    # a texel for each point, and no filter: what a faultless bake has there
    texels = (np.arange(at.count) + 0.5) / at.count
    longest = max(float(chord.max(initial=0.0)), 1e-9)
    typical = max(float(np.median(chord)), 1e-9) if at.count else 1.0

    def ideal(values: Array) -> Texture:
        return Texture(values[None, :, None], "nearest", "clamp")

    # one lane for all points, so that a vector of three is not taken for three points
    given = body.given(geometry, distances) | {"stored_range": distances.range}
    values = {name: np.array(value)[:, None] if isinstance(value, list) else value for name, value in given.items()}
    textures = {
        "distance_map": half(Texture(distances.values(geometry), wrap="clamp")),
        "thickness_texture": ideal(chord / longest),
        "thinness_texture": ideal(1.0 - chord / longest),
        "transmittance_texture": ideal(np.exp(-chord / typical)),
    }
    return SceneInputs(values, textures, {"uv": np.stack([texels, np.full(at.count, 0.5)])})


@lru_cache(192)
def of_light(scene: MeasuredScene, direction: tuple[float, float, float]) -> SceneInputs:
    """What depends on a light from afar: the exact thickness towards it, and its depth map."""
    geometry, at = scene.geometry, points(scene)
    towards = np.broadcast_to(np.array(direction), (at.count, 3)).copy()
    exact = thickness(geometry, np.ascontiguousarray(at.inputs["P"].T), towards)
    values, textures = _depth_map(scene, np.array(direction))
    return SceneInputs(values | {"exact_length": exact}, textures)


def mean_chord(scene: MeasuredScene) -> Array:
    """The mean length inside the body over inward directions, weighted by their cosine to −N: (n,)."""
    at = points(scene)
    frame = np.stack([at.inputs["T"], np.cross(at.inputs["N"].T, at.inputs["T"].T).T, -at.inputs["N"]])
    # a Fibonacci spiral on the disc, raised to the hemisphere: density follows the cosine
    number = np.arange(RAYS)
    radius, angle = np.sqrt((number + 0.5) / RAYS), number * np.pi * (3.0 - np.sqrt(5.0))
    ways = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - radius**2)])
    directions = np.einsum("kr,kcn->rnc", ways, frame).reshape(-1, 3)
    places = np.tile(at.inputs["P"].T, (RAYS, 1))
    mean: Array = thickness(scene.geometry, places, np.ascontiguousarray(directions)).reshape(RAYS, -1).mean(axis=0)
    return mean


def _depth_map(scene: MeasuredScene, towards: Array) -> tuple[dict[str, Any], dict[str, Texture]]:
    """The light's view without perspective: matrices for the techniques, and the depth of the first surface."""
    geometry = scene.geometry
    view = from_afar(body.placed_corners(geometry), towards, (DEPTH_MAP, DEPTH_MAP))
    inwards = geometry.to_object()
    local = view.origins @ inwards[:3, :3].T + inwards[:3, 3]
    way = view.directions @ inwards[:3, :3].T * geometry.scale
    found = intervals(geometry, local, way)
    filled = found[..., 1] > found[..., 0]
    first = np.where(filled, found[..., 0], np.inf).min(axis=1) * geometry.scale
    depth = np.where(np.isfinite(first), first, view.far).reshape(DEPTH_MAP, DEPTH_MAP)
    seen = np.zeros((4, 4))  # the depth alone: to a light from afar it is the whole distance
    seen[2], seen[3, 3] = view.matrix[2], 1.0
    matrices = {"light_matrix": view.matrix, "light_texture": view.matrix, "light_view": seen}
    values = {name: matrix.T[..., None] for name, matrix in matrices.items()}
    return values, {"light_depth_map": Texture(depth[..., None], "linear", "clamp")}
