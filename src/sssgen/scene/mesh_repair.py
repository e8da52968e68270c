"""What a mesh gets before it is used: vertices that differ by rounding become one, copies of triangles are left out,
and flipped triangles are turned."""

from __future__ import annotations

from itertools import product

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array, Indices
from sssgen.scene.mesh_distance import mixed_sides
from sssgen.support.extras import need

ROUNDING = 1e-6
"""The side of the cells in which vertices of a mesh that is open otherwise become one, relative to the mesh's longest
side: more than the rounding of float32, and less than any detail."""


def welded(vertices: Array, faces: Indices) -> tuple[Array, Indices]:
    """The places (p, 3) of vertices (v, 3), and the place (v,) of each.

    Vertices at the same position have one place. Where the triangles (f, 3) are then open, so have those that differ
    by rounding: a seam is no hole.
    """
    places, place_of = np.unique(vertices, axis=0, return_inverse=True)
    place_of = place_of.reshape(-1)
    low, size = places.min(axis=0), float(np.ptp(places, axis=0).max())
    for shift in product((0.0, 0.5), repeat=3):  # a border of cells that parts two vertices is in the middle of others
        if size == 0.0 or has_inside(place_of[faces]):
            break
        cells = ((places - low) / (ROUNDING * size) + shift).astype(np.int64)
        key = cells @ np.array([1, 2**20, 2**40])
        _, first, cell_of = np.unique(key, return_index=True, return_inverse=True)
        places, place_of = places[first], cell_of.reshape(-1)[place_of]
    return places, place_of


def has_inside(faces: Indices) -> bool:
    """Whether each edge of the triangles (f, 3) has equally many in both directions: the mesh has an inside. Vertices
    at one place are one vertex."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    count = int(faces.max()) + 1
    forward = edges[:, 0] * count + edges[:, 1]
    backward = edges[:, 1] * count + edges[:, 0]
    return np.array_equal(np.sort(forward), np.sort(backward))


def repeated(corners: Indices) -> npt.NDArray[np.bool_]:
    """The triangles (f,) that an earlier one is equal to: a body that lies on its own copy is one body."""
    start = corners.argmin(axis=1)
    turned = np.stack([np.take_along_axis(corners, (start + step)[:, None] % 3, 1)[:, 0] for step in range(3)], axis=1)
    order = np.lexsort(turned.T)  # a stable sort
    same = (np.diff(turned[order], axis=0) == 0).all(axis=1)
    result = np.zeros(len(corners), np.bool_)
    result[order[1:]] = same
    return result


def flipped(corners: Indices, areas: Array) -> npt.NDArray[np.bool_]:
    """The triangles (f,) that must be turned so that neighbours face the same way: of each part the smaller area.

    None where all agree, and where they cannot, as on a Möbius strip.
    """
    none = np.zeros(len(corners), np.bool_)
    if not mixed_sides(corners):
        return none
    oriented, part = need("igl", "libigl").bfs_orient(np.ascontiguousarray(corners, np.int64))
    if mixed_sides(np.asarray(oriented)):
        return none
    turned, part = (np.asarray(oriented) != corners).any(axis=1), np.asarray(part).ravel()
    is_most = np.bincount(part, np.where(turned, areas, -areas)) > 0.0
    result: npt.NDArray[np.bool_] = turned != is_most[part]
    return result
