"""The octahedral map: unit directions on a square, as in Cigolle et al., A Survey of Efficient Representations for
Independent Unit Vectors, JCGT 2014."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def directions(side: int) -> Array:
    """The directions at the centres of the texels of a map, (side * side, 3), row by row."""
    centres = (np.arange(side) + 0.5) * (2.0 / side) - 1.0
    y, x = (axis.ravel() for axis in np.meshgrid(centres, centres, indexing="ij"))
    z = 1.0 - np.abs(x) - np.abs(y)
    fold = np.maximum(-z, 0.0)
    vectors = np.stack([x - np.sign(x) * fold, y - np.sign(y) * fold, z], axis=1)
    unit: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return unit


def solid_angles(side: int) -> Array:
    """The texels' solid angles, (side * side,): their sum is 4 pi."""
    centres = (np.arange(side) + 0.5) * (2.0 / side) - 1.0
    y, x = (axis.ravel() for axis in np.meshgrid(centres, centres, indexing="ij"))
    z = 1.0 - np.abs(x) - np.abs(y)
    density = (
        x * x + y * y + z * z + np.maximum(-z, 0.0) * 2.0 * (np.maximum(-z, 0.0) - np.abs(x) - np.abs(y))
    ) ** -1.5
    result: Array = density * (4.0 * np.pi / density.sum())
    return result
