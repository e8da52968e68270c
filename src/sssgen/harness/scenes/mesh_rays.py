"""Where rays pass triangles, by Embree."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.harness.scenes.placed import Array, unit
from sssgen.support.extras import need

Indices: TypeAlias = npt.NDArray[np.int64]

APART = 1e-6
"""Of the mesh's size: triangles that are nearer to each other along a ray count as one."""
GRAZING = 1e-3
"""A triangle's plane that a ray meets more flatly than this says not well where."""
MOST = 10_000
"""Triangles along a ray."""


class Passed(NamedTuple):
    """The triangles that rays pass; those of a ray in their order along it, but for rounding."""

    rays: Indices
    """(m,)"""
    faces: Indices
    """(m,)"""
    t: Array
    """(m,), how far along the ray, right to float64 where it does not graze the triangle"""


class MeshRays:
    """Casts rays at triangles: `places` (v, 3) and `corners` (f, 3), as `mesh.Triangles` has them.

    Embree counts in 32 bits: it is given the mesh about its middle, one unit large, and only says which triangle; where
    on it is computed here. Raises SssgenError without embreex.
    """

    def __init__(self, places: Array, corners: Indices) -> None:
        scenes, meshes = need("embreex.rtcore_scene", "embreex"), need("embreex.mesh_construction", "embreex")
        low, high = places.min(axis=0), places.max(axis=0)
        self.middle, self.size = 0.5 * (low + high), float((high - low).max())
        first, second, third = np.moveaxis(places[corners], 1, 0)
        self._first, self._flat = first, unit(np.cross(second - first, third - first))
        self._scene: Any = scenes.EmbreeScene()
        meshes.TriangleMesh(self._scene, self._scaled(places), corners.astype(np.int32))

    def first(self, origins: Array, directions: Array) -> Indices:
        """The first triangle that each ray meets, (n,); -1 where there is none. Directions are unit."""
        return self._cast(origins, directions)[0]

    def nearest(self, origins: Array, directions: Array) -> tuple[Indices, Array]:
        """The first triangle of each ray, (n,), -1 where there is none, and how far it is."""
        faces, ahead = self._cast(origins, directions)
        return faces, self._lengths(faces, origins, directions, ahead)

    def all(self, origins: Array, directions: Array) -> Passed:
        """Every triangle that rays pass, from their origins on. Directions are unit."""
        going = np.arange(len(origins))
        reached = np.zeros(len(origins))
        found = []
        for _ in range(MOST):
            before = reached[going]
            faces, ahead = self._cast(origins[going] + before[:, None] * directions[going], directions[going])
            met = faces >= 0
            going, faces, before, ahead = going[met], faces[met], before[met], ahead[met]
            if not len(going):
                break
            t = self._lengths(faces, origins[going], directions[going], before + ahead)
            found.append(Passed(going, faces, t))
            reached[going] = np.maximum(t, before) + APART * self.size
        if not found:
            return Passed(going, going, np.zeros(0))
        return Passed(*(np.concatenate(parts) for parts in zip(*found, strict=True)))

    def _lengths(self, faces: Indices, origins: Array, directions: Array, about: Array) -> Array:
        """How far triangles are along rays, in float64, where float32 says about how far."""
        slope = np.einsum("nc,nc->n", directions, self._flat[faces])
        way = np.einsum("nc,nc->n", self._first[faces] - origins, self._flat[faces])
        lengths: Array = np.divide(way, slope, out=about.copy(), where=np.abs(slope) > GRAZING)
        return lengths

    def _cast(self, origins: Array, directions: Array) -> tuple[Indices, Array]:
        """The first triangle of each ray, and the way to it, right to float32."""
        if not len(origins):
            return np.zeros(0, np.int64), np.zeros(0)
        found = self._scene.run(self._scaled(origins), directions.astype(np.float32), query="INTERSECT", output=1)
        return found["primID"].astype(np.int64), self.size * found["tfar"].astype(np.float64)

    def _scaled(self, points: Array) -> npt.NDArray[np.float32]:
        scaled: npt.NDArray[np.float32] = ((points - self.middle) / self.size).astype(np.float32)
        return scaled
