"""Pictures in another size."""

from __future__ import annotations

import numpy as np

from sssgen.scene.arrays import Array


def resized(picture: Array, width: int, height: int) -> Array:
    """A picture (h, w, channels) as (height, width, channels), linear between the centres of its texels."""
    return _along(_along(picture, 0, height), 1, width)


def _along(picture: Array, axis: int, count: int) -> Array:
    place = (np.arange(count) + 0.5) * picture.shape[axis] / count - 0.5
    place = np.clip(place, 0.0, picture.shape[axis] - 1.0)
    first = np.minimum(place.astype(int), max(picture.shape[axis] - 2, 0))
    second = np.minimum(first + 1, picture.shape[axis] - 1)
    share = (place - first).reshape([-1 if each == axis else 1 for each in range(picture.ndim)])
    result: Array = (1.0 - share) * picture.take(first, axis) + share * picture.take(second, axis)
    return result
