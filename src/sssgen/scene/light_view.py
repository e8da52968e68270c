"""A light's view of a body: the ray of each texel of its depth map, and the matrix from positions to texels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sssgen.scene.arrays import Array

MARGIN = 1.1
"""The width of the map relative to the body."""
LEAST_DEPTH = 0.1
"""The least depth of a corner of the body's box in the view of a lamp, relative to that of the middle of the box: the
lamp may be in the box, or beside it."""
FAR = 2.0
"""The depth of a texel whose ray hits nothing, in widths of the map: behind the whole body."""


class LightView(NamedTuple):
    """A light's depth map, before it is measured; row 0 is at v = 0."""

    matrix: Array
    """(4, 4): position → (u w, v w, distance from the light's plane, w)"""
    origins: Array
    """(h * w, 3): the origins of the texels' rays: on the light's plane, or at the light"""
    directions: Array
    """(h * w, 3), unit"""
    slopes: Array
    """(h * w,): the distance from the plane per unit of length along a ray"""
    far: float
    """The depth of a texel whose ray hits nothing"""


def directional_view(corners: Array, towards: Array, size: tuple[int, int]) -> LightView:
    """The view along −`towards` (unit) on a body within `corners` (n, 3); `size` is (width, height) in texels."""
    side, up = _frame(-towards)
    spans = [corners @ axis for axis in (side, up)]
    right, high = (0.5 * float(span.min() + span.max()) for span in spans)
    wide = MARGIN * max(float(np.ptp(span)) for span in spans)
    start = float((corners @ towards).max()) + 0.1 * wide  # the light's plane
    across, along = (((np.arange(count) + 0.5) / count - 0.5) * wide for count in size)
    x, y = np.meshgrid(across + right, along + high)
    origins = x.reshape(-1, 1) * side + y.reshape(-1, 1) * up + start * towards
    matrix = np.zeros((4, 4))
    matrix[0, :3], matrix[0, 3] = side / wide, 0.5 - right / wide
    matrix[1, :3], matrix[1, 3] = up / wide, 0.5 - high / wide
    matrix[2, :3], matrix[2, 3] = -towards, start
    matrix[3, 3] = 1.0
    directions = np.broadcast_to(-towards, origins.shape).copy()
    return LightView(matrix, origins, directions, np.ones(len(origins)), FAR * wide)


def is_before(corners: Array, position: Array) -> bool:
    """Whether all of a body within `corners` is before a light that looks at it from `position`."""
    ahead = corners.mean(axis=0) - position
    return bool(((corners - position) @ ahead).min() > 0.01 * (ahead @ ahead))


def point_view(corners: Array, position: Array, size: tuple[int, int]) -> LightView:
    """The view from `position` on a body within `corners`. A light in the box sees what is before it."""
    ahead = corners.mean(axis=0) - position
    distance = float(np.linalg.norm(ahead))
    ahead = ahead / distance if distance else np.array([0.0, 0.0, 1.0])
    local = corners - position
    depth = np.maximum(local @ ahead, max(LEAST_DEPTH * distance, 1e-3 * float(np.ptp(corners))))
    side, up = _frame(ahead)
    wide = MARGIN * 2.0 * max(float(np.abs(local @ axis / depth).max()) for axis in (side, up))  # at distance 1
    across, along = (((np.arange(count) + 0.5) / count - 0.5) * wide for count in size)
    x, y = np.meshgrid(across, along)
    ways = x.reshape(-1, 1) * side + y.reshape(-1, 1) * up + ahead
    lengths = np.linalg.norm(ways, axis=1)
    matrix = np.zeros((4, 4))
    matrix[3, :3], matrix[3, 3] = ahead, -position @ ahead
    for row, axis in enumerate((side, up)):
        matrix[row, :3], matrix[row, 3] = axis / wide, -position @ axis / wide
        matrix[row] += 0.5 * matrix[3]
    matrix[2] = matrix[3]
    origins = np.broadcast_to(position, ways.shape).copy()
    far = float(depth.max()) + FAR * wide * distance
    return LightView(matrix, origins, ways / lengths[:, None], 1.0 / lengths, far)


def _frame(ahead: Array) -> tuple[Array, Array]:
    """Unit axes to the right and up of a view along `ahead`."""
    side = np.cross(-ahead, np.eye(3)[np.argmin(np.abs(ahead))])
    side /= np.linalg.norm(side)
    return side, np.cross(side, ahead)
