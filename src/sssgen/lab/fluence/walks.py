"""Random walks that serve the lights of all directions at once, in an isotropic medium without refraction.

Light that is scattered isotropically forgets where it came from, so the multiply scattered fluence is linear in the
density of first collisions, which is known: for a light in the direction w it is extinction exp(-extinction l(y, w)) at
each point y, with l the length inside the body from y towards w. So walks start at points inside the body, and what a
walk leaves in the voxels counts for each direction with the light that is left at the walk's start. A photon of
`photons`, which also handles refraction and other phase functions, serves one direction.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.photons import STEP, Medium, Singles, Tracer
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene.geometry import Geometry
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

CELLS = 96
"""The cells of the clearances, along the longest side."""
FOLLOWED = 1 << 15
"""About the walks that are followed together: as many as the processor's caches hold."""
EVEN = 0.1
"""The part of the walks that all starts share alike; the others are shared in proportion to the light."""
FAINT = 0.1
"""The weight, relative to the start's, below which Russian roulette ends most walks."""
SURVIVAL = 0.3


class Starts(NamedTuple):
    """Points inside a body, evenly spread, and how far they are from its surface in some directions."""

    points: Array
    """(n, 3)"""
    lengths: Singles
    """(n, directions): the length inside the body towards each direction"""
    volume: float
    """The volume that each point stands for"""


class Walks:
    """Follows walks through one body."""

    def __init__(self, tracer: Tracer, geometry: Geometry) -> None:
        """`geometry` is the body of the tracer's mesh."""
        self.tracer, self.geometry = tracer, geometry
        grid = tracer.grid
        size = grid.high - grid.low
        x, y, z = np.maximum(np.rint(CELLS * size / size.max()).astype(int), 1)
        self.cells = Grid(grid.low, grid.high, (int(x), int(y), int(z)))
        reach = 0.5 * float(np.linalg.norm(size / np.array(self.cells.shape)))
        # within this distance of any point of the cell there is no surface, also for a mesh that is somewhat off
        depth = -geometry.distance(self.cells.centres()[:, 0])
        self.clearance: Singles = np.maximum(0.98 * depth - reach, 0.0).astype(np.float32)

    def starts(self, count: int, towards: Array, rng: np.random.Generator) -> Starts:
        """About `count` points inside, and their lengths towards directions (d, 3)."""
        grid = self.tracer.grid
        size = grid.high - grid.low
        part = max(float((self.clearance > 0.0).mean()), 0.01)
        tries = int(np.ceil(count / part))
        # a lattice in three dimensions, which is more even than random points: Kronecker's
        steps = np.array([0.8191725133961645, 0.6710436067037893, 0.5497004779019703])
        points = grid.low + (np.arange(tries)[:, None] * steps + rng.random(3)) % 1.0 * size
        points = points[self.geometry.distance(points) < 0.0]
        return Starts(points, self.tracer.lengths(points, towards), float(np.prod(size)) / tries)

    def trace(self, medium: Medium, starts: Starts, walks: int, rng: np.random.Generator) -> Singles:
        """The estimates of `Tracer.trace`, (directions, voxels), of about `walks` walks."""
        light: Singles = np.exp(-np.float32(medium.extinction) * starts.lengths)
        mean = light.mean(axis=1)
        # most walks start where most light arrives; the chance of a walk is its weight's inverse
        expected = (1.0 - EVEN) * mean / max(float(mean.sum()), 1e-30) + EVEN / max(len(mean), 1)
        expected *= walks
        grid = self.tracer.grid
        result = np.zeros((light.shape[1], grid.voxels), np.float32)
        group = max(len(expected) * FOLLOWED // max(walks, 1), 1)
        for first in range(0, len(expected), group):
            some = slice(first, first + group)
            left = self._collisions(medium, starts.points[some], expected[some], rng)
            result += (left.T @ light[some]).T
        result *= np.float32(medium.albedo * starts.volume / (4.0 * grid.volume))
        return result

    def _collisions(self, medium: Medium, points: Array, expected: Singles, rng: np.random.Generator) -> Any:
        """The weights of the collisions of walks from each point, a sparse matrix (points, voxels).

        `expected` is the mean number of walks from each.
        """
        sparse = need("scipy.sparse", "scipy", "chart")
        start = np.repeat(np.arange(len(points)), np.floor(expected + rng.random(len(expected))).astype(np.int64))
        position = points[start].astype(np.float32)
        first_weight = (1.0 / expected).astype(np.float32)
        weight = first_weight[start]
        direction = _isotropic(len(start), rng)
        found: list[tuple[Indices, Indices, Singles]] = []
        while len(start):
            free, collides, gone = self._flight(medium, position, direction, rng)
            position = position + free[:, None] * direction
            at = np.flatnonzero(collides)
            found.append((start[at], self.tracer.grid.texel_of(position[at], rng), weight[at]))
            direction[at] = _isotropic(len(at), rng)
            weight[at] *= np.float32(medium.albedo)
            faint = weight < FAINT * first_weight[start]
            weight[faint] /= np.float32(SURVIVAL)
            keep = ~gone & (~faint | (rng.random(len(faint), dtype=np.float32) < SURVIVAL))
            start, position, direction, weight = start[keep], position[keep], direction[keep], weight[keep]
        rows, columns, weights = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return sparse.csr_matrix((weights, (rows, columns)), shape=(len(points), self.tracer.grid.voxels))

    def _flight(
        self, medium: Medium, position: Singles, direction: Singles, rng: np.random.Generator
    ) -> tuple[Singles, npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """How far each photon flies, whether it collides there, and whether it has left; else it is at a surface."""
        rays = self.tracer.rays
        free = rng.standard_exponential(len(position), dtype=np.float32) / np.float32(medium.extinction)
        collides, gone = np.ones(len(free), np.bool_), np.zeros(len(free), np.bool_)
        # the others cannot reach a surface
        may = np.flatnonzero(free >= self.clearance[self.cells.voxel_of(position)])
        ways = direction[may].astype(np.float64)
        face, ahead = rays.nearest(position[may].astype(np.float64), ways)
        ahead = np.maximum(ahead, 0.0)
        leaves = np.einsum("nc,nc->n", ways, self.tracer.normals[face]) > 0.0
        gone[may] = face < 0
        collides[may] = (face >= 0) & leaves & (free[may] < ahead)
        free[may] = np.where(collides[may], free[may], ahead + STEP * rays.size)
        return free, collides, gone


def _isotropic(count: int, rng: np.random.Generator) -> Singles:
    """Directions with equal probabilities, (count, 3)."""
    z = 2.0 * rng.random(count, dtype=np.float32) - 1.0
    angle = np.float32(2.0 * np.pi) * rng.random(count, dtype=np.float32)
    across = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)
