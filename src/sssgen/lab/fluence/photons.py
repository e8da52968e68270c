"""Light tracing: the multiply scattered fluence in a body's voxels, for light from afar from many directions.

For each direction, photons start on a rectangle across the body. They cross the surface (with Fresnel's reflection and
refraction if the medium has a refractive index), collide and scatter; each collision after the first counts in its
voxel. Behind a refracting surface the first collision counts, too: a technique cannot compute the unscattered light
there, as no straight line leads to the light. The estimate of a voxel is π times the mean radiance for an irradiance
of 1 on a plane that faces the light: the collision estimator, fluence = weight / (extinction · volume), divided by 4.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.projection import hats
from sssgen.lab.fluence.voxels import Grid
from sssgen.lab.reference.dielectric import Dielectric
from sssgen.scene.mesh_rays import MeshRays

Array = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]
Indices = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

FAINT = 1e-3
"""The weight below which Russian roulette ends most photons."""
SURVIVAL = 0.1
STEP = 1e-5
"""The distance from a crossed surface at which a photon continues, in sizes of the body: above float32's rounding."""

RAYS = 1 << 18
"""The rays that are cast together."""
PLACES = 8
"""The places of each segment of a ray at which its light counts."""
MOST_WALLS = 64
"""Walls behind these along a ray do not count."""


class Medium(NamedTuple):
    """A medium in one channel."""

    extinction: float
    albedo: float
    anisotropy: float = 0.0
    boundary: Dielectric = Dielectric(1.0)


class Body(NamedTuple):
    """A closed mesh: vertices (v, 3), and faces (f, 3), counter-clockwise seen from outside."""

    vertices: Array
    faces: Indices

    @property
    def size(self) -> float:
        return float(np.ptp(self.vertices, axis=0).max())


class Tracer:
    """Traces photons through one body; calls of `trace` are independent."""

    def __init__(self, body: Body, grid: Grid) -> None:
        self.body, self.grid = body, grid
        self.rays = MeshRays(body.vertices, body.faces)
        first, second, third = np.moveaxis(body.vertices[body.faces], 1, 0)
        normal = np.cross(second - first, third - first)
        self.step = STEP * body.size  # off a wall
        self.normals: Array = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)

    def walls(self, position: Array, direction: Array) -> tuple[Bools, Array, Array]:
        """Which rays meet a wall; of these the distances, and the walls' outward normals."""
        face, ahead = self.rays.nearest(position, direction)
        hit = face >= 0
        # rounding may put a surface behind a ray that has just crossed it: without this it would stay there
        return hit, np.maximum(ahead[hit], 0.0), self.normals[face[hit]]

    def cross(
        self, position: Array, direction: Array, normal: Array, boundary: Dielectric, rng: np.random.Generator
    ) -> Array:
        """Reflects or refracts rays at walls, and moves them off: the share of each that is left, 1 or 0."""
        turn = boundary.reflect_or_refract(direction, normal, rng)
        direction[:] = turn.direction
        position += self.step * turn.direction
        return turn.weight

    def lengths(self, points: Array, towards: Array) -> Singles:
        """The lengths inside the body from points (n, 3) towards directions (d, 3), (n, d)."""
        result = np.zeros((len(points), len(towards)), np.float32)
        group = max(RAYS // len(towards), 1)
        for first in range(0, len(points), group):
            some = points[first : first + group]
            origins, ways = np.repeat(some, len(towards), axis=0), np.tile(towards, (len(some), 1))
            total, active = np.zeros(len(origins)), np.arange(len(origins))
            for _ in range(MOST_WALLS):
                hit, ahead, normal = self.walls(origins, ways)
                active, origins, ways = active[hit], origins[hit], ways[hit]
                if not len(active):
                    break
                total[active] += np.where(np.einsum("nc,nc->n", ways, normal) > 0.0, ahead, 0.0)
                origins = origins + (ahead + self.step)[:, None] * ways
            result[first : first + group] = np.maximum(total, 0.0).reshape(len(some), -1)
        return result

    def trace(
        self, medium: Medium, towards: Array, photons: int, rng: np.random.Generator, unscattered: bool = False
    ) -> Array:
        """The estimates, (directions, voxels), of `photons` photons for each direction (d, 3) towards a light.

        With `unscattered`, or behind a refracting surface, the first collisions count, too. The estimates are the
        integrals of texels' hats times the field, over the volume of a voxel: see `projection`.
        """
        grid = self.grid
        number = np.repeat(np.arange(len(towards)), photons)
        position, areas = self._start(towards, photons, rng)
        direction = np.repeat(-towards, photons, axis=0)
        start_weight = areas / photons
        weight = start_weight[number]
        scattered = np.full(len(weight), unscattered or medium.boundary.ior != 1.0)
        sums = np.zeros(len(towards) * grid.voxels)
        while len(weight):
            keep, ahead, normal = self.walls(position, direction)
            number, weight, scattered = number[keep], weight[keep], scattered[keep]
            position, direction = position[keep], direction[keep]
            slope = np.einsum("nc,nc->n", direction, normal)
            free = -np.log1p(-rng.random(len(weight))) / medium.extinction
            collides = (slope > 0.0) & (free < ahead)
            position = position + np.where(collides, free, ahead)[:, None] * direction
            counted = collides & scattered
            cell = number[counted] * grid.voxels + grid.texel_of(position[counted], rng)
            sums += np.bincount(cell, weight[counted], len(sums))
            crosses = ~collides
            crossed, turned = position[crosses], direction[crosses]
            weight[crosses] *= self.cross(crossed, turned, normal[crosses], medium.boundary, rng)
            position[crosses], direction[crosses] = crossed, turned
            direction[collides] = scatter(direction[collides], medium.anisotropy, rng)
            weight = np.where(collides, weight * medium.albedo, weight)
            scattered = scattered | collides
            faint = weight < FAINT * start_weight[number]
            weight = np.where(faint, weight / SURVIVAL, weight)
            keep = ~faint | (rng.random(len(weight)) < SURVIVAL)
            number, weight, scattered = number[keep], weight[keep], scattered[keep]
            position, direction = position[keep], direction[keep]
        return sums.reshape(len(towards), grid.voxels) / (4.0 * medium.extinction * grid.volume)

    def arriving(
        self, extinctions: Array, boundary: Dielectric, towards: Array, rays: int, rng: np.random.Generator
    ) -> Array:
        """The light that has not been scattered, in all channels, by `rays` rays from the direction `towards` (3,),
        which are reflected and refracted. The estimates are integrals as those of `trace`: (3, voxels)."""
        middle = float(np.median(extinctions))
        position, (area,) = self._start(towards[None], rays, rng)
        direction = np.repeat(-towards[None], rays, axis=0)
        weight = np.full((3, rays), area / rays)
        sums = np.zeros((3, self.grid.voxels))
        while len(position):
            keep, ahead, normal = self.walls(position, direction)
            weight, position, direction = weight[:, keep], position[keep], direction[keep]
            inside = np.flatnonzero(np.einsum("nc,nc->n", direction, normal) > 0.0)
            share = -np.expm1(-middle * ahead[inside])
            for place in range(PLACES):
                at = -np.log1p(-share * (place + rng.random(len(inside))) / PLACES) / middle
                # the density of the places is middle exp(-middle at) / share
                length = share / (PLACES * middle) * np.exp(np.subtract.outer(middle, extinctions) * at[:, None]).T
                weights = hats(self.grid, position[inside] + at[:, None] * direction[inside])
                sums += (weights.T @ (weight[:, inside] * length).T).T
            weight[:, inside] *= np.exp(-np.outer(extinctions, ahead[inside]))
            position += ahead[:, None] * direction
            weight *= self.cross(position, direction, normal, boundary, rng)
            keep = weight.max(axis=0) > FAINT * area / rays
            weight, position, direction = weight[:, keep], position[keep], direction[keep]
        return sums / (4.0 * self.grid.volume)

    def _start(self, towards: Array, photons: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Points on a rectangle across the body for each direction, and the areas of the rectangles."""
        positions, areas = [], []
        for direction in towards:
            side = np.eye(3)[np.argmin(np.abs(direction))]
            across = np.cross(direction, side)
            across /= np.linalg.norm(across)
            along = np.cross(direction, across)
            spans = [self.body.vertices @ axis for axis in (across, along, direction)]
            (u, du), (v, dv) = ((span.min(), np.ptp(span)) for span in spans[:2])
            # the points of a lattice (Kronecker's, with the plastic number) are more even than random ones
            at = (np.arange(photons)[:, None] * (0.7548776662466927, 0.5698402909980532) + rng.random(2)) % 1.0
            start = spans[2].max() + 0.01 * self.body.size
            positions.append((u + du * at[:, :1]) * across + (v + dv * at[:, 1:]) * along + start * direction)
            areas.append(du * dv)
        return np.concatenate(positions), np.array(areas)


def scatter(direction: Array, anisotropy: float, rng: np.random.Generator) -> Array:
    """Scattered directions by Henyey and Greenstein's phase function, for unit directions (n, 3)."""
    count = len(direction)
    cosine = 2.0 * rng.random(count) - 1.0
    if anisotropy:
        g = anisotropy
        ratio = (1.0 - g * g) / (1.0 + g * cosine)
        cosine = (1.0 + g * g - ratio * ratio) / (2.0 * g)
    sine, angle = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 2.0 * np.pi * rng.random(count)
    if not anisotropy:
        return np.stack([sine * np.cos(angle), sine * np.sin(angle), cosine], axis=1)
    # Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017
    x, y, z = direction.T
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    first = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], axis=1)
    second = np.stack([b, sign + y * y * a, -y], axis=1)
    around: Array = (
        (sine * np.cos(angle))[:, None] * first + (sine * np.sin(angle))[:, None] * second + cosine[:, None] * direction
    )
    return around
