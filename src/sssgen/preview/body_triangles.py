"""The triangles of a scene's body for a renderer of meshes, with a normal and texture coordinates at each corner."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.distance_field import PROJECTIONS
from sssgen.scene.geometry import Ball, Box, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.geometry_base import spherical, unit
from sssgen.scene.geometry_mesh import mesh_of

Array = npt.NDArray[np.float64]

RESOLUTION = 256
"""Cells along a side of a distance function's grid: thin sheets need more than path tracing uses."""


PARALLELS = 96
"""Of a ball, from pole to pole."""


class BodyTriangles(NamedTuple):
    """Triangles in object space, counter-clockwise seen from outside; each has its own corners."""

    position: Array
    """(f, 3, 3)"""
    normal: Array
    """(f, 3, 3), unit"""
    uv: Array
    """(f, 3, 2), v up"""

    def pack(self) -> bytes:
        """Position, normal and uv of each corner as 8 float32, little-endian."""
        rows = np.concatenate([self.position, self.normal, self.uv], axis=2)
        return np.ascontiguousarray(rows, "<f4").tobytes()


def body_triangles(geometry: Geometry) -> BodyTriangles:
    """The triangles of a body, without its transform. Raises SssgenError as `mesh_of` does."""
    if isinstance(geometry, Mesh):
        return _file_triangles(geometry)
    at_origin = dataclasses.replace(geometry, position=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0), scale=1.0)
    if isinstance(at_origin, Ball):
        return _ball_triangles(at_origin.radius)
    vertices, faces = mesh_of(at_origin, RESOLUTION)
    position = vertices[faces]
    flat = unit(np.cross(position[:, 1] - position[:, 0], position[:, 2] - position[:, 0]))
    if isinstance(geometry, Box | Slab | Union):
        normal = np.repeat(flat[:, None], 3, axis=1)
    else:
        normal = _gradient_normals(at_origin, vertices)[faces]
    return BodyTriangles(position, normal, _coordinates(at_origin, position, flat))


def _ball_triangles(radius: float) -> BodyTriangles:
    """A ball of quads between meridians and parallels, with a whole turn of u and no triangle without area."""
    u, v = np.arange(2 * PARALLELS + 1) / (2 * PARALLELS), np.arange(PARALLELS + 1) / PARALLELS
    longitude, latitude = np.meshgrid((u - 0.5) * 2.0 * np.pi, (v - 0.5) * np.pi)
    normal = np.stack(
        [np.cos(latitude) * np.sin(longitude), np.sin(latitude), np.cos(latitude) * np.cos(longitude)], axis=2
    )
    uv = np.stack(np.meshgrid(u, v), axis=2)
    corners = np.concatenate([normal, uv], axis=2)
    low, right, up, both = corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:]
    lower = np.stack([low[1:], right[1:], both[1:]], axis=2).reshape(-1, 3, 5)
    upper = np.stack([low[:-1], both[:-1], up[:-1]], axis=2).reshape(-1, 3, 5)
    triangles = np.concatenate([lower, upper])
    return BodyTriangles(radius * triangles[..., :3], triangles[..., :3], triangles[..., 3:])


def _file_triangles(mesh: Mesh) -> BodyTriangles:
    triangles = mesh.triangles
    position, normal = triangles.places[triangles.corners], triangles.corner_normals(np.arange(len(triangles.corners)))
    normal = np.where((np.abs(normal) > 0.0).any(axis=2, keepdims=True), normal, triangles.flat[:, None])
    if triangles.uv is not None:
        return BodyTriangles(position, normal, triangles.uv)
    low, high = mesh.bounds()
    return BodyTriangles(position, normal, _spherical_coordinates(position - 0.5 * (low + high)))


def _gradient_normals(geometry: Geometry, points: Array) -> Array:
    """The gradient of the distance."""
    step = 1e-4 * float(np.ptp(points, axis=0).max())
    slopes = [geometry.distance(points + step * axis) - geometry.distance(points - step * axis) for axis in np.eye(3)]
    return unit(np.stack(slopes, axis=1))


def _coordinates(geometry: Geometry, position: Array, flat: Array) -> Array:
    """The texture coordinates of the corners, as the geometry's own ray caster gives them."""
    if isinstance(geometry, Box | Slab):
        size = np.ptp(position.reshape(-1, 3), axis=0)
        # the casts of boxes: seen from outside, u to the right and v up; on the top v goes to the back
        ahead = np.argmax(np.abs(flat), axis=1)
        side = np.sign(flat[np.arange(len(flat)), ahead])
        right = np.zeros_like(flat)
        right[ahead == 0, 2] = -side[ahead == 0]
        right[ahead == 1, 0] = 1.0
        right[ahead == 2, 0] = side[ahead == 2]
        up = np.cross(flat, right)
        axes = np.stack([right, up], axis=1)
        result: Array = 0.5 + np.einsum("fkc,fac->fka", position / size, axes)
        return result
    if isinstance(geometry, Torus):
        x, y, z = np.moveaxis(position, 2, 0)
        turns = np.stack([np.arctan2(x, z), np.arctan2(y, np.hypot(x, z) - geometry.major)], axis=2)
        return _cross_seam(0.5 + turns / (2.0 * np.pi))
    if isinstance(geometry, Distance) and geometry.projection != "spherical":
        points = position.reshape(-1, 3)
        return PROJECTIONS[geometry.projection](points)[0].reshape(*position.shape[:2], 2)
    return _spherical_coordinates(position)


def _spherical_coordinates(position: Array) -> Array:
    """Longitude and latitude about the origin."""
    return _cross_seam(spherical(position.reshape(-1, 3))[0].reshape(*position.shape[:2], 2))


def _cross_seam(uv: Array) -> Array:
    """Coordinates whose triangles at the seam go beyond 1, in place of back across the whole texture."""
    for axis in (0, 1):
        values = uv[..., axis]
        crosses = np.ptp(values, axis=1, keepdims=True) > 0.5
        uv[..., axis] = np.where(crosses & (values < 0.5), values + 1.0, values)
    return uv
