"""The lengths of chords inside a body from points of its surface: the work items of thickness maps."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from sssgen.bake.voxel_grid import Array
from sssgen.lab.reference import view_harmonics
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.lab.reference.view_harmonics import Fit
from sssgen.scene.geometry_base import perpendiculars
from sssgen.scene.mesh import Mesh


class Chords(NamedTuple):
    """The chords of surface points; arrays are (n,)."""

    value: Array
    error: Array
    """The value's standard error; 0 where it is exact"""
    lost: Array
    """The share of rays that leave through a hole, which are excluded"""


@lru_cache(2)
def _mesh(path: str, digest: str) -> Mesh:
    """The mesh, read once per process and content."""
    return Mesh(path=path)


def along(path: str, digest: str, points: Array, directions: Array, attenuation: float) -> Chords:
    """The length inside the mesh from points along unit `directions`, (n, 3) each; or exp(−length / attenuation)."""
    length = thickness(_mesh(path, digest), points, directions)
    value = np.exp(-length / attenuation) if attenuation else length
    return Chords(value, np.zeros(len(length)), np.zeros(len(length)))


def inward(
    path: str, digest: str, points: Array, normals: Array, rays: int, attenuation: float, seed: tuple[int, int]
) -> Chords:
    """The mean over inward directions, weighted by their cosine to −`normals`.

    The unit square of directions has rays / 2 cells with two random rays each, whose difference gives an
    unbiased standard error of the stratified mean (Cochran, Sampling Techniques, 1977, 5A.11).
    """
    cells = rays // 2
    count, rng = len(points), np.random.Generator(np.random.Philox(key=[seed[0], seed[1]]))
    columns = max(side for side in range(1, math.isqrt(cells) + 1) if cells % side == 0)
    cell = np.arange(cells)
    u, v = rng.random((2, 2, count, cells))
    u, v = (cell % columns + u) / columns, (cell // columns + v) / (cells // columns)
    radius, angle = np.sqrt(u), 2.0 * np.pi * v
    side, up = perpendiculars(normals)
    parts = radius * np.cos(angle), radius * np.sin(angle), -np.sqrt(np.maximum(1.0 - u, 0.0))
    directions = sum(part[..., None] * axis[:, None] for part, axis in zip(parts, (side, up, normals), strict=True))
    starts = np.broadcast_to(points[:, None], directions.shape)
    length = thickness(_mesh(path, digest), starts.reshape(-1, 3), np.ascontiguousarray(directions.reshape(-1, 3)))
    length = length.reshape(2, count, cells)
    valid = length > 0.0
    value = np.exp(-length / attenuation) if attenuation else length
    number = valid.sum(axis=(0, 2))
    mean = np.where(valid, value, 0.0).sum(axis=(0, 2)) / np.maximum(number, 1)
    pairs = valid.all(axis=0)
    spread = np.where(pairs, (value[0] - value[1]) ** 2, 0.0).sum(axis=1)
    error = np.sqrt(spread) / (2.0 * np.maximum(pairs.sum(axis=1), 1))
    return Chords(mean, error, 1.0 - number / (2 * cells))


def directional(path: str, digest: str, points: Array, normals: Array, fade_length: float, rays: int) -> Fit:
    """The length along every inward direction, fitted by nine numbers."""
    return view_harmonics.of_points(_mesh(path, digest), points, normals, fade_length, rays)
