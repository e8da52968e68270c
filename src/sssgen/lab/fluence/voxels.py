"""The grid of voxels about a body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Grid(NamedTuple):
    """A box of voxels in the body's object space."""

    low: Array
    high: Array
    """(3,): the corners"""
    shape: tuple[int, int, int]
    """The voxels along x, y, z"""

    @property
    def voxels(self) -> int:
        """The number of voxels."""
        return self.shape[0] * self.shape[1] * self.shape[2]

    @property
    def volume(self) -> float:
        """The volume of a voxel."""
        return float(np.prod(self.high - self.low)) / self.voxels

    def voxel_of(self, points: Array) -> npt.NDArray[np.int64]:
        """The voxel of each point, (n,), x first; points outside belong to the nearest."""
        size = np.array(self.shape)
        cell = ((points - self.low) * (size / (self.high - self.low))).astype(np.int64)
        x, y, z = np.clip(cell, 0, size - 1).T
        voxel: npt.NDArray[np.int64] = (z * size[1] + y) * size[0] + x
        return voxel

    def centres(self, parts: int = 1) -> Array:
        """Points in each voxel, (voxels, parts^3, 3), evenly spaced."""
        offsets = (np.arange(parts) + 0.5) / parts
        z, y, x = np.meshgrid(*(np.arange(count) for count in self.shape[::-1]), indexing="ij")
        cells = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)[:, None]
        c, b, a = np.meshgrid(offsets, offsets, offsets, indexing="ij")
        inner = np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)[None]
        points: Array = self.low + (cells + inner) * ((self.high - self.low) / np.array(self.shape))
        return points
