"""The grid of voxels about a body: nearly cubic, and how much of each voxel is inside."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

PARTS = 4
"""The points along each axis of a voxel at which the body's distance is evaluated."""


class Grid(NamedTuple):
    """A box of voxels in world space."""

    low: Array
    high: Array
    """(3,): the corners"""
    shape: tuple[int, int, int]
    """The voxels along x, y, z"""

    @property
    def count(self) -> int:
        return self.shape[0] * self.shape[1] * self.shape[2]

    @property
    def volume(self) -> float:
        """The volume of a voxel."""
        return float(np.prod(self.high - self.low)) / self.count

    def index(self, points: Array) -> npt.NDArray[np.int64]:
        """The voxel of each point, (n,), x first; points outside belong to the nearest."""
        size = np.array(self.shape)
        cell = ((points - self.low) * (size / (self.high - self.low))).astype(np.int64)
        x, y, z = np.clip(cell, 0, size - 1).T
        return (z * size[1] + y) * size[0] + x

    def centres(self, parts: int = 1) -> Array:
        """Points in each voxel, (voxels, parts^3, 3), evenly spaced."""
        offsets = (np.arange(parts) + 0.5) / parts
        z, y, x = np.meshgrid(*(np.arange(count) for count in self.shape[::-1]), indexing="ij")
        cells = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)[:, None]
        c, b, a = np.meshgrid(offsets, offsets, offsets, indexing="ij")
        inner = np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)[None]
        points: Array = self.low + (cells + inner) * ((self.high - self.low) / np.array(self.shape))
        return points


def grid_of(corners: Array, voxels: int) -> Grid:
    """The grid about `corners` (n, 3) with `voxels` along its longest side."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    step = float((high - low).max()) / voxels
    shape = np.maximum(np.ceil((high - low) / step - 1e-6).astype(int), 1)
    centre, half_size = 0.5 * (low + high), 0.5 * step * shape
    x, y, z = map(int, shape)
    return Grid(centre - half_size, centre + half_size, (x, y, z))
