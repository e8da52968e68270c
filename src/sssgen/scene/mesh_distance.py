"""The signed distance to triangles: exact to the nearest point, its sign by the generalised winding number."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.support.extras import need

INSIDE = 0.5
"""The winding number above which a point is inside; a half also closes the holes of an open mesh."""

FLAT = 1e-9
"""The volume over the cube of the box's diagonal up to which a mesh has none."""

MIXED = (
    "neighbouring triangles face opposite directions, so that the inside is not well defined: make their normals agree"
)
"""The warning for triangles with `mixed_sides`."""


def turned_text(number: int) -> str:
    """That so many triangles disagree with their neighbours, as text."""
    if number == 1:
        return "1 triangle faces the other way than its neighbours"
    return f"{number} triangles face the other way than their neighbours"


class MeshDistance:
    """Distances to triangles: `places` (v, 3) and `corners` (f, 3), as in `mesh.Triangles`.

    The winding number (Jacobson, Kavan, Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized Winding
    Numbers, 2013) is defined also for open, self-intersecting and non-manifold meshes; the fast method is that of
    Barill et al. (Fast Winding Numbers for Soups and Clouds, 2018). A mesh that is inside out is reversed. Raises
    SssgenError without libigl.
    """

    def __init__(self, places: Array, corners: npt.NDArray[np.int64]) -> None:
        igl = need("igl", "libigl")
        self.inside_out = is_inside_out(places, corners)
        self.places = np.ascontiguousarray(places)
        self.corners = np.ascontiguousarray(corners[:, ::-1] if self.inside_out else corners)
        self.rim = rim_length(self.places, self.corners)
        """The length of the borders of the holes; 0 for a closed mesh"""
        self._tree = igl.AABB()
        self._tree.init(self.places, self.corners)
        self._winding = igl.FastWindingNumberBVH()
        self._winding.init(self.places, self.corners)

    def unsigned_distance(self, points: Array) -> Array:
        """The distance to the nearest point of the triangles, (n,)."""
        squares = self._tree.squared_distance(self.places, self.corners, np.ascontiguousarray(points))[0]
        distance: Array = np.sqrt(squares)
        return distance

    def winding_number(self, points: Array) -> Array:
        """The winding numbers of points: 1 inside a closed mesh, 0 outside; with an error of about 0.01."""
        numbers: Array = self._winding.winding_number(np.ascontiguousarray(points))
        return numbers

    def signed_distance(self, points: Array) -> Array:
        """The distance, negative inside, (n,)."""
        return np.where(self.winding_number(points) > INSIDE, -1.0, 1.0) * self.unsigned_distance(points)


def is_inside_out(places: Array, corners: npt.NDArray[np.int64]) -> bool:
    """Whether the triangles enclose a negative volume, relative to their centre."""
    return volume_of(places, corners) < 0.0


def volume_of(places: Array, corners: npt.NDArray[np.int64]) -> float:
    """The volume between the triangles and their centre, negative where most face it."""
    first, second, third = np.moveaxis(places[corners] - places.mean(axis=0), 1, 0)
    return float(np.einsum("nc,nc->", first, np.cross(second, third))) / 6.0


def is_sheet(places: Array, corners: npt.NDArray[np.int64]) -> bool:
    """Whether the triangles enclose no volume: all are in a plane, or the two sides of a sheet are one."""
    size = float(np.linalg.norm(np.ptp(places[corners.ravel()], axis=0)))
    return abs(volume_of(places, corners)) <= FLAT * size**3


def rim_length(places: Array, corners: npt.NDArray[np.int64]) -> float:
    """The total length of the edges that are not traversed equally often in both directions, times the difference."""
    edges, _, passed = _edges(corners)
    lengths = np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1)
    return float((np.abs(passed) * lengths).sum())


def open_edges(corners: npt.NDArray[np.int64]) -> int:
    """The number of edges that are not traversed equally often in both directions; 0 for a closed mesh."""
    return int(np.count_nonzero(_edges(corners)[2]))


def mixed_sides(corners: npt.NDArray[np.int64]) -> bool:
    """Whether two triangles share an edge with no other and face opposite ways: both traverse it in one direction."""
    _, number, passed = _edges(corners)
    return bool(((number == 2) & (np.abs(passed) == 2.0)).any())


def _edges(corners: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.intp], Array]:
    """The edges (e, 2), the number of triangles of each, and the difference of their traversals in both directions."""
    starts, ends = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    count = int(corners.max()) + 1
    edges, edge_of = np.unique(low * count + high, return_inverse=True)
    number = np.bincount(edge_of.ravel(), minlength=len(edges))
    passed = np.bincount(edge_of.ravel(), np.where(starts < ends, 1.0, -1.0), len(edges)).astype(np.float64)
    return np.stack([edges // count, edges % count], axis=1), number, passed
