"""Texels whose trilinear interpolation is nearest to a field inside a body.

A voxel's mean as its texel blurs the field twice, since a shader interpolates it again. So the texels t are those with
the least integral, over the inside, of the squared difference of sum_i t_i h_i and the field, where h_i is the hat of
texel i, its weight in the interpolation: M t = b, M_ij the integral of h_i h_j, b_i that of h_i times the field. Light
tracing estimates b as it estimates means: see `Grid.texel_of`. Voxels with too little inside have no texel of their
own: they show that of the nearest other one, which has their hats, too.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.voxels import Grid
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

LEAST_PART = 0.02
"""Texels with a smaller part of their hat inside get the values of the nearest other texel."""
EVENNESS = 0.01
"""The weight of the differences between neighbours, which decides where the field does not."""
SPREAD = 4
"""Of the points in a voxel that is wholly inside, one of so many counts, for all."""


class Projection:
    """The texels of one grid and body."""

    def __init__(self, grid: Grid, covered: Array, points: Array | None = None) -> None:
        """`covered` (voxels, n) is the part inside of each of the cells about the points of `grid.centres`; fields are
        evaluated at `points` (voxels, n, 3), if they are given, in place of these."""
        sparse = need("scipy.sparse", "scipy", "chart")
        self.grid = grid
        parts = round(covered.shape[1] ** (1.0 / 3.0))
        weights = _thinned(covered, parts) / covered.shape[1]
        chosen = weights > 0.0
        self.points: Array = (grid.centres(parts) if points is None else points)[chosen]
        """(points, 3): the points at which fields are evaluated"""
        self.weights: Array = weights[chosen]
        """(points,): the part of a voxel that each stands for"""
        at_points = hats(grid, self.points)
        part = np.asarray(at_points.T @ self.weights).ravel()
        self.counting: Bools = part > LEAST_PART
        """(voxels,): those with texels of their own"""
        if not self.counting.any():
            return
        self.nearest = _nearest(self.counting, grid)
        """(voxels,): for each voxel the number of the nearest counting one"""
        entries = (np.ones(grid.voxels), (np.arange(grid.voxels), self.nearest))
        self._folds: Any = sparse.csr_matrix(entries, shape=(grid.voxels, self.counting.sum()))
        self.hats: Any = (at_points @ self._folds).tocsr()
        """(points, counting), sparse"""
        self.weighted: Any = (sparse.diags(self.weights) @ self.hats).T.tocsc()
        """(counting, points), sparse: hats times weights"""
        mass = (self.weighted.tocsr() @ self.hats).tocsr()
        self.mass: Any = (mass + EVENNESS * _differences(grid, self.counting)).tocsc()
        """M, (counting, counting), sparse"""
        linear = need("scipy.sparse.linalg", "scipy", "chart")
        # for symmetric matrices
        options = {"SymmetricMode": True}
        self._solver: Any = linear.splu(self.mass, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def hats_at(self, points: Array) -> Any:
        """The values of the texels' hats at points, a sparse matrix (points, counting)."""
        return hats(self.grid, points) @ self._folds

    def integrals(self, values: Array) -> Array:
        """The integrals for values at all `points`, (rows, points): (rows, counting)."""
        result: Array = (self.weighted @ values.T).T
        return result

    def folded(self, integrals: Array) -> Array:
        """The integrals of the texels' hats for those of all voxels' hats, (rows, voxels): (rows, counting)."""
        result: Array = (self._folds.T @ integrals.T).T
        return result

    def texels(self, integrals: Array) -> Array:
        """The counting texels, (rows, counting), for integrals of hats times fields, over a voxel."""
        solved: Array = self._solver.solve(np.ascontiguousarray(integrals.T, np.float64)).T
        return solved


def inside_shares(distance: Array, size: float) -> Array:
    """The parts inside of cells with an edge `size`, for the distances of their centres: exact where the surface is
    parallel to a side."""
    return np.clip(0.5 - distance / size, 0.0, 1.0)


def _thinned(covered: Array, parts: int) -> Array:
    """The weights of the points: in voxels that are wholly inside, an even part of them counts for all."""
    if parts % SPREAD:
        return covered
    x, y, z = np.indices((parts,) * 3).reshape(3, -1)
    kept = np.where((x + 2 * y + 3 * z) % SPREAD == 0, float(SPREAD), 0.0)
    whole = (covered == 1.0).all(axis=1)
    return np.where(whole[:, None], kept, covered)


def _nearest(counting: Bools, grid: Grid) -> npt.NDArray[np.int64]:
    """For each voxel of the grid the number of the nearest counting one."""
    ndimage, shape = need("scipy.ndimage", "scipy", "chart"), grid.shape[::-1]
    where = ndimage.distance_transform_edt(~counting.reshape(shape), return_distances=False, return_indices=True)
    number: npt.NDArray[np.int64] = np.cumsum(counting) - 1
    nearest: npt.NDArray[np.int64] = number[np.ravel_multi_index(where.reshape(3, -1), shape)]
    return nearest


def hats(grid: Grid, points: Array) -> Any:
    """The values of all voxels' hats at points, a sparse matrix (points, voxels)."""
    sparse = need("scipy.sparse", "scipy", "chart")
    size = np.array(grid.shape)
    place = (points - grid.low) * (size / (grid.high - grid.low)) - 0.5
    low = np.floor(place).astype(np.int64)
    part = place - low
    columns, weights = [], []
    for corner in np.ndindex(2, 2, 2):
        x, y, z = np.clip(low + corner, 0, size - 1).T
        columns.append((z * size[1] + y) * size[0] + x)
        weights.append(np.where(corner, part, 1.0 - part).prod(axis=1))
    starts = np.arange(0, 8 * len(points) + 1, 8)
    entries = (np.stack(weights, axis=1).ravel(), np.stack(columns, axis=1).ravel(), starts)
    return sparse.csr_matrix(entries, shape=(len(points), grid.voxels))


def _differences(grid: Grid, counting: Bools) -> Any:
    """The matrix of the sum of the squared differences between neighbours along the axes."""
    sparse = need("scipy.sparse", "scipy", "chart")
    number = (np.cumsum(counting) - 1).reshape(grid.shape[::-1])
    inside = counting.reshape(grid.shape[::-1])
    total = sparse.csr_matrix((counting.sum(),) * 2)
    for axis in range(3):
        before = [slice(None)] * 3
        after = [slice(None)] * 3
        before[axis], after[axis] = slice(None, -1), slice(1, None)
        both = inside[tuple(before)] & inside[tuple(after)]
        first, second = number[tuple(before)][both], number[tuple(after)][both]
        rows = np.arange(len(first))
        edge = sparse.csr_matrix((np.ones(len(first)), (rows, first)), shape=(len(first), counting.sum()))
        edge -= sparse.csr_matrix((np.ones(len(second)), (rows, second)), shape=(len(second), counting.sum()))
        total = total + edge.T @ edge
    return total
