"""The octahedral map: unit directions on a square, as in Cigolle et al., A Survey of Efficient Representations for
Independent Unit Vectors, JCGT 2014."""

from __future__ import annotations

import math
from typing import Any

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


def side_of(maps: npt.NDArray[Any]) -> int:
    """The side of octahedral maps whose texels are the first axis of an array."""
    return math.isqrt(len(maps))


def mix(vectors: Array, side: int) -> tuple[npt.NDArray[np.int64], Array]:
    """The four texels of a map of directions that are nearest to unit vectors (n, 3), and their weights: (n, 4) each.

    Beyond an edge of the map lies the same edge, reversed.
    """
    x, y, z = vectors.T
    whole = np.abs(vectors).sum(axis=1)
    x, y = x / whole, y / whole
    folded_x, folded_y = (1.0 - np.abs(y)) * np.copysign(1.0, x), (1.0 - np.abs(x)) * np.copysign(1.0, y)
    column = np.where(z < 0.0, folded_x, x) * 0.5 * side + 0.5 * side - 0.5
    row = np.where(z < 0.0, folded_y, y) * 0.5 * side + 0.5 * side - 0.5
    left, low = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
    right, high = column - left, row - low
    texels = [_texel(left + i, low + j, side) for j in (0, 1) for i in (0, 1)]
    weights = [(1.0 - right, right)[i] * (1.0 - high, high)[j] for j in (0, 1) for i in (0, 1)]
    return np.stack(texels, axis=1), np.stack(weights, axis=1)


def _texel(column: npt.NDArray[np.int64], row: npt.NDArray[np.int64], side: int) -> npt.NDArray[np.int64]:
    """The number of a texel, also of one beside the map; a corner outside is the corner inside."""
    beside, above = (column < 0) | (column >= side), (row < 0) | (row >= side)
    mirrored_row = np.where(beside & ~above, side - 1 - row, row)
    mirrored_column = np.where(above & ~beside, side - 1 - column, column)
    texel: npt.NDArray[np.int64] = np.clip(mirrored_row, 0, side - 1) * side + np.clip(mirrored_column, 0, side - 1)
    return texel
