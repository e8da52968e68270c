"""The base of every geometry: its transform, and the intersections of rays."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Bools: TypeAlias = npt.NDArray[np.bool_]
Vector: TypeAlias = tuple[float, float, float]


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


@dataclass(frozen=True)
class Geometry(ABC):
    """A shape in object space and its transform: scaled, then rotated about x, y and z, then translated."""

    position: Vector = field(default=(0.0, 0.0, 0.0), kw_only=True)
    rotation: Vector = field(default=(0.0, 0.0, 0.0), kw_only=True)
    """Degrees about the world's x, then its y, then its z; counter-clockwise for who looks against the axis."""
    scale: float = field(default=1.0, kw_only=True)
    """World units in one unit of object space; above 0."""

    def __getstate__(self) -> dict[str, Any]:
        """The fields only, without cached values: a mesh's tree and a function's code are not pickled."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def to_world(self) -> Array:
        """Object space to world space, (4, 4), for column vectors."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.scale * self._turn()
        matrix[:3, 3] = self.position
        return matrix

    def to_object(self) -> Array:
        """World space to object space, (4, 4), for column vectors."""
        matrix = np.eye(4)
        matrix[:3, :3] = self._turn().T / self.scale
        matrix[:3, 3] = -matrix[:3, :3] @ self.position
        return matrix

    def hits(self, origin: npt.ArrayLike, directions: npt.ArrayLike) -> Hits:
        """The intersections of rays in world space: from one origin (3,), along unit directions (n, 3)."""
        turn = self._turn()
        start = turn.T @ (np.asarray(origin, np.float64) - self.position) / self.scale
        along = np.asarray(directions, np.float64) @ turn
        found = self.cast(start, along)
        hit = found.hit
        tangent = np.c_[found.tangent[:, :3] @ turn.T, found.tangent[:, 3]]
        place = self.scale * found.position @ turn.T + self.position
        return Hits(hit, np.where(hit[:, None], place, 0.0), found.normal @ turn.T, tangent, found.uv)

    @abstractmethod
    def cast(self, origin: Array, directions: Array) -> Hits:
        """The intersections of rays in object space."""

    @abstractmethod
    def distance(self, points: Array) -> Array:
        """The signed distance, (n,), negative inside, from points (n, 3); all in object space."""

    def _turn(self) -> Array:
        x, y, z = np.radians(self.rotation)
        about_x = [[1.0, 0.0, 0.0], [0.0, np.cos(x), -np.sin(x)], [0.0, np.sin(x), np.cos(x)]]
        about_y = [[np.cos(y), 0.0, np.sin(y)], [0.0, 1.0, 0.0], [-np.sin(y), 0.0, np.cos(y)]]
        about_z = [[np.cos(z), -np.sin(z), 0.0], [np.sin(z), np.cos(z), 0.0], [0.0, 0.0, 1.0]]
        turn: Array = np.array(about_z) @ np.array(about_y) @ np.array(about_x)
        return turn


def spread(hit: Bools, position: Array, normal: Array, tangent: Array, uv: Array) -> Hits:
    """Hits from the values of those rays alone that hit."""

    def whole(part: Array) -> Array:
        values = np.zeros((len(hit), part.shape[1]))
        values[hit] = part
        return values

    return Hits(hit, whole(position), whole(normal), whole(tangent), whole(uv))


def unit(vectors: Array) -> Array:
    """Vectors (n, 3) brought to length 1; those of length 0 stay."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    brought: Array = vectors / np.where(length > 0.0, length, 1.0)
    return brought


def any_tangent(normals: Array) -> Array:
    """Some unit tangent (n, 3) for each unit normal."""
    axes = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    return unit(np.cross(axes, normals))


def tangent_of(normals: Array, grows_u: Array, grows_v: Array) -> Array:
    """The tangent (n, 4) of a surface whose u and v come from the space around it, by their gradients (n, 3).

    Along T v stays, so T stands on both the gradient of v and the normal. Where u or v has no gradient along the
    surface any tangent serves.
    """
    along = np.cross(grows_v, normals)
    side = np.sign(np.einsum("nc,nc->n", along, grows_u))
    lost = (np.linalg.norm(along, axis=1) < 1e-9 * np.linalg.norm(grows_v, axis=1)) | (side == 0.0)
    tangent = np.where(lost[:, None], any_tangent(normals), unit(along) * side[:, None])
    framed: Array = np.c_[tangent, np.where(lost, 1.0, side)]
    return framed


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
