"""The lengths of chords inside a body from points of its surface: the work items of thickness maps.

The mean over inward directions is an integral over the triangles of a closed mesh, without rays, where a few rays per
point confirm that no parts overlap; elsewhere it is that of many rays.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from sssgen.bake.mean_length import MeanLength
from sssgen.bake.voxel_grid import Array
from sssgen.lab.reference import view_harmonics
from sssgen.lab.reference.inside_lengths import thickness
from sssgen.lab.reference.view_harmonics import Fit
from sssgen.scene.geometry_base import perpendiculars
from sssgen.scene.inside_intervals import alternate
from sssgen.scene.mesh import Mesh

CHECKS = 2
"""Rays per point that check a mesh before its integral is used."""
ODD = 0.002
"""The share of these rays that may cross the surface in another way: those through edges, by rounding."""


class Chords(NamedTuple):
    """The chords of surface points; arrays are (n,)."""

    value: Array
    error: Array
    """The value's standard error, or that of the quadrature; 0 where it is exact"""
    lost: Array
    """The share of rays that leave through a hole, which are excluded"""
    rays: Array
    """The number of rays"""


@lru_cache(2)
def _mesh(path: str, digest: str) -> Mesh:
    """The mesh, read once per process and content."""
    return Mesh(path=path)


def along(path: str, digest: str, points: Array, directions: Array, attenuation: float) -> Chords:
    """The length inside the mesh from points along unit `directions`, (n, 3) each; or exp(−length / attenuation)."""
    length = thickness(_mesh(path, digest), points, directions)
    value = np.exp(-length / attenuation) if attenuation else length
    return Chords(value, np.zeros(len(length)), np.zeros(len(length)), np.ones(len(length)))


@lru_cache(2)
def _integral(path: str, digest: str) -> MeanLength:
    mesh = _mesh(path, digest)
    corners = mesh.triangles.corners
    return MeanLength(mesh.triangles.places, corners[:, ::-1] if mesh.inside_out else corners)


def mean(path: str, digest: str, points: Array, normals: Array, rays: int, seed: tuple[int, int]) -> Chords:
    """The mean over inward directions, as `inward`, below groups of near points of a closed mesh: (g, k, 3) each.

    The results are (g k,). `rays` are cast only below groups where the mesh has overlapping parts.
    """
    groups = []
    for number, group in enumerate(zip(points, normals, strict=True)):
        of_group = seed[0], seed[1] + number
        starts, ways = _rays(*group, CHECKS, of_group)
        if alternate(_mesh(path, digest), starts, ways).mean() < 1.0 - ODD:
            groups.append(inward(path, digest, *group, rays, 0.0, of_group))
        else:
            value, error = _integral(path, digest).at(*group)
            groups.append(Chords(value, error, np.zeros(len(value)), np.zeros(len(value))))
    return Chords(*(np.concatenate(parts) for parts in zip(*groups, strict=True)))


def inward(
    path: str, digest: str, points: Array, normals: Array, rays: int, attenuation: float, seed: tuple[int, int]
) -> Chords:
    """The mean over inward directions, weighted by their cosine to −`normals`.

    The unit square of directions has rays / 2 cells with two random rays each, whose difference gives an
    unbiased standard error of the stratified mean (Cochran, Sampling Techniques, 1977, 5A.11).
    """
    starts, directions = _rays(points, normals, rays, seed)
    length = thickness(_mesh(path, digest), starts, directions).reshape(2, len(points), rays // 2)
    valid = length > 0.0
    value = np.exp(-length / attenuation) if attenuation else length
    number = valid.sum(axis=(0, 2))
    mean = np.where(valid, value, 0.0).sum(axis=(0, 2)) / np.maximum(number, 1)
    pairs = valid.all(axis=0)
    spread = np.where(pairs, (value[0] - value[1]) ** 2, 0.0).sum(axis=1)
    error = np.sqrt(spread) / (2.0 * np.maximum(pairs.sum(axis=1), 1))
    return Chords(mean, error, 1.0 - number / rays, np.full(len(points), rays))


def _rays(points: Array, normals: Array, rays: int, seed: tuple[int, int]) -> tuple[Array, Array]:
    """The starts and directions of rays inward, each (rays n, 3): of the first ray in each cell of a point, then of the
    second.
    """
    cells, rng = rays // 2, np.random.Generator(np.random.Philox(key=[seed[0], seed[1]]))
    columns = max(side for side in range(1, math.isqrt(cells) + 1) if cells % side == 0)
    cell = np.arange(cells)
    u, v = rng.random((2, 2, len(points), cells))
    u, v = (cell % columns + u) / columns, (cell // columns + v) / (cells // columns)
    radius, angle = np.sqrt(u), 2.0 * np.pi * v
    side, up = perpendiculars(normals)
    parts = radius * np.cos(angle), radius * np.sin(angle), -np.sqrt(np.maximum(1.0 - u, 0.0))
    directions = sum(part[..., None] * axis[:, None] for part, axis in zip(parts, (side, up, normals), strict=True))
    starts = np.broadcast_to(points[:, None], directions.shape)
    return starts.reshape(-1, 3), np.ascontiguousarray(directions.reshape(-1, 3))


def directional(path: str, digest: str, points: Array, normals: Array, fade_length: float, rays: int) -> Fit:
    """The length along every inward direction, fitted by nine numbers."""
    return view_harmonics.of_points(_mesh(path, digest), points, normals, fade_length, rays)
