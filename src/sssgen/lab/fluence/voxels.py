"""The grid of voxels about a body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.floating]


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

    def voxel_of(self, points: Numbers) -> npt.NDArray[np.int64]:
        """The voxel of each point, (n,), x first; points outside belong to the nearest."""
        size = np.array(self.shape)
        cell = np.floor((points - self.low) * (size / (self.high - self.low))).astype(np.int64)
        x, y, z = np.clip(cell, 0, size - 1).T
        voxel: npt.NDArray[np.int64] = (z * size[1] + y) * size[0] + x
        return voxel

    def texel_of(self, points: Numbers, rng: np.random.Generator) -> npt.NDArray[np.int64]:
        """A texel for each point, (n,): one of the eight around it, with its weight in their interpolation as chance.

        That of a point moved by up to half a voxel along each axis: it is in the next voxel with that chance.
        """
        moves = (rng.random((len(points), 3), dtype=np.float32) - 0.5) * (self.high - self.low) / np.array(self.shape)
        return self.voxel_of(points + moves)

    def centres(self, parts: int = 1) -> Array:
        """Points in each voxel, (voxels, parts^3, 3), evenly spaced."""
        offsets = (np.arange(parts) + 0.5) / parts
        z, y, x = np.meshgrid(*(np.arange(count) for count in self.shape[::-1]), indexing="ij")
        cells = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)[:, None]
        c, b, a = np.meshgrid(offsets, offsets, offsets, indexing="ij")
        inner = np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)[None]
        points: Array = self.low + (cells + inner) * ((self.high - self.low) / np.array(self.shape))
        return points
