"""Surface points as a mesh that fills the screen, one vertex a pixel, in the pixel's centre.

A rasteriser is free in the last bits: two drivers cover edges differently and interpolate differently, so pictures of
the same triangles differ at silhouettes. Diced as in REYES (Cook, Carpenter and Catmull 1987) the emitted shader runs
as it is, vertex and fragment stage, and every driver shades exactly the same points. What misses the surface is masked
afterwards.
"""

from __future__ import annotations

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.scenes.geometry import Hits


def vertices(hits: Hits, origin: Array, directions: Array, model: Array, size: tuple[int, int]) -> Array:
    """(width * height, 12) float32: position, normal, tangent with handedness and uv, in object space.

    `hits` are in world space, row by row from the bottom. A pixel that meets nothing has the attributes and the
    distance of a neighbour that does, so that the surface's edge has no steep slope, whose rounding would show.
    """
    hit = hits.hit
    distance = np.linalg.norm(hits.position - origin, axis=1)
    distance = _grown(distance[:, None], hit, size, [distance[hit].mean() if hit.any() else 1.0])
    position = np.where(hit[:, None], hits.position, origin + distance * directions)
    inverse = np.linalg.inv(model)
    placed = position @ inverse[:3, :3].T + inverse[:3, 3]
    normal = hits.normal @ model[:3, :3]  # the shell multiplies by the inverse transpose
    tangent = hits.tangent[:, :3] @ inverse[:3, :3].T
    around = np.concatenate([normal, tangent, hits.tangent[:, 3:], hits.uv], axis=1)
    around = _grown(around, hit, size, [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    return np.concatenate([placed, around], axis=1).astype(np.float32)


def _grown(values: Array, known: Array, size: tuple[int, int], other: list[float]) -> Array:
    """Values that also their unknown neighbours have, all around; what is further away has the other value."""
    width, height = size
    grown, seen = values.reshape(height, width, -1).copy(), known.reshape(height, width).copy()
    for axis in (0, 1):
        for step in (-1, 1):
            from_there = np.roll(seen, step, axis)
            edge = -1 if step == -1 else 0
            from_there[(edge, slice(None)) if axis == 0 else (slice(None), edge)] = False
            new = from_there & ~seen
            grown[new] = np.roll(grown, step, axis)[new]
            seen |= new
    grown[~seen] = other
    return grown.reshape(len(values), -1)


def triangles(size: tuple[int, int]) -> Array:
    """(count, 3) uint32: two triangles for each four neighbours, and around them none: the edge pixels lie on it.

    A vertex stands in each pixel's centre, which an edge of the mesh may or may not cover: the outermost pixels are the
    caller's to cut off (see `BORDER`).
    """
    width, height = size
    a = (np.arange(height - 1)[:, None] * width + np.arange(width - 1)).ravel()
    cells = [[a, a + 1, a + width], [a + width, a + 1, a + width + 1]]
    return np.stack([np.stack(cell, axis=1) for cell in cells], axis=1).reshape(-1, 3).astype(np.uint32)


BORDER = 1
"""Pixels to add on every side, which the mesh may not cover."""
