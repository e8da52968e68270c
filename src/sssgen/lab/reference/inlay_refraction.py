"""The apparent position of an inlay below a clear surface: exact refraction on flat and curved bodies.

The inlay is a layer at constant `depth` below the surface, along its normal. A ray refracts at the surface, continues
straight and hits the layer; the visible point is the surface point above the hit. On a plane this is the formula of
On Subsurface Parallax Shading.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sssgen.run.backends import Array
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import Points

STEPS = 400
TOUCHED = 1e-9
"""The distance from the layer, relative to its depth, at which a ray hits it."""


class VisibleInlay(NamedTuple):
    """The inlay as seen at n surface points."""

    hit: Array
    """(n,): whether the ray hits the layer; near a curved edge it may miss"""
    offset: Array
    """(2, n): the offset on the surface from the point to the visible point, in world units along T and B"""
    depth: float


def refract(V: Array, N: Array, eta: float) -> Array:
    """The unit directions (3, n) of rays from the eye after refraction; `eta` is n outside over n inside.

    Snell's law in vector form; 0 beyond the critical angle.
    """
    cosine = np.einsum("cn,cn->n", V, N)
    k = 1.0 - eta**2 * (1.0 - cosine**2)
    inside = -eta * V + (eta * cosine - np.sqrt(np.maximum(k, 0.0))) * N
    return np.where(k >= 0.0, inside, 0.0)


def plane_offset(sine: Array, depth: float, n: float) -> Array:
    """The apparent offset of an inlay below a plane, for a view angle with that sine, in closed form.

    depth · sin θ / √(n² − sin² θ), with n = n inside over n outside.
    """
    return depth * sine / np.sqrt(n**2 - sine**2)


def visible_inlay(scene: MeasuredScene, visible: Points) -> VisibleInlay:
    """The scene's inlay as seen at its points. The geometry's distance must be exact inside."""
    assert scene.inlay is not None
    geometry, inlay = scene.geometry, scene.inlay
    N, T, B = visible.inputs["N"], visible.inputs["T"], visible.inputs["B"]
    to_object, scale = geometry.to_object(), geometry.scale
    depth = inlay.depth / scale
    start = visible.inputs["P_object"]
    rotation = to_object[:3, :3] * scale
    ray = rotation @ refract(visible.inputs["V"], N, inlay.outside_ior / inlay.ior)
    t = np.zeros(visible.count)
    hit = np.zeros(visible.count, np.bool_)
    active = np.abs(ray).any(axis=0)
    for _ in range(STEPS):
        # the layer is at least this far away
        remaining = depth + geometry.distance((start + t * ray).T)
        hit |= active & (remaining < TOUCHED * depth)
        active &= (remaining >= TOUCHED * depth) & (remaining < depth * 1.001 + TOUCHED)
        if not active.any():
            break
        t = np.where(active, t + np.maximum(remaining, 0.0), t)
    layer = start + t * ray
    outward = _outward(scene, layer, depth)
    chord = scale * rotation.T @ (layer + depth * outward - start)
    # the path on the surface is an arc, approximated by the ball with these two normals
    half = 0.5 * np.arccos(np.clip((outward * (rotation @ N)).sum(axis=0), -1.0, 1.0))
    arc = np.linalg.norm(chord, axis=0) / np.sinc(half / np.pi)
    along = np.stack([(chord * T).sum(axis=0), (chord * B).sum(axis=0)])
    length = np.linalg.norm(along, axis=0)
    return VisibleInlay(
        hit, along * np.where(length > 0.0, arc / np.where(length > 0.0, length, 1.0), 0.0), inlay.depth
    )


def _outward(scene: MeasuredScene, layer: Array, depth: float) -> Array:
    """The surface's unit normals above points of the layer, by the gradient of the distance: (3, n)."""
    step = 1e-5 * max(depth, 1e-3)
    distance = scene.geometry.distance
    slopes = np.stack([
        distance((layer + step * axis[:, None]).T) - distance((layer - step * axis[:, None]).T) for axis in np.eye(3)
    ])  # fmt: skip
    length = np.linalg.norm(slopes, axis=0)
    outward: Array = slopes / np.where(length > 0.0, length, 1.0)
    return outward
