"""The light of one lamp in a body before it scatters: its fluence in voxels.

Light enters through the surface, is refracted and reflected inside; rays carry it. The voxels are along the axes of the
body's object space and begin at its faces, so that those of a box are inside or outside as a whole. Each estimate is
the mean of the fluence over the inside part of its voxel, except where this part is very small.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from sssgen.lab.reference.dielectric import Dielectric
from sssgen.lab.reference.surface_rays import SurfaceRays
from sssgen.support.diagnostics import failure

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

PLACES = 4
"""The points of each segment of a ray whose voxels get its light."""
LINES = 4
"""The lines through a voxel along each of two axes, on which its inside part is measured."""
LEAST_PART = 1.0 / LINES**2
"""The inside part of a voxel below which it counts as this: what one line crosses. The measure of smaller parts is too
rough for a quotient, and rounding leaves parts of 1e-16."""
FEWEST_VOXELS, MOST_VOXELS = 48, 128
"""Along the longest side."""
DEPTH = 0.12
"""The optical depth of a voxel, up to MOST_VOXELS."""
FAINT = 1e-4
"""The weight below which most rays end."""
SURVIVAL = 0.25


@dataclass(frozen=True)
class Lamp:
    """A light of irradiance 1: from afar on a plane that faces it, or of a point on a plane at distance 1."""

    direction: tuple[float, float, float] | None
    """Unit, world space, towards a light from afar"""
    position: tuple[float, float, float] | None = None
    """World space, of a point light"""


@dataclass(frozen=True, eq=False)
class FirstLight:
    """The fluence of a lamp's unscattered light, and the directions in which it travels."""

    fluence: Array
    """(channels, voxels)"""
    direction: Array | None
    """(channels, voxels, 3): one direction of a voxel's light, chosen by weight; None if it is not needed"""


class Voxels:
    """The voxels of a body and how much of each is inside."""

    def __init__(self, surface: SurfaceRays, shape: tuple[int, int, int]) -> None:
        self.surface = surface
        matrix = surface.to_object
        self.matrix, self.shift = matrix[:3, :3], matrix[:3, 3]
        corners = surface.vertices @ self.matrix.T + self.shift
        self.low, self.high = corners.min(axis=0), corners.max(axis=0)
        self.shape = np.array(shape)

    @property
    def count(self) -> int:
        return int(np.prod(self.shape))

    def index(self, points: Array) -> Indices:
        """The voxel of each point (n, 3) in world space; points outside belong to the nearest."""
        local = points @ self.matrix.T + self.shift
        cell = ((local - self.low) * (self.shape / (self.high - self.low))).astype(np.int64)
        x, y, z = np.clip(cell, 0, self.shape - 1).T
        index: Indices = (z * self.shape[1] + y) * self.shape[0] + x
        return index

    @cached_property
    def volume(self) -> Array:
        """The volume of the inside part of each voxel, in world space."""
        size = (self.high - self.low) / self.shape
        y, z = (self.low[axis] + size[axis] / LINES * (np.arange(self.shape[axis] * LINES) + 0.5) for axis in (1, 2))
        lines = np.stack(np.meshgrid(y, z, indexing="xy"), axis=-1).reshape(-1, 2)
        margin = 0.1 * float((self.high - self.low).max())
        start = np.concatenate([np.full((len(lines), 1), self.low[0] - margin), lines], axis=1)
        to_world = np.linalg.inv(self.matrix)
        origins = (start - self.shift) @ to_world.T
        along = to_world[:, 0] / np.linalg.norm(to_world[:, 0])
        hits, cosine = self.surface.all(origins, np.broadcast_to(along, origins.shape).copy())
        # a ray covers the voxels behind each entrance, and no longer those behind each exit
        at = (hits.t / self.surface.scale - margin) / size[0]
        cell = np.clip(at.astype(np.int64), 0, self.shape[0] - 1)
        part = np.clip(cell + 1 - at, 0.0, 1.0)
        sign = -np.sign(cosine)
        row, column = np.divmod(hits.rays, self.shape[1] * LINES)
        first = ((row // LINES) * self.shape[1] + column // LINES) * (self.shape[0] + 1) + cell
        padded = self.count // self.shape[0] * (self.shape[0] + 1)
        steps = np.bincount(first, sign * part, padded) + np.bincount(first + 1, sign * (1.0 - part), padded)
        covered = np.cumsum(steps.reshape(-1, self.shape[0] + 1), axis=1)[:, :-1] / LINES**2
        volume: Array = np.clip(covered, 0.0, 1.0).ravel() * float(np.prod(size)) * self.surface.scale**3
        return volume


def voxels_of(surface: SurfaceRays, extinction: float) -> Voxels:
    """Nearly cubic voxels for a medium of this extinction, the largest of its channels."""
    corners = surface.vertices @ surface.to_object[:3, :3].T
    size = np.ptp(corners, axis=0)
    longest = float(size.max())
    count = np.clip(np.ceil(longest * surface.scale * extinction / DEPTH - 1e-6), FEWEST_VOXELS, MOST_VOXELS)
    x, y, z = (max(int(side), 1) for side in np.ceil(size / longest * count - 1e-6))
    return Voxels(surface, (x, y, z))


def first_light(
    voxels: Voxels,
    boundary: Dielectric,
    extinction: Array,
    lamp: Lamp,
    rays: int,
    rng: np.random.Generator,
    directions: bool = False,
) -> FirstLight:
    """The unscattered light of a lamp, by `rays` rays; `extinction` is that of each channel.

    Raises SssgenError for a point light inside the body.
    """
    surface = voxels.surface
    position, direction, power = _lamp_rays(surface, lamp, rays, rng)
    weight = np.full((rays, len(extinction)), power / rays)
    least = float(extinction.min())
    sums = np.zeros((len(extinction), voxels.count))
    chosen = [_Chosen(voxels.count) for _ in extinction] if directions else []
    crossings = 0
    while len(weight):
        crossing = surface.next(position, direction)
        if not crossings and lamp.position is not None:
            _check_outside(crossing.found, direction, crossing.normal)
        found = crossing.found
        position, direction, weight = position[found], direction[found], weight[found]
        ahead, normal = crossing.ahead[found], crossing.normal[found]
        inside = np.flatnonzero(np.einsum("nc,nc->n", direction, normal) > 0.0)
        segments = position[inside], direction[inside], ahead[inside], weight[inside]
        for cell, share, ways in _spread(voxels, *segments, extinction, least, rng):
            for channel in range(len(extinction)):
                sums[channel] += np.bincount(cell, share[:, channel], voxels.count)
            for picked, values in zip(chosen, share.T, strict=False):
                picked.add(cell, values, ways, rng)
        weight[inside] *= np.exp(-extinction * ahead[inside, None])
        turn = boundary.reflect_or_refract(direction, normal, rng)
        position = position + ahead[:, None] * direction + surface.step * turn.direction
        direction, weight = turn.direction, weight * turn.weight[:, None]
        # what is trapped by total reflection in a clear medium must end, too
        faint = (weight.max(axis=1) < FAINT * power / rays) | (crossings > 32)
        dies = faint & (rng.random(len(weight)) > SURVIVAL)
        weight[faint] /= SURVIVAL
        position, direction, weight = position[~dies], direction[~dies], weight[~dies]
        crossings += 1
    whole = float(np.prod((voxels.high - voxels.low) / voxels.shape)) * surface.scale**3
    fluence = sums / np.maximum(voxels.volume, LEAST_PART * whole)
    return FirstLight(fluence, np.stack([picked.direction for picked in chosen]) if directions else None)


def _spread(
    voxels: Voxels,
    start: Array,
    way: Array,
    ahead: Array,
    light: Array,
    extinction: Array,
    least: float,
    rng: np.random.Generator,
) -> list[tuple[Indices, Array, Array]]:
    """The light of rays' segments inside the body, as (voxels, weights per channel, directions): one per place."""
    if not len(start):
        return []
    # the places are distributed as the light of the channel that reaches farthest
    share = -np.expm1(-least * ahead)
    results = []
    for place in range(PLACES):
        u = (place + rng.random(len(start))) / PLACES
        if least * float(ahead.max()) > 1e-6:
            s = -np.log1p(-u * share) / least
            density = least * np.exp(-least * s) / np.maximum(share, 1e-300)
        else:
            s = u * ahead
            density = 1.0 / np.maximum(ahead, 1e-300)
        amount = light * np.exp(-extinction * s[:, None]) / (PLACES * density[:, None])
        results.append((voxels.index(start + s[:, None] * way), amount, way))
    return results


class _Chosen:
    """One direction for each voxel, chosen among all that were added by their weights: the first of a race."""

    def __init__(self, count: int) -> None:
        self.time = np.full(count, np.inf)
        self.direction = np.zeros((count, 3))

    def add(self, cell: Indices, weight: Array, direction: Array, rng: np.random.Generator) -> None:
        time = rng.standard_exponential(len(cell)) / np.maximum(weight, 1e-300)
        order = np.lexsort((time, cell))
        cells, first = np.unique(cell[order], return_index=True)
        index = order[first]
        earlier = time[index] < self.time[cells]
        self.time[cells[earlier]] = time[index[earlier]]
        self.direction[cells[earlier]] = direction[index[earlier]]


def _lamp_rays(surface: SurfaceRays, lamp: Lamp, rays: int, rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Origins and directions of a lamp's rays at the body, and the power of all."""
    # the points of a lattice (Kronecker's, with the plastic number) are more even than random ones
    at = (np.arange(rays)[:, None] * (0.7548776662466927, 0.5698402909980532) + rng.random(2)) % 1.0
    vertices = surface.vertices
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    if lamp.direction is not None:
        towards = np.array(lamp.direction)
        across, along = _frame(towards)
        (u, du), (v, dv) = ((float(span.min()), float(np.ptp(span))) for span in (vertices @ across, vertices @ along))
        start = float((vertices @ towards).max()) + 0.01 * surface.size
        origins = (u + du * at[:, :1]) * across + (v + dv * at[:, 1:]) * along + start * towards
        return origins, np.broadcast_to(-towards, origins.shape).copy(), du * dv
    assert lamp.position is not None
    position = np.array(lamp.position)
    distance = float(np.linalg.norm(centre - position))
    radius = 1.001 * float(np.linalg.norm(vertices - centre, axis=1).max())
    least = np.sqrt(1.0 - (radius / distance) ** 2) if distance > radius else -1.0
    cosine = 1.0 - (1.0 - least) * at[:, 0]
    sine, angle = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 2.0 * np.pi * at[:, 1]
    axis = (centre - position) / distance if distance > 0.0 else np.array([0.0, 0.0, 1.0])
    across, along = _frame(axis)
    ways = (sine * np.cos(angle))[:, None] * across + (sine * np.sin(angle))[:, None] * along + cosine[:, None] * axis
    return np.broadcast_to(position, ways.shape).copy(), ways, float(2.0 * np.pi * (1.0 - least))


def _frame(axis: Array) -> tuple[Array, Array]:
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    return across, np.cross(axis, across)


def _check_outside(found: npt.NDArray[np.bool_], direction: Array, normal: Array) -> None:
    """Raises SssgenError if rays of a point light meet the surface from inside."""
    leaving = np.einsum("nc,nc->n", direction[found], normal[found]) > 0.0
    if len(leaving) and leaving.mean() > 0.5:
        raise failure("a point light is inside the body", "move it out: lights inside bodies are not measured")
