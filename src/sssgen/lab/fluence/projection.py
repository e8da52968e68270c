"""Texels whose trilinear interpolation is nearest to a field inside a body.

A voxel's mean as its texel blurs the field twice, since a shader interpolates it again. So the texels t are those with
the least integral, over the inside, of the squared difference of sum_i t_i h_i and the field, where h_i is the hat of
texel i, its weight in the interpolation: M t = b, M_ij the integral of h_i h_j, b_i that of h_i times the field. Light
tracing estimates b as it estimates means: see `Grid.texel_of`.
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


class Projection:
    """The texels of one grid and body."""

    def __init__(self, grid: Grid, covered: Array) -> None:
        """`covered` (voxels, n) is the part inside of each of the cells about the points of `grid.centres`."""
        self._covered = covered
        hats = hats_at(grid, self.points(grid))
        shares = need("scipy.sparse", "scipy", "chart").diags(covered[covered > 0.0] / covered.shape[1])
        self._shares: Any = (shares @ hats).T.tocsr()
        part = np.asarray(self._shares.sum(axis=1)).ravel()
        self.counting: Bools = part > LEAST_PART
        if self.counting.any():
            linear = need("scipy.sparse.linalg", "scipy", "chart")
            mass = (self._shares @ hats).tocsr()[self.counting][:, self.counting]
            matrix = (mass + EVENNESS * _differences(grid, self.counting)).tocsc()
            # for symmetric matrices
            options = {"SymmetricMode": True}
            self._solver: Any = linear.splu(matrix, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def points(self, grid: Grid) -> Array:
        """The points whose cells are not outside, (points, 3)."""
        parts = round(self._covered.shape[1] ** (1.0 / 3.0))
        result: Array = grid.centres(parts)[self._covered > 0.0]
        return result

    def integrals(self, values: Array) -> Array:
        """The integrals for values at all `points`, (rows, points): (rows, voxels)."""
        result: Array = (self._shares @ values.T).T
        return result

    def texels(self, integrals: Array) -> Array:
        """The counting texels, (rows, counting), for integrals of hats times fields, (rows, voxels) over a voxel."""
        solved: Array = self._solver.solve(np.ascontiguousarray(integrals[:, self.counting].T, np.float64)).T
        return solved


def inside_shares(distance: Array, size: float) -> Array:
    """The parts inside of cells with an edge `size`, for the distances of their centres: exact where the surface is
    parallel to a side."""
    return np.clip(0.5 - distance / size, 0.0, 1.0)


def hats_at(grid: Grid, points: Array) -> Any:
    """The values of the texels' hats at points, a sparse matrix (points, voxels)."""
    sparse = need("scipy.sparse", "scipy", "chart")
    size = np.array(grid.shape)
    place = (points - grid.low) * (size / (grid.high - grid.low)) - 0.5
    low = np.floor(place).astype(np.int64)
    part = place - low
    rows, columns, weights = [], [], []
    for corner in np.ndindex(2, 2, 2):
        x, y, z = np.clip(low + corner, 0, size - 1).T
        rows.append(np.arange(len(points)))
        columns.append((z * size[1] + y) * size[0] + x)
        weights.append(np.where(corner, part, 1.0 - part).prod(axis=1))
    entries = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
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
