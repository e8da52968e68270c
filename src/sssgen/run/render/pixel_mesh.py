"""Surface points as a mesh that fills the screen, with one vertex at the centre of each pixel.

Drivers may rasterise and interpolate with different last bits, so that pictures of the same triangles differ at
silhouettes. With micropolygons as in REYES (Cook, Carpenter and Catmull 1987) the emitted vertex and fragment shaders
run unchanged, and every driver shades exactly the same points. Pixels that miss the surface are masked afterwards.
"""

from __future__ import annotations

import numpy as np

from sssgen.run.backends import Array
from sssgen.scene.geometry import Hits


def vertices(hits: Hits, origin: Array, directions: Array, model: Array, size: tuple[int, int]) -> Array:
    """(width * height, `VERTEX_SIZE`) float32: the attributes of `Drawing.vertices`, in object space.

    `hits` are in world space, row by row from the bottom. A pixel without a hit has the attributes and distance of a
    neighbour with one: a steep slope at the surface's edge would make rounding visible.
    """
    hit = hits.hit
    distance = np.linalg.norm(hits.position - origin, axis=1)
    distance = _extend(distance[:, None], hit, size, [distance[hit].mean() if hit.any() else 1.0])
    position = np.where(hit[:, None], hits.position, origin + distance * directions)
    inverse = np.linalg.inv(model)
    placed = position @ inverse[:3, :3].T + inverse[:3, 3]
    normal = hits.normal @ model[:3, :3]  # the shell multiplies by the inverse transpose
    tangent = hits.tangent[:, :3] @ inverse[:3, :3].T
    around = np.concatenate([normal, tangent, hits.tangent[:, 3:], hits.uv, hits.uv2, hits.color], axis=1)
    around = _extend(around, hit, size, [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, *4 * [0.0], *4 * [1.0]])
    return np.concatenate([placed, around], axis=1).astype(np.float32)


def _extend(values: Array, valid: Array, size: tuple[int, int], other: list[float]) -> Array:
    """Values extended by a pixel to their invalid neighbours; pixels further away have the value `other`."""
    width, height = size
    extended, filled = values.reshape(height, width, -1).copy(), valid.reshape(height, width).copy()
    for axis in (0, 1):
        for step in (-1, 1):
            from_neighbour = np.roll(filled, step, axis)
            edge = -1 if step == -1 else 0
            from_neighbour[(edge, slice(None)) if axis == 0 else (slice(None), edge)] = False
            new = from_neighbour & ~filled
            extended[new] = np.roll(extended, step, axis)[new]
            filled |= new
    extended[~filled] = other
    return extended.reshape(len(values), -1)


def triangles(size: tuple[int, int], front: bool = True) -> Array:
    """(count, 3) uint32: two triangles for each four neighbouring vertices, all front faces or all back faces.

    The edge of the mesh passes through the centres of the outermost pixels, which may or may not be covered: the caller
    crops them (see `BORDER`).
    """
    width, height = size
    a = (np.arange(height - 1)[:, None] * width + np.arange(width - 1)).ravel()
    cells = [[a, a + 1, a + width], [a + width, a + 1, a + width + 1]]
    corners = np.stack([np.stack(cell, axis=1) for cell in cells], axis=1).reshape(-1, 3).astype(np.uint32)
    return corners if front else corners[:, ::-1]


BORDER = 1
"""The number of pixels to add on every side, which are cropped."""
