"""The length along the eye's ray for every direction, as spherical harmonics of order 2: a directional map's texels.

A texel stores f(w) = 1 - exp(-d(w) / m), where d(w) is the length inside the body along w up to the first exit, and m a
length near the mean free path of the medium: a long way and a longer one look alike, and f is bounded. Nine numbers
are fitted to f by least squares over the inward hemisphere. A projection would need f on the other hemisphere too,
where no eye's ray enters.

The harmonics are those of directions in object space. Their span does not change with rotations, so the fit is as good
as in a tangent frame, needs no tangents, and can be filtered across seams of texture coordinates.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sssgen.lab.reference.inside_lengths import first_exit, thickness
from sssgen.scene.arrays import Array, Bools
from sssgen.scene.bounds import world_corners
from sssgen.scene.geometry import Geometry
from sssgen.scene.geometry_base import perpendiculars

NUMBERS = 9
"""The harmonics up to order 2."""
LARGEST = 8.0
"""The largest coefficient, as the technique's parameters allow; only points with few rays reach it."""
RAYS = 64
"""Directions of a fit."""
RIDGE = 1e-12
"""Added to the normal equations, relative to the number of rays: a solution for points with too few rays."""


def harmonics(directions: Array) -> Array:
    """The real spherical harmonics up to order 2 of unit directions (..., 3), without constant factors: (..., 9)."""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.stack([np.ones_like(x), x, y, z, x * y, y * z, z * x, 3.0 * z * z - 1.0, x * x - y * y], axis=-1)


def inward(normals: Array, count: int) -> Array:
    """Directions over the hemispheres about −`normals`, (n, 3): (n, count, 3), with a density of their cosine.

    A picture shows a piece of the surface with an area of this cosine, so all directions have the same weight.
    """
    index = np.arange(count)
    radius, angle = np.sqrt((index + 0.5) / count), index * math.pi * (3.0 - math.sqrt(5.0))  # a Fibonacci spiral
    local = np.stack([radius * np.cos(angle), radius * np.sin(angle), -np.sqrt(1.0 - radius**2)], axis=1)
    side, up = perpendiculars(normals)
    directions: Array = local @ np.stack([side, up, normals], axis=1)
    return directions


def fit_coefficients(values: Array, directions: Array, valid: Bools) -> Array:
    """The coefficients (n, 9) of least squares to `values` (n, k) at `directions` (n, k, 3), where `valid`.

    They are at most LARGEST.
    """
    terms = harmonics(directions)
    weighted = terms * valid[..., None]
    squares = np.einsum("nki,nkj->nij", weighted, terms) + RIDGE * values.shape[1] * np.eye(NUMBERS)
    products = np.einsum("nki,nk->ni", weighted, values)
    coefficients = np.linalg.solve(squares, products[..., None])[..., 0]
    return np.clip(coefficients, -LARGEST, LARGEST)


def fade_length(geometry: Geometry, mean_free_path: float) -> float:
    """The length m in world units: the mean free path, but at most a quarter of the body's longest side.

    In a clear medium every length would be a small share of the mean free path.
    """
    longest: float = np.ptp(world_corners(geometry), axis=0).max()
    return min(mean_free_path, 0.25 * longest)


class Fit(NamedTuple):
    """The fit of surface points."""

    coefficients: Array
    """(n, 9)"""
    error: Array
    """(n,): the root of the mean square of the differences from f"""
    lost: Array
    """(n,): the share of rays without a length inside, which do not count: they leave through a hole"""


def of_points(geometry: Geometry, points: Array, normals: Array, mean_free_path: float, rays: int = RAYS) -> Fit:
    """The fit at surface points with unit normals, (n, 3) each, in world space."""
    directions = inward(normals, rays)
    origins = np.broadcast_to(points[:, None], directions.shape).reshape(-1, 3)
    ways = np.ascontiguousarray(directions.reshape(-1, 3))
    length = first_exit(geometry, origins, ways)
    valid = length > 0.0
    short = np.flatnonzero(~valid)
    valid[short] = thickness(geometry, origins[short], ways[short]) > 0.0  # the ray leaves at once, at an edge
    length, valid = length.reshape(-1, rays), valid.reshape(-1, rays)
    turned = directions @ geometry.to_object()[:3, :3].T * geometry.scale
    share = 1.0 - np.exp(-length / mean_free_path)
    coefficients = fit_coefficients(share, turned, valid)
    difference = np.where(valid, np.einsum("nki,ni->nk", harmonics(turned), coefficients) - share, 0.0)
    count = valid.sum(axis=1)
    error = np.sqrt((difference**2).sum(axis=1) / np.maximum(count, 1))
    return Fit(coefficients, error, 1.0 - count / rays)
