"""The surface of a body for random paths: the next crossing of each ray, exact for boxes and balls."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.geometry import Ball, Box, Geometry, Slab
from sssgen.scene.geometry_mesh import RESOLUTION, box_size, mesh_of
from sssgen.scene.mesh_rays import AllHits, MeshRays

Array = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

MESH_STEP, EXACT_STEP = 1e-5, 1e-8
"""The distance from a crossed surface at which a path continues, in sizes of the body: above the rounding of Embree's
float32, and of float64."""

_BACK = 0.02
"""How far from a point of the geometry its place on the mesh is searched, in sizes of the body."""
_TRIES = 4


class Crossing(NamedTuple):
    """The next crossings of n rays."""

    found: Bools
    """(n,)"""
    ahead: Array
    """(n,): the distance"""
    normal: Array
    """(n, 3): outward, unit; of the triangle for a mesh"""


class SurfaceRays:
    """Casts rays at the surface of a geometry, in world space."""

    def __init__(self, geometry: Geometry, resolution: int = RESOLUTION) -> None:
        """Shapes other than box, slab and ball are triangles: `mesh_of`, with its SssgenError."""
        self.geometry, self.resolution = geometry, resolution
        self.to_object, self.scale = geometry.to_object(), geometry.scale
        self.size = float(np.ptp(self.vertices, axis=0).max())
        self.step = self.size * (EXACT_STEP if isinstance(geometry, Box | Slab | Ball) else MESH_STEP)

    @cached_property
    def _mesh(self) -> tuple[Array, npt.NDArray[np.int64]]:
        return mesh_of(self.geometry, self.resolution)

    @property
    def vertices(self) -> Array:
        """(v, 3): those of the mesh."""
        return self._mesh[0]

    @cached_property
    def _rays(self) -> MeshRays:
        return MeshRays(*self._mesh)

    @cached_property
    def _normals(self) -> Array:
        vertices, faces = self._mesh
        first, second, third = np.moveaxis(vertices[faces], 1, 0)
        normal = np.cross(second - first, third - first)
        normals: Array = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        return normals

    def next(self, origins: Array, directions: Array) -> Crossing:
        """The nearest crossing in front of each origin."""
        if isinstance(self.geometry, Box | Slab):
            return self._box(0.5 * np.array(box_size(self.geometry)), origins, directions)
        if isinstance(self.geometry, Ball):
            return self._ball(self.geometry.radius, origins, directions)
        faces, ahead = self._rays.nearest(origins, directions)
        return Crossing(faces >= 0, ahead, self._normals[faces])

    def entrances(self, places: Array, normals: Array, directions: Array) -> Array:
        """The points (n, 3) at which the eye's rays enter the body, for the points of the geometry that it sees.

        The triangles of a mesh are a little in front of the geometry or behind it. Where a ray misses them, which
        happens at a silhouette, the point is moved along the normal.
        """
        result = places.copy()
        if self.step == EXACT_STEP * self.size:
            return result
        back = _BACK * self.size
        left = np.arange(len(places))
        for ways in (directions, -normals):
            active, start = left, places - back * ways
            for _ in range(_TRIES):
                crossing = self.next(start[active], ways[active])
                start[active] += np.where(crossing.found, crossing.ahead, 0.0)[:, None] * ways[active]
                enters = np.einsum("nc,nc->n", ways[active], crossing.normal) < 0.0
                near = np.linalg.norm(start[active] - places[active], axis=1) <= back
                reached = active[crossing.found & enters & near]
                result[reached] = start[reached]
                left = np.setdiff1d(left, reached)
                active = active[crossing.found & ~enters]
                start[active] += self.step * ways[active]
        return result

    def all(self, origins: Array, directions: Array) -> tuple[AllHits, Array]:
        """All crossings with the mesh, and the cosines of direction and outward normal."""
        hits = self._rays.all(origins, directions)
        return hits, np.einsum("nc,nc->n", directions[hits.rays], self._normals[hits.faces])

    def _local(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        rotation = self.to_object[:3, :3]
        return origins @ rotation.T + self.to_object[:3, 3], directions @ rotation.T * self.scale

    def _outward(self, normal: Array) -> Array:
        outward: Array = normal @ self.to_object[:3, :3] * self.scale
        return outward

    def _box(self, half: Array, origins: Array, directions: Array) -> Crossing:
        start, ray = self._local(origins, directions)
        safe = np.where(np.abs(ray) < 1e-15, np.copysign(1e-15, ray), ray)
        centre, reach = -start / safe, half / np.abs(safe)
        enter, leave = (centre - reach), (centre + reach)
        first, last = enter.max(axis=1), leave.min(axis=1)
        inside = first <= 0.0
        ahead = np.where(inside, last, first)
        axis = np.where(inside, leave.argmin(axis=1), enter.argmax(axis=1))
        at = np.arange(len(ray))
        normal = np.zeros_like(ray)
        normal[at, axis] = np.where(inside, 1.0, -1.0) * np.sign(safe[at, axis])
        return Crossing((first < last) & (ahead > 0.0), self.scale * ahead, self._outward(normal))

    def _ball(self, radius: float, origins: Array, directions: Array) -> Crossing:
        start, ray = self._local(origins, directions)
        middle = -np.einsum("nc,nc->n", start, ray)
        closest = start + middle[:, None] * ray
        square = radius**2 - np.einsum("nc,nc->n", closest, closest)
        half = np.sqrt(np.maximum(square, 0.0))
        ahead = np.where(middle - half > 0.0, middle - half, middle + half)
        normal = (start + ahead[:, None] * ray) / radius
        return Crossing((square > 0.0) & (ahead > 0.0), self.scale * ahead, self._outward(normal))
