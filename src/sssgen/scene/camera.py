"""A pinhole camera: its matrix, and the rays through its pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sssgen.scene.arrays import Array, Vector


@dataclass(frozen=True)
class Camera:
    """A pinhole camera in world space, right-handed, y up.

    A camera that looks straight up or down has the orientation of one that faces −z and is then tilted.
    """

    position: Vector = (0.0, 0.0, 4.0)
    target: Vector = (0.0, 0.0, 0.0)
    """The point in the middle of the picture; must differ from `position`."""
    field_of_view: float = 40.0
    """From the picture's lower to its upper edge, in degrees; above 0, below 180."""
    near: float = 0.1
    far: float = 100.0
    """The distances along the view direction that the matrix maps to the ends of the depth range."""

    def axes(self) -> tuple[Array, Array, Array]:
        """The unit directions to the picture's right, to its top, and into it."""
        forward = np.subtract(self.target, self.position, dtype=np.float64)
        forward /= np.linalg.norm(forward)
        right = np.array([-forward[2], 0.0, forward[0]])  # forward × y
        if np.hypot(*forward[::2]) < 1e-9:
            right = np.array([1.0, 0.0, 0.0])
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    def view(self) -> Array:
        """World space to view space, (4, 4), for column vectors: x right, y up, the camera looks along −z."""
        right, up, forward = self.axes()
        matrix = np.eye(4)
        matrix[:3, :3] = right, up, -forward
        matrix[:3, 3] = -matrix[:3, :3] @ self.position
        return matrix

    def view_projection(self, aspect: float, zero_to_one: bool = False) -> Array:
        """World space to clip space, (4, 4), for column vectors; `aspect` is the picture's width over its height.

        Depth goes from −1 at `near` to 1 at `far`, as in OpenGL; with `zero_to_one` from 0 to 1, as in Direct3D,
        Vulkan, Metal and WebGPU. y is up in both.
        """
        near, far, height = self.near, self.far, self._half_height()
        low = 0.0 if zero_to_one else -1.0
        projection = np.zeros((4, 4))
        projection[0, 0] = 1.0 / (height * aspect)
        projection[1, 1] = 1.0 / height
        projection[2, 2] = (low * near - far) / (far - near)
        projection[2, 3] = (low - 1.0) * near * far / (far - near)
        projection[3, 2] = -1.0
        return projection @ self.view()

    def rays(self, width: int, height: int) -> tuple[Array, Array]:
        """The rays through the pixels' centres: their origin (3,) and unit directions (height * width, 3).

        Row by row, row 0 at the BOTTOM of the picture, in each from left to right.
        """
        right, up, forward = self.axes()
        x = ((np.arange(width) + 0.5) / width * 2.0 - 1.0) * self._half_height() * width / height
        y = ((np.arange(height) + 0.5) / height * 2.0 - 1.0) * self._half_height()
        directions = (forward + y[:, None, None] * up + x[None, :, None] * right).reshape(-1, 3)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return np.array(self.position, np.float64), directions

    def _half_height(self) -> float:
        """Half of the picture's height at distance 1."""
        return float(np.tan(np.radians(0.5 * self.field_of_view)))
