"""Light that is scattered inside a body, for lights from many directions at once: finite elements with random flights.

In an isotropic medium, light scattered at x has last been at y with the density of a flight from x to y, whichever way
it flew: S(x) = a E[(D + S)(y)], with y the end of a random flight from x, a the albedo, S and D the light at a point
that has and has not been scattered (0 where the flight leaves the body). With the texels' hats h this is a linear
system (Galerkin; Cohen and Wallace, Radiosity and Realistic Image Synthesis, 1993, chapter 3): (M - a A) S = a A D,
M_ij the integral of h_i h_j, and A_ij that of h_i(x) E[h_j(y)], which single flights estimate for all directions of
light. No path is followed: the system has their sum. At a refracting surface flights are reflected or refracted.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.photons import MOST_WALLS, Medium, Tracer
from sssgen.lab.fluence.projection import Projection
from sssgen.lab.reference.dielectric import Dielectric
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


TOGETHER = 4
"""The flights of a point whose products are added at once: each sum passes over the whole matrix."""


class Scattered(NamedTuple):
    """Scattered light as texels."""

    texels: Array
    """(directions, counting voxels)"""
    noise: float
    """The standard error of a texel, root mean square"""


def scattered(
    rays: Tracer, projection: Projection, medium: Medium, unscattered: Array, flights: int, seed: int
) -> Scattered:
    """The scattered light of the `unscattered` (directions, counting voxels), for `flights` from each point.

    Raises SssgenError where flights leave the body by other walls than they enter by: its parts overlap.
    """
    linear = need("scipy.linalg", "scipy", "chart")
    halves = [
        _exchange(rays, projection, medium, max(flights // 2, 1), np.random.default_rng([seed, half]))
        for half in range(2)
    ]
    difference = 0.5 * (halves[0] - halves[1])
    exchange = halves[0] + halves[1]
    del halves
    exchange *= 0.5
    system = projection.mass.toarray() - medium.albedo * exchange
    try:
        factor = linear.cho_factor(system, lower=True, overwrite_a=True, check_finite=False)
    except np.linalg.LinAlgError:  # more light would return from the walls than reaches them
        message = "the light inside has no solution: parts of the body overlap, or are inside each other"
        raise failure(message, "make one surface of them, or delete the inner ones") from None
    texels: Array = linear.cho_solve(factor, medium.albedo * (exchange @ unscattered.T), check_finite=False)
    # to first order: how the mean would change if its matrix changed by half of the difference of the two
    change = linear.cho_solve(factor, medium.albedo * (difference @ (texels + unscattered.T)), check_finite=False)
    return Scattered(texels.T, float(np.sqrt(np.mean(change**2))))


def _exchange(
    rays: Tracer, projection: Projection, medium: Medium, flights: int, rng: np.random.Generator
) -> npt.NDArray[np.float64]:
    """The matrix A, (counting, counting); it is symmetric, as a flight and its reverse are equally probable."""
    points = projection.points
    count = projection.hats.shape[1]
    result = np.zeros((count, count))
    shift = rng.random(3)
    starts: list[Indices] = []
    ends: list[Array] = []
    for number in range(flights):
        # a lattice in three dimensions, which is more even than random numbers: Kronecker's
        at = np.arange(len(points)) + number * len(points)
        u, v, w = (at[:, None] * (0.8191725133961645, 0.6710436067037893, 0.5497004779019703) + shift).T % 1.0
        z, angle = 1.0 - 2.0 * u, 2.0 * np.pi * v
        across = np.sqrt(np.maximum(1.0 - z * z, 0.0))
        ways = np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)
        start, end = _ends(rays, points, ways, -np.log1p(-w) / medium.extinction, medium.boundary, rng)
        starts.append(start)
        ends.append(end)
        if len(starts) == TOGETHER or number == flights - 1:
            hats = projection.hats_at(np.concatenate(ends))
            result += (projection.weighted[:, np.concatenate(starts)] @ hats).toarray()
            starts.clear()
            ends.clear()
    result *= 0.5 / flights
    result += result.T.copy()
    return result


def _ends(
    rays: Tracer, points: Array, ways: Array, lengths: Array, boundary: Dielectric, rng: np.random.Generator
) -> tuple[Indices, Array]:
    """The numbers of the points whose flights over `lengths` inside the body end in it, and where they end."""
    number, position, direction, left = np.arange(len(points)), points, ways, lengths
    numbers: list[Indices] = []
    ends: list[Array] = []
    for _ in range(MOST_WALLS):
        keep, ahead, normal = rays.walls(position, direction)
        number, position, direction, left = number[keep], position[keep], direction[keep], left[keep]
        if not len(number):
            break
        inside = np.einsum("nc,nc->n", direction, normal) > 0.0
        stops = inside & (left < ahead)
        numbers.append(number[stops])
        ends.append(position[stops] + left[stops, None] * direction[stops])
        left = left - np.where(inside, ahead, 0.0)
        position = position + ahead[:, None] * direction
        keep = (rays.cross(position, direction, normal, boundary, rng) > 0.0) & ~stops
        number, position, direction, left = number[keep], position[keep], direction[keep], left[keep]
    return np.concatenate(numbers), np.concatenate(ends)


def solver_bytes(voxels: int) -> int:
    """The bytes that `scattered` needs for a number of counting voxels."""
    return 5 * 8 * voxels * voxels
