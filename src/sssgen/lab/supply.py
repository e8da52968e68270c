"""What a scene gives to a chain that is measured on it: textures baked from the body, and parameters of its geometry.

Maps are ideal: each point reads its own texel, with the exact value there, so that a technique's error is its own and
not a bake's.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from ..harness.backends import Array
from ..harness.evaluate import half
from ..targets.numpy_textures import Texture
from . import body
from .intervals import intervals, thickness
from .points import points
from .situation import Situation

RAYS = 32
"""Inward rays of a point's mean chord."""
DEPTH_MAP = 256
"""Texels along a side of a light's depth map."""


@dataclass(eq=False)
class Supply:
    """Parameters and textures by the names that techniques give them; inputs that take the place of the points'."""

    values: dict[str, Any] = field(default_factory=dict)
    textures: dict[str, Texture] = field(default_factory=dict)
    inputs: dict[str, Array] = field(default_factory=dict)


@lru_cache(48)
def of_scene(situation: Situation) -> Supply:
    """What does not depend on a light."""
    geometry, at = situation.geometry, points(situation)
    distances = body.distance_texture(geometry)
    chord = mean_chord(situation)
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
    return Supply(values, textures, {"uv": np.stack([texels, np.full(at.count, 0.5)])})


@lru_cache(192)
def of_light(situation: Situation, direction: tuple[float, float, float]) -> Supply:
    """What depends on a light from afar: the exact thickness towards it, and its depth map."""
    geometry, at = situation.geometry, points(situation)
    towards = np.broadcast_to(np.array(direction), (at.count, 3)).copy()
    exact = thickness(geometry, np.ascontiguousarray(at.inputs["P"].T), towards)
    values, textures = _depth_map(situation, np.array(direction))
    return Supply(values | {"exact_length": exact}, textures)


def mean_chord(situation: Situation) -> Array:
    """The mean length inside the body over inward directions, weighted by their cosine to −N: (n,)."""
    at = points(situation)
    frame = np.stack([at.inputs["T"], np.cross(at.inputs["N"].T, at.inputs["T"].T).T, -at.inputs["N"]])
    # a Fibonacci spiral on the disc, raised to the hemisphere: density follows the cosine
    number = np.arange(RAYS)
    radius, angle = np.sqrt((number + 0.5) / RAYS), number * np.pi * (3.0 - np.sqrt(5.0))
    ways = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - radius**2)])
    directions = np.einsum("kr,kcn->rnc", ways, frame).reshape(-1, 3)
    places = np.tile(at.inputs["P"].T, (RAYS, 1))
    mean: Array = thickness(situation.geometry, places, np.ascontiguousarray(directions)).reshape(RAYS, -1).mean(axis=0)
    return mean


def _depth_map(situation: Situation, towards: Array) -> tuple[dict[str, Any], dict[str, Texture]]:
    """The light's view without perspective: matrices for the techniques, and the depth of the first surface."""
    corners = body.placed_corners(situation.geometry)
    side = np.cross(towards, np.eye(3)[np.argmin(np.abs(towards))])
    side /= np.linalg.norm(side)
    up = np.cross(side, -towards)
    middle = corners.mean(axis=0)
    wide = 1.1 * max(float(np.ptp(corners @ axis)) for axis in (side, up))
    start = float((corners @ towards).max()) + 0.1 * wide  # where the light's plane stands
    grid = ((np.arange(DEPTH_MAP) + 0.5) / DEPTH_MAP - 0.5) * wide
    x, y = np.meshgrid(grid + middle @ side, grid + middle @ up)
    origins = x.reshape(-1, 1) * side + y.reshape(-1, 1) * up + start * towards
    geometry = situation.geometry
    inwards = geometry.to_object()
    local = origins @ inwards[:3, :3].T + inwards[:3, 3]
    way = np.broadcast_to(inwards[:3, :3] @ -towards * geometry.scale, local.shape).copy()
    found = intervals(geometry, local, way)
    filled = found[..., 1] > found[..., 0]
    first = np.where(filled, found[..., 0], np.inf).min(axis=1) * geometry.scale
    depth = np.where(np.isfinite(first), first, 2.0 * wide).reshape(DEPTH_MAP, DEPTH_MAP)
    to_map = np.zeros((4, 4))
    to_map[0, :3], to_map[0, 3] = side / wide, 0.5 - middle @ side / wide
    to_map[1, :3], to_map[1, 3] = up / wide, 0.5 - middle @ up / wide
    to_map[2, :3], to_map[2, 3] = -towards, start
    to_map[3, 3] = 1.0
    seen = np.zeros((4, 4))  # the depth alone: to a light from afar it is the whole distance
    seen[2], seen[3, 3] = to_map[2], 1.0
    matrices = {"light_matrix": to_map, "light_texture": to_map, "light_view": seen}
    values = {name: matrix.T[..., None] for name, matrix in matrices.items()}
    return values, {"light_depth_map": Texture(depth[..., None], "linear", "clamp")}
