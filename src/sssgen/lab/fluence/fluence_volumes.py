"""Fluence as textures: a few volumes and a table of light directions, or one volume for a fixed light."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.factors import factors
from sssgen.lab.fluence.fluence_field import Field
from sssgen.lab.fluence.voxels import Grid

Array = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]

FLOOR = 0.03
"""The value, relative to the field's 99th percentile, below which errors count as at this value."""
REACH = 6.0
"""The largest distance that a volume stores, in voxels."""
CHANNELS = 4
"""Of a texel of the table."""


class FactoredVolumes(NamedTuple):
    """Fluence = map 0 + sum over k of latent k times map k."""

    latents: Bytes
    """(z, y, x, rank): numbers in 0..1, times 255"""
    table: Array
    """(side + 2, tiles (side + 2), 4): octahedral maps with a border of one texel, as `pack_maps` places them"""


def factor_field(field: Field, rank: int) -> FactoredVolumes:
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
    table = np.concatenate([add_border(square) for square in pack_maps(squares)], axis=1)
    stored = np.rint(255.0 * (latents - low) / size).astype(np.uint8)
    return FactoredVolumes(stored[field.nearest].reshape(*field.grid.shape[::-1], rank), table)


def tiles_of(rank: int) -> int:
    """The tiles of the table of `rank` latents."""
    return -(-3 * (rank + 1) // CHANNELS)


def pack_maps(maps: Array) -> Array:
    """Maps (n, side, side, 3) in fewer tiles of four channels: the last ones are in the alphas of the first ones."""
    tiles = np.zeros((tiles_of(len(maps) - 1), *maps.shape[1:3], CHANNELS))
    tiles[..., :3] = maps[: len(tiles)]
    rest = np.moveaxis(maps[len(tiles) :], 3, 1).reshape(-1, *maps.shape[1:3])
    tiles[: len(rest), ..., 3] = rest
    return tiles


def add_border(tile: Array) -> Array:
    """An octahedral map (side, side, channels) with a border: across an edge lies the same edge, reversed."""
    wide = np.pad(tile, ((1, 1), (1, 1), (0, 0)), mode="edge")
    wide[0, 1:-1], wide[-1, 1:-1] = tile[0, ::-1], tile[-1, ::-1]
    wide[1:-1, 0], wide[1:-1, -1] = tile[::-1, 0], tile[::-1, -1]
    return wide


class LightVolume(NamedTuple):
    """Light of one light = scale times the square of a texel; its alpha is the distance from the surface."""

    texels: Bytes
    """(z, y, x, 4): numbers in 0..1, times 255"""
    scale: Array
    """(3,)"""
    reach: float
    """The distance outside that alpha 1 stands for, inside alpha 0, in object space"""


def light_volume(field: Field) -> LightVolume:
    """The volume of a field of one light."""
    values = np.maximum(field.values[:, 0].T, 0.0)
    scale = np.maximum(values.max(axis=0), 1e-12)
    light = np.rint(255.0 * np.sqrt(values / scale)[field.nearest]).astype(np.uint8)
    texels = np.concatenate([light, stored_distance(field)[:, None]], axis=1)
    return LightVolume(texels.reshape(*field.grid.shape[::-1], 4), scale, reach_of(field.grid))


def stored_distance(field: Field) -> Bytes:
    """The distance of each voxel of the grid from the surface, for a texel's alpha."""
    share = np.clip(0.5 + 0.5 * field.distance / reach_of(field.grid), 0.0, 1.0)
    stored: Bytes = np.rint(255.0 * share).astype(np.uint8)
    return stored


def reach_of(grid: Grid) -> float:
    """The largest distance that a volume stores."""
    return REACH * float(((grid.high - grid.low) / np.array(grid.shape)).max())
