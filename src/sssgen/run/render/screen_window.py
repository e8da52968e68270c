"""The part of a picture that a body covers: only its pixels are drawn."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from sssgen.run.render import pixel_mesh
from sssgen.scene.arrays import Array
from sssgen.scene.camera import Camera


class Window(NamedTuple):
    """A rectangle of a picture."""

    camera: Camera
    """That of the whole picture"""
    whole: tuple[int, int]
    """Width and height of the whole picture"""
    x: int
    y: int
    """The first column and the first row, from the bottom"""
    width: int
    height: int

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return self.width, self.height

    def rays(self) -> tuple[Array, Array]:
        """As `Camera.rays`, for the pixels of the window."""
        origin, directions = _rays(self.camera, *self.whole)
        return origin, self.of(directions.reshape(*self.whole[::-1], 3)).reshape(-1, 3)

    def of(self, picture: Array) -> Array:
        """The window of a picture, row 0 at the bottom."""
        return picture[self.y : self.y + self.height, self.x : self.x + self.width]

    def to_clip(self) -> Array:
        """Clip space of the whole picture to that of the window, (4, 4)."""
        matrix = np.eye(4)
        for axis, (start, part, whole) in enumerate(zip((self.x, self.y), self.size, self.whole, strict=True)):
            matrix[axis, axis] = whole / part
            matrix[axis, 3] = (whole - 2 * start) / part - 1.0
        return matrix


def whole_window(camera: Camera, size: tuple[int, int]) -> Window:
    """The whole picture."""
    return Window(camera, size, 0, 0, *size)


def window_of(corners: Array, camera: Camera, size: tuple[int, int]) -> Window | None:
    """The window around the corners (8, 3) of a body's box, with a border; None where the camera does not see it."""
    width, height = size
    right, up, forward = camera.axes()
    x, y, depth = np.stack([right, up, forward]) @ (corners - np.array(camera.position)).T
    if depth.max() <= 0.0:
        return None
    if depth.min() <= 1e-3 * depth.max():  # the camera is in the box, or beside it
        return whole_window(camera, size)
    half = np.tan(np.radians(0.5 * camera.field_of_view))
    columns = (x / (depth * half * width / height) + 1.0) * 0.5 * width
    rows = (y / (depth * half) + 1.0) * 0.5 * height
    edge = 1 + pixel_mesh.BORDER
    low_x, high_x = (int(np.clip(value, 0, width)) for value in (columns.min() - edge, columns.max() + edge + 1))
    low_y, high_y = (int(np.clip(value, 0, height)) for value in (rows.min() - edge, rows.max() + edge + 1))
    if high_x - low_x <= 2 * edge or high_y - low_y <= 2 * edge:
        return None
    return Window(camera, size, low_x, low_y, high_x - low_x, high_y - low_y)


@lru_cache(1)
def _rays(camera: Camera, width: int, height: int) -> tuple[Array, Array]:
    return camera.rays(width, height)
