"""The base of every geometry: its transform, and the intersections of rays."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array, Bools, Vector


class Hits(NamedTuple):
    """The intersections of n rays: the nearest point in front of the origin. Where `hit` is false the rest is 0."""

    hit: Bools
    """(n,)"""
    position: Array
    """(n, 3)"""
    normal: Array
    """(n, 3), unit, outward whichever side the ray comes from"""
    tangent: Array
    """(n, 4): the unit direction in which u grows, and the handedness w: B = cross(N, T) * w, where v grows"""
    uv: Array
    """(n, 2): v up"""
    front: Bools
    """(n,): whether the ray comes from the side to which the surface's triangles face, or from outside of a solid"""
    uv2: Array
    """(n, 2): the second set, v up; 0 without one"""
    color: Array
    """(n, 4): the linear colour and opacity of the vertices; 1 without one"""


@dataclass(frozen=True)
class Geometry(ABC):
    """A shape in object space and its transform: scaled, then rotated about x, y and z, then translated."""

    position: Vector = field(default=(0.0, 0.0, 0.0), kw_only=True)
    rotation: Vector = field(default=(0.0, 0.0, 0.0), kw_only=True)
    """Degrees about the world's x, then its y, then its z; counter-clockwise when the axis points at the viewer."""
    scale: float = field(default=1.0, kw_only=True)
    """World units in one unit of object space; above 0."""

    def __getstate__(self) -> dict[str, Any]:
        """The fields only, without cached values: a mesh's tree and a function's code are not pickled."""
        return {attribute.name: getattr(self, attribute.name) for attribute in fields(self)}

    def to_world(self) -> Array:
        """Object space to world space, (4, 4), for column vectors."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.scale * self._rotation_matrix()
        matrix[:3, 3] = self.position
        return matrix

    def to_object(self) -> Array:
        """World space to object space, (4, 4), for column vectors."""
        matrix = np.eye(4)
        matrix[:3, :3] = self._rotation_matrix().T / self.scale
        matrix[:3, 3] = -matrix[:3, :3] @ self.position
        return matrix

    def hits(self, origin: npt.ArrayLike, directions: npt.ArrayLike) -> Hits:
        """The intersections of rays in world space: from one origin (3,), along unit directions (n, 3)."""
        rotation = self._rotation_matrix()
        object_origin = rotation.T @ (np.asarray(origin, np.float64) - self.position) / self.scale
        object_directions = np.asarray(directions, np.float64) @ rotation
        hits = self.cast(object_origin, object_directions)
        tangent = np.c_[hits.tangent[:, :3] @ rotation.T, hits.tangent[:, 3]]
        position = self.scale * hits.position @ rotation.T + self.position
        return Hits(hits.hit, np.where(hits.hit[:, None], position, 0.0), hits.normal @ rotation.T, tangent, *hits[4:])

    @abstractmethod
    def cast(self, origin: Array, directions: Array) -> Hits:
        """The intersections of rays in object space."""

    @abstractmethod
    def distance(self, points: Array) -> Array:
        """The signed distance, (n,), negative inside, from points (n, 3); all in object space."""

    def _rotation_matrix(self) -> Array:
        x, y, z = np.radians(self.rotation)
        about_x = [[1.0, 0.0, 0.0], [0.0, np.cos(x), -np.sin(x)], [0.0, np.sin(x), np.cos(x)]]
        about_y = [[np.cos(y), 0.0, np.sin(y)], [0.0, 1.0, 0.0], [-np.sin(y), 0.0, np.cos(y)]]
        about_z = [[np.cos(z), -np.sin(z), 0.0], [np.sin(z), np.cos(z), 0.0], [0.0, 0.0, 1.0]]
        matrix: Array = np.array(about_z) @ np.array(about_y) @ np.array(about_x)
        return matrix


def spread(
    hit: Bools, position: Array, normal: Array, tangent: Array, uv: Array, front: Bools | None = None,
    uv2: Array | None = None, color: Array | None = None,
) -> Hits:  # fmt: skip
    """The hits of all rays, from the values of the rays that hit; without `front` all are on front faces."""

    def with_zeros(values: Array) -> Array:
        all_rays = np.zeros((len(hit), values.shape[1]))
        all_rays[hit] = values
        return all_rays

    fronts = hit.copy()
    if front is not None:
        fronts[hit] = front
    second = np.zeros((len(hit), 2)) if uv2 is None else with_zeros(uv2)
    colors = with_zeros(np.ones((int(hit.sum()), 4)) if color is None else color)
    return Hits(
        hit, with_zeros(position), with_zeros(normal), with_zeros(tangent), with_zeros(uv), fronts, second, colors
    )


def unit(vectors: Array) -> Array:
    """The unit vectors of vectors (n, 3); those of length 0 stay."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    result: Array = vectors / np.where(length > 0.0, length, 1.0)
    return result


def any_tangent(normals: Array) -> Array:
    """An arbitrary unit tangent (n, 3) for each unit normal."""
    axes = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    return unit(np.cross(axes, normals))


def perpendiculars(normals: Array) -> tuple[Array, Array]:
    """Two unit vectors perpendicular to each unit normal (n, 3), and to each other: side × up = normal.

    Duff et al., Building an Orthonormal Basis, Revisited, 2017.
    """
    x, y, z = normals.T
    sign = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    side = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], axis=1)
    return side, np.stack([b, sign + y * y * a, -y], axis=1)


def tangent_of(normals: Array, grows_u: Array, grows_v: Array) -> Array:
    """The tangents (n, 4) of a surface whose u and v are functions of space, from their gradients (n, 3).

    v is constant along T, so T is perpendicular to the gradient of v and to the normal. Where u or v has no gradient
    along the surface, the tangent is arbitrary.
    """
    along = np.cross(grows_v, normals)
    side = np.sign(np.einsum("nc,nc->n", along, grows_u))
    undefined = (np.linalg.norm(along, axis=1) < 1e-9 * np.linalg.norm(grows_v, axis=1)) | (side == 0.0)
    tangent = np.where(undefined[:, None], any_tangent(normals), unit(along) * side[:, None])
    result: Array = np.c_[tangent, np.where(undefined, 1.0, side)]
    return result


def spherical(points: Array) -> tuple[Array, Array, Array]:
    """Longitude and latitude about the origin: u goes once around y, v from the south pole (−y) up.

    u is 0.5 at +z and 0.75 at +x; its seam is at −z.
    """
    x, y, z = points.T
    ring = np.hypot(x, z)
    uv = np.stack([0.5 + np.arctan2(x, z) / (2.0 * np.pi), 0.5 + np.arctan2(y, ring) / np.pi], axis=1)
    zero = np.zeros_like(x)
    return uv, np.stack([z, zero, -x], axis=1), np.stack([-x * y, ring * ring, -z * y], axis=1)


def planar(points: Array) -> tuple[Array, Array, Array]:
    """uv = the point's x and y, 0.5 at the origin; one unit of length is one unit of uv."""
    right, up = np.zeros_like(points), np.zeros_like(points)
    right[:, 0] = up[:, 1] = 1.0
    return points[:, :2] + 0.5, right, up
