"""The signed distance to a mesh at the voxels of a grid, in layers, so that memory stays bounded."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ..harness.scenes.mesh_distance import INSIDE, MeshDistance
from .grid import Grid

Distances: TypeAlias = npt.NDArray[np.float32]
Progress: TypeAlias = Callable[[int, int, str], None]

BLOCK = 2**18
"""Points of one query, at about a hundred bytes each."""
SPLIT = 3
"""What a block's sides are divided by: an odd number, as a block's middle is a voxel then."""
COARSEST = SPLIT**3
"""Voxels along a side of the blocks whose sign is asked for first."""
SLACK = 0.05
"""How far a fast winding number may be from the true one, five times over."""


def distances(body: MeshDistance, grid: Grid, told: Progress = lambda *_: None) -> Distances:
    """The unsigned distances, exact but for the rounding to float32: (z, y, x)."""
    across, up, deep = grid.counts
    found = np.empty((deep, up, across), np.float32)
    layers = max(1, BLOCK // (across * up))
    for start in range(0, deep, layers):
        end = min(start + layers, deep)
        found[start:end] = body.unsigned(grid.slab(start, end)).reshape(end - start, up, across)
        told(end, deep, "distances")
    return found


def inside(body: MeshDistance, grid: Grid, unsigned: Distances) -> npt.NDArray[np.bool_]:
    """Which voxels lie inside the mesh, by the winding number: (z, y, x).

    One number stands for a whole block of voxels where it cannot cross one half within it. Off the triangles the
    winding number changes only by the view of the mesh's rims: it is the solid angle that they span, and its gradient
    at most rim / (4π distance²) (Biot and Savart's law). In a ball of radius r about a point with distance d it changes
    at most by r · rim / (4π (d − r)²); inside and outside of a closed mesh it is constant.
    """
    shape = np.array(unsigned.shape)
    size, state = COARSEST, np.zeros(-(-shape // COARSEST), np.int8)
    while True:
        reach = float(np.linalg.norm(size // 2 * grid.voxel))
        todo = np.argwhere(state == 0)
        for start in range(0, len(todo), BLOCK):
            block = todo[start : start + BLOCK]
            z, y, x = np.minimum(block * size + size // 2, shape - 1).T
            clear = unsigned[z, y, x].astype(np.float64) - reach
            turns = body.winding(grid.centers(x.astype(float), y.astype(float), z.astype(float)))
            change = body.rim * reach / (4.0 * np.pi * np.maximum(clear, 1e-30) ** 2)
            sure = (clear > 0.0) & (np.abs(turns - INSIDE) > change + SLACK) | (size == 1)
            state[tuple(block[sure].T)] = np.where(turns[sure] > INSIDE, 1, -1)
        if size == 1:
            return state > 0
        size //= SPLIT
        finer = tuple(slice(0, side) for side in -(-shape // size))
        state = state.repeat(SPLIT, axis=0).repeat(SPLIT, axis=1).repeat(SPLIT, axis=2)[finer]
