"""Intersections of rays and triangles, with Embree."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array, Indices
from sssgen.scene.geometry_base import unit
from sssgen.support.extras import need

MIN_SEPARATION = 1e-6
"""Relative to the mesh's size: triangles closer to each other along a ray count as one."""
GRAZING = 1e-3
"""The cosine between ray and normal below which the intersection with the plane is ill-conditioned."""
MAX_HITS = 10_000
"""The largest number of triangles along a ray."""


class AllHits(NamedTuple):
    """The triangles that rays hit; those of a ray in their order along it, except for rounding."""

    rays: Indices
    """(m,)"""
    faces: Indices
    """(m,)"""
    t: Array
    """(m,), the distance along the ray; exact to float64 unless the ray grazes the triangle"""


class MeshRays:
    """Casts rays at triangles: `places` (v, 3) and `corners` (f, 3), as in `mesh.Triangles`.

    Embree computes in float32: it gets the mesh centred and scaled to size 1, and only finds the triangle; the distance
    is computed here. Raises SssgenError without embreex.
    """

    def __init__(self, places: Array, corners: Indices) -> None:
        scenes, meshes = need("embreex.rtcore_scene", "embreex"), need("embreex.mesh_construction", "embreex")
        low, high = places.min(axis=0), places.max(axis=0)
        self.middle, self.size = 0.5 * (low + high), float((high - low).max())
        first, second, third = np.moveaxis(places[corners], 1, 0)
        self._first, self._flat = first, unit(np.cross(second - first, third - first))
        self._scene: Any = scenes.EmbreeScene()
        meshes.TriangleMesh(self._scene, self._scale(places), corners.astype(np.int32))

    def first(self, origins: Array, directions: Array) -> Indices:
        """The first triangle that each ray hits, (n,); -1 for a miss. Directions are unit."""
        return self._cast(origins, directions)[0]

    def nearest(self, origins: Array, directions: Array) -> tuple[Indices, Array]:
        """The first triangle of each ray, (n,), -1 for a miss, and its distance, at least 0."""
        faces, ahead = self._cast(origins, directions)
        # Embree may still see a triangle just ahead that in float64 is just behind: a path that goes back to it, and a
        # step ahead, would never end
        return faces, np.maximum(self._lengths(faces, origins, directions, ahead), 0.0)

    def all(self, origins: Array, directions: Array, beyond: float = 0.0) -> AllHits:
        """Every triangle that rays hit, from about the distance `beyond` on. Directions are unit."""
        active = np.arange(len(origins))
        reached = np.full(len(origins), beyond)
        hits = []
        for _ in range(MAX_HITS):
            before = reached[active]
            faces, ahead = self._cast(origins[active] + before[:, None] * directions[active], directions[active])
            hit = faces >= 0
            active, faces, before, ahead = active[hit], faces[hit], before[hit], ahead[hit]
            if not len(active):
                break
            t = self._lengths(faces, origins[active], directions[active], before + ahead)
            hits.append(AllHits(active, faces, t))
            reached[active] = np.maximum(t, before) + MIN_SEPARATION * self.size
        if not hits:
            return AllHits(active, active, np.zeros(0))
        return AllHits(*(np.concatenate(parts) for parts in zip(*hits, strict=True)))

    def _lengths(self, faces: Indices, origins: Array, directions: Array, about: Array) -> Array:
        """The distances of triangles along rays in float64; `about` are those in float32, for rays that graze."""
        slope = np.einsum("nc,nc->n", directions, self._flat[faces])
        height = np.einsum("nc,nc->n", self._first[faces] - origins, self._flat[faces])
        lengths: Array = np.divide(height, slope, out=about.copy(), where=np.abs(slope) > GRAZING)
        return lengths

    def _cast(self, origins: Array, directions: Array) -> tuple[Indices, Array]:
        """The first triangle of each ray, and its distance in float32 precision."""
        if not len(origins):
            return np.zeros(0, np.int64), np.zeros(0)
        result = self._scene.run(self._scale(origins), directions.astype(np.float32), query="INTERSECT", output=1)
        return result["primID"].astype(np.int64), self.size * result["tfar"].astype(np.float64)

    def _scale(self, points: Array) -> npt.NDArray[np.float32]:
        scaled: npt.NDArray[np.float32] = ((points - self.middle) / self.size).astype(np.float32)
        return scaled
