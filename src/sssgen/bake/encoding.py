"""Distances as a texture's numbers, and how far off these are."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .distance import Distances


class Encoding(NamedTuple):
    """A texture's number format."""

    dtype: str
    """NumPy's, little-endian"""
    most: int
    """What stands for 1: the largest integer; 0 for floats"""
    step: float
    """The largest distance of two neighbouring numbers between 0 and 1"""


ENCODINGS = {
    "r8": Encoding("<u1", 255, 1.0 / 255.0),
    "r16": Encoding("<u2", 65535, 1.0 / 65535.0),
    "r16f": Encoding("<f2", 0, 2.0**-11),
    "r32f": Encoding("<f4", 0, 2.0**-24),
}
"""By the names of the command line: unsigned normalised integers, and floats."""


def encode(distance: Distances, inside: npt.NDArray[np.bool_], reach: float, encoding: Encoding) -> npt.NDArray[Any]:
    """0.5 + signed distance / (2 reach), cut to 0..1, as the technique distance_texture reads it: (z, y, x)."""
    texels = np.empty(distance.shape, encoding.dtype)
    for layer in range(len(distance)):  # a layer at a time, as this goes through float64
        signed = np.where(inside[layer], -1.0, 1.0) * distance[layer]
        value = np.clip(0.5 + signed / (2.0 * reach), 0.0, 1.0)
        texels[layer] = np.rint(value * encoding.most) if encoding.most else value
    return texels


def decode(texels: npt.NDArray[Any], reach: float, encoding: Encoding) -> npt.NDArray[np.float64]:
    """The signed distances that texels stand for, as the technique distance_texture reads them."""
    value = texels.astype(np.float64) / (encoding.most or 1)
    signed: npt.NDArray[np.float64] = (2.0 * value - 1.0) * reach
    return signed


def error_at_texels(reach: float, encoding: Encoding, diagonal: float) -> float:
    """The largest error of a decoded distance within the reach: half a step, and the distances' own rounding."""
    return reach * encoding.step + 2.0**-23 * diagonal
