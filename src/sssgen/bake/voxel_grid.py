"""The box of a volume and its voxels: the positions of a distance texture's texels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.support.diagnostics import failure

Array: TypeAlias = npt.NDArray[np.float64]

LEAST = 4
"""The least number of voxels along each axis: fewer have no slope to interpolate."""
MOST = 2048
"""The largest number of voxels along an axis that every engine supports (WebGPU's limit)."""
FLAT = 1e-3
"""A side is at least this share of the box's diagonal, as in the technique's box_size."""
FARTHEST = 2.0**20
"""The largest distance of the box from the origin, in voxels: float32 coordinates cannot resolve more."""


class Grid(NamedTuple):
    """Voxels that fill a box, in the mesh's own space."""

    counts: tuple[int, int, int]
    """Along x, y and z"""
    low: Array
    """(3,), the box's smallest corner"""
    high: Array
    """(3,), the largest"""

    @property
    def voxel(self) -> Array:
        """(3,), a voxel's sides."""
        side: Array = (self.high - self.low) / np.array(self.counts)
        return side

    @property
    def diagonal(self) -> float:
        """The length of the box's diagonal."""
        return float(np.linalg.norm(self.high - self.low))

    def centers(self, x: Array, y: Array, z: Array) -> Array:
        """The centres of voxels by their indices (n,) along each axis: (n, 3)."""
        centers: Array = self.low + (np.stack([x, y, z], axis=-1) + 0.5) * self.voxel
        return centers

    def slab(self, start: int, end: int) -> Array:
        """The centres of the layers `start` to `end` along z, x fastest: (n, 3)."""
        across, up, _ = self.counts
        centers = np.empty((end - start, up, across, 3))
        for axis, (first, last) in enumerate(((0, across), (0, up), (start, end))):
            along = self.low[axis] + (np.arange(first, last) + 0.5) * self.voxel[axis]
            centers[..., axis] = along.reshape([-1 if axis == 2 - dimension else 1 for dimension in range(3)])
        return centers.reshape(-1, 3)


def around(low: Array, high: Array, resolution: Sequence[int], padding: float) -> Grid:
    """The grid around a box with two opposite corners (3,).

    `resolution` is the count along the longest side, for cubic voxels, or three counts. `padding` is the margin on
    every side relative to the longest one; if not 0, it is at least a voxel. Raises SssgenError for an invalid
    resolution or padding.
    """
    if len(resolution) not in (1, 3) or not all(LEAST <= count <= MOST for count in resolution):
        text = ",".join(map(str, resolution))
        raise failure(f"'{text}' is not a resolution", f"N or X,Y,Z, each from {LEAST} to {MOST}")
    if not 0.0 <= padding <= 10.0:
        raise failure(f"{padding:g} is not a padding", "a share of the longest side, from 0 to 10, such as 0.05")
    size, middle = high - low, 0.5 * (low + high)
    size = np.maximum(size + 2.0 * _margin(size, resolution, padding), FLAT * np.linalg.norm(size))
    if len(resolution) == 1:
        voxel = float(size.max()) / resolution[0]
        counts = [max(LEAST, math.ceil(side / voxel * (1.0 - 1e-9))) for side in size]
        size = voxel * np.array(counts)
    else:
        counts = list(resolution)
    grid = Grid((counts[0], counts[1], counts[2]), middle - 0.5 * size, middle + 0.5 * size)
    far = float(np.abs([grid.low, grid.high]).max() / grid.voxel.min())
    if far > FARTHEST:
        raise failure("the mesh is too far from its origin for the 32-bit numbers of shaders", "move it nearer")
    return grid


def _margin(size: Array, resolution: Sequence[int], padding: float) -> Array | float:
    """The margin on every side: the padding, at least a voxel, so that the grid has outside voxels."""
    if not padding:
        return 0.0
    inner = np.array(resolution) - 2  # voxels for the mesh
    voxel = size / inner if len(resolution) == 3 else size.max() / inner[0]
    margin: Array = np.maximum(padding * size.max(), voxel)
    return margin
