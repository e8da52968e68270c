"""The boxes around bodies."""

from __future__ import annotations

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.support.diagnostics import failure


def bounds(geometry: Geometry) -> tuple[Array, Array]:
    """The corners of the shape's bounding box in object space; not tight for distance functions."""
    if isinstance(geometry, Mesh):
        return geometry.bounds()
    if isinstance(geometry, Ball):
        return np.full(3, -geometry.radius), np.full(3, geometry.radius)
    if isinstance(geometry, Torus):
        wide = geometry.major + geometry.minor
        return np.array([-wide, -geometry.minor, -wide]), np.array([wide, geometry.minor, wide])
    if isinstance(geometry, Capsule):
        half_size = np.array([geometry.radius, geometry.radius + 0.5 * geometry.length, geometry.radius])
        return -half_size, half_size
    if isinstance(geometry, Box | Slab):
        size = geometry.size if isinstance(geometry, Box) else (geometry.width, geometry.height, geometry.thickness)
        return -0.5 * np.array(size), 0.5 * np.array(size)
    if isinstance(geometry, Union):
        corners = [corner for part in geometry.parts for corner in world_corners(part)]
        return np.min(corners, axis=0), np.max(corners, axis=0)
    assert isinstance(geometry, Distance)
    at = np.linspace(-geometry.reach, geometry.reach, 48)
    points = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1).reshape(-1, 3)
    # a cell that the surface crosses has a corner within half of its diagonal from the surface
    near = points[geometry.distance(points) < 0.87 * (at[1] - at[0])]
    if not len(near):
        raise failure("the scene's body is empty", "its distance function has no value below 0 within its reach")
    return near.min(axis=0), near.max(axis=0)


def world_corners(geometry: Geometry) -> Array:
    """The eight corners of a shape's box, (8, 3), in world space."""
    low, high = bounds(geometry)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    matrix = geometry.to_world()
    placed: Array = corners @ matrix[:3, :3].T + matrix[:3, 3]
    return placed
