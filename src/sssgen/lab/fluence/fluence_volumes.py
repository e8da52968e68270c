"""Fluence as textures: a few volumes and a table of light directions, or one volume for a fixed light."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.factors import factors
from sssgen.lab.fluence.fluence_field import Field

Array = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]

FLOOR = 0.03
"""The value, relative to the field's 99th percentile, below which errors count as at this value."""


class Factored(NamedTuple):
    """Fluence = table tile 0 + sum over k of latent k times table tile k."""

    latents: Bytes
    """(z, y, x, rank): numbers in 0..1, times 255"""
    table: Array
    """(side + 2, (rank + 1) (side + 2), 3): a tile for each k, an octahedral map with a border of one texel"""


def factored(field: Field, rank: int) -> Factored:
    """The field as `rank` volumes and a table."""
    channels, count, voxels = field.values.shape
    columns = field.values.reshape(channels * count, voxels).T
    smooth = field.smooth.reshape(channels * count, voxels).T
    floor = FLOOR * float(np.percentile(columns, 99.0))
    latents, rows = factors(columns, rank, floor, smooth)
    low, high = latents.min(axis=0), latents.max(axis=0)
    size = np.maximum(high - low, 1e-12)
    # the ranges of the latents belong to the table, so that the shader needs none
    tiles = np.concatenate([(low @ rows)[None], size[:, None] * rows])
    side = round(count**0.5)
    squares = tiles.reshape(rank + 1, channels, side, side).transpose(0, 2, 3, 1)
    table = np.concatenate([bordered(square) for square in squares], axis=1)
    stored = np.rint(255.0 * (latents - low) / size).astype(np.uint8)
    return Factored(stored[field.nearest].reshape(*field.grid.shape[::-1], rank), table)


def bordered(tile: Array) -> Array:
    """An octahedral map (side, side, channels) with a border: across an edge lies the same edge, reversed."""
    wide = np.pad(tile, ((1, 1), (1, 1), (0, 0)), mode="edge")
    wide[0, 1:-1], wide[-1, 1:-1] = tile[0, ::-1], tile[-1, ::-1]
    wide[1:-1, 0], wide[1:-1, -1] = tile[::-1, 0], tile[::-1, -1]
    return wide


class Fixed(NamedTuple):
    """Fluence of one light = scale times the square of a texel."""

    texels: Bytes
    """(z, y, x, 3): numbers in 0..1, times 255"""
    scale: Array
    """(3,)"""


def fixed(field: Field) -> Fixed:
    """The volume of a field of one light."""
    values = field.values[:, 0].T
    scale = np.maximum(values.max(axis=0), 1e-12)
    texels = np.rint(255.0 * np.sqrt(values / scale)).astype(np.uint8)
    return Fixed(texels[field.nearest].reshape(*field.grid.shape[::-1], 3), scale)
