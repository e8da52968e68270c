"""The signed distance to a mesh at the voxels of a grid, layer by layer to limit memory."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.bake.voxel_grid import Array, Grid
from sssgen.scene.mesh_distance import INSIDE, MeshDistance
from sssgen.support.progress import Progress

Distances: TypeAlias = npt.NDArray[np.float32]

BLOCK = 2**18
"""Points of one query, at about a hundred bytes each."""
STEP = 3 * 2**12
"""Points between two reports of the progress. libigl uses all cores from 10,000 points of a query."""
TILE = 4
"""Voxels along a side of a tile: tiles are queried in sequence."""
SPLIT = 3
"""The subdivision of a block's sides: odd, so that a block's centre is a voxel."""
COARSEST = SPLIT**3
"""Voxels along a side of the first, largest blocks."""
SLACK = 0.05
"""Five times the error of a fast winding number."""


def distances(body: MeshDistance, grid: Grid, progress: Progress = lambda *_: None) -> Distances:
    """The unsigned distances, exact except for rounding to float32: (z, y, x)."""
    across, up, deep = grid.counts
    result = np.empty((deep, up, across), np.float32)
    layers = min(deep, max(1, BLOCK // (across * up * TILE)) * TILE)
    order = _in_tiles((layers, up, across))
    for start in range(0, deep, layers):
        end = min(start + layers, deep)
        if end - start < layers:
            order = _in_tiles((end - start, up, across))
        block, points = np.empty(len(order)), grid.slab(start, end)
        for first in range(0, len(order), STEP):
            part = order[first : first + STEP]
            progress(start + (end - start) * first / len(order), deep, "layers of distances")
            block[part] = body.unsigned_distance(points[part])
        result[start:end] = block.reshape(end - start, up, across)
    progress(deep, deep, "layers of distances")
    return result


def _in_tiles(shape: tuple[int, int, int]) -> npt.NDArray[np.int64]:
    """The order of voxels tile by tile: neighbours visit the same branches of a tree."""
    z, y, x = (index.ravel() // TILE for index in np.indices(shape, np.int32))
    return np.lexsort((x, y, z))


def inside(body: MeshDistance, grid: Grid, unsigned: Distances) -> npt.NDArray[np.bool_]:
    """Which voxels are inside the mesh, by the winding number: (z, y, x).

    It is evaluated at the centres of blocks, large blocks first. A block's value decides for all its voxels, or
    for the centres of its smaller blocks, where the number cannot cross one half on the way there: see `_change`.
    """
    shape = np.array(unsigned.shape)
    size = COARSEST
    state = np.zeros(-(-shape // size), np.int8)
    before: npt.NDArray[np.float32] | None = None
    rounding = 1e-6 * grid.diagonal  # a margin around triangles
    while True:
        turns = np.zeros(state.shape, np.float32)
        reach = float(np.linalg.norm(size // 2 * grid.voxel))
        todo = np.argwhere(state == 0)
        for start in range(0, len(todo), BLOCK):
            block = todo[start : start + BLOCK]
            middle = _middle(block, size, shape)
            clear = unsigned[tuple(middle.T)].astype(np.float64)
            within = _change(body.rim, reach, clear - reach - rounding) if size > 1 else np.zeros(len(block))
            value, sure = np.zeros(len(block)), np.zeros(len(block), np.bool_)
            if before is not None:  # the value of the enclosing block may suffice
                enclosing = block // SPLIT
                there = _middle(enclosing, size * SPLIT, shape)
                way = np.linalg.norm((middle - there)[:, ::-1] * grid.voxel, axis=1)
                # no triangle is nearer to the segment between both centres: the empty balls around them cover it
                nearest = 0.5 * (clear + unsigned[tuple(there.T)] - way) - rounding
                value = before[tuple(enclosing.T)].astype(np.float64)
                sure = np.abs(value - INSIDE) > within + _change(body.rim, way, nearest) + SLACK
            z, y, x = middle[~sure].astype(np.float64).T
            value[~sure] = body.winding_number(grid.centers(x, y, z))
            sure |= (np.abs(value - INSIDE) > within + SLACK) | (size == 1)
            state[tuple(block[sure].T)] = np.where(value[sure] > INSIDE, 1, -1)
            turns[tuple(block.T)] = value
        if size == 1:
            return state > 0
        size //= SPLIT
        finer = tuple(slice(0, side) for side in -(-shape // size))
        state = state.repeat(SPLIT, axis=0).repeat(SPLIT, axis=1).repeat(SPLIT, axis=2)[finer]
        before = turns


def _middle(block: npt.NDArray[np.int64], size: int, shape: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """The voxels at the centres of blocks, (n, 3)."""
    middle: npt.NDArray[np.int64] = np.minimum(block * size + size // 2, shape - 1)
    return middle


def _change(rim: float, way: float | Array, nearest: Array) -> Array:
    """The largest change of the winding number along segments of length `way`, (n,), with no triangle within `nearest`.

    Away from triangles it depends only on the mesh's boundary edges: it is the solid angle that they span, and its
    gradient is at most rim / (4π distance²) (Biot and Savart's law). For a closed mesh it is constant there. Where a
    segment may cross a triangle, the change is unlimited.
    """
    change: Array = way * rim / (4.0 * np.pi * np.maximum(nearest, 1e-30) ** 2)
    return np.where(nearest > 0.0, change, np.inf)
