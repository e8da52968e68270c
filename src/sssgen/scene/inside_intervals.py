"""The intervals of lines inside a body.

Solids have closed forms, meshes use exact ray casting, and distance functions bisection. A concave body, or one with
gaps, has several intervals.
"""

from __future__ import annotations

from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array, Indices
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union

SURFACE = 1e-5
"""The distance, in sizes of a mesh, of the surface that a ray starts from: crossings up to it do not count."""


def in_object_space(geometry: Geometry, origins: Array, directions: Array) -> tuple[Array, Array]:
    """Rays of world space in object space, with unit directions."""
    to_object = geometry.to_object()
    return origins @ to_object[:3, :3].T + to_object[:3, 3], directions @ to_object[:3, :3].T * geometry.scale


@singledispatch
def intervals(geometry: Geometry, origins: Array, directions: Array, needed: int | None = None) -> Array:
    """The intervals of lines inside the body, in object space: (n, k, 2), start and end, disjoint and in order.

    They include the part behind the origin, except for meshes and distance functions. A line with fewer than k
    intervals has empty ones. With `needed`, only that many crossings of the surface in front of an origin outside the
    body must be right, and one more in front of an origin inside: the march along a distance function ends there.
    """
    raise NotImplementedError(type(geometry).__name__)  # every shape of a scene is registered below


def _single(enters: Array, leaves: Array) -> Array:
    """Lines with one interval each; empty where the end is before the start."""
    hit = enters < leaves
    return np.stack([np.where(hit, enters, 0.0), np.where(hit, leaves, 0.0)], axis=1)[:, None]


@intervals.register
def _(geometry: Ball, origins: Array, directions: Array, needed: int | None = None) -> Array:
    middle = -np.einsum("nc,nc->n", origins, directions)
    closest = origins + middle[:, None] * directions
    half = np.sqrt(np.maximum(geometry.radius**2 - np.einsum("nc,nc->n", closest, closest), 0.0))
    return _single(middle - half, middle + half)


def _box(size: Array, origins: Array, directions: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = (np.array([[-0.5], [0.5]])[:, None] * size - origins) / directions
    between = np.where(np.abs(origins) <= 0.5 * size, np.inf, -np.inf)
    along = directions == 0.0  # a ray parallel to a pair of faces is always or never between them
    enters = np.where(along, -between, ends.min(axis=0)).max(axis=1)
    leaves = np.where(along, between, ends.max(axis=0)).min(axis=1)
    return _single(enters, leaves)


@intervals.register
def _(geometry: Box, origins: Array, directions: Array, needed: int | None = None) -> Array:
    return _box(np.array(geometry.size), origins, directions)


@intervals.register
def _(geometry: Slab, origins: Array, directions: Array, needed: int | None = None) -> Array:
    return _box(np.array([geometry.width, geometry.height, geometry.thickness]), origins, directions)


@intervals.register
def _(geometry: Capsule, origins: Array, directions: Array, needed: int | None = None) -> Array:
    return _single(*geometry.interval(origins, directions))


@intervals.register
def _(geometry: Torus, origins: Array, directions: Array, needed: int | None = None) -> Array:
    return geometry.intervals(origins, directions)


@intervals.register
def _(geometry: Union, origins: Array, directions: Array, needed: int | None = None) -> Array:
    parts = [
        part.scale * intervals(part, *in_object_space(part, origins, directions), needed) for part in geometry.parts
    ]
    return merge(np.concatenate(parts, axis=1))


def merge(parts: Array) -> Array:
    """Intervals (n, k, 2) that overlap or touch as one; the others are empty. They do not touch, and are in order."""
    order = np.argsort(parts[..., 0], axis=1, kind="stable")
    parts = np.take_along_axis(parts, order[..., None], axis=1)
    result = np.zeros_like(parts)
    rows = np.arange(len(parts))
    current, reached = np.zeros(len(parts), int), np.full(len(parts), -np.inf)
    for k in range(parts.shape[1]):
        low, high = parts[:, k, 0], parts[:, k, 1]
        more = (low < high) & (high > reached)
        begins = more & (low > reached)
        current = np.where(begins, k, current)
        result[rows, current, 0] = np.where(begins, low, result[rows, current, 0])
        result[rows, current, 1] = np.where(more, high, result[rows, current, 1])
        reached = np.where(more, high, reached)
    return result


class Crossings(NamedTuple):
    """The crossings of rays with the surface of a mesh, in the order of the rays and along each: (m,)."""

    rays: Indices
    t: Array
    """The distance along the ray"""
    side: Array
    """1 where the ray leaves a part of the body, -1 where it enters"""
    exits: Array
    """The number of exits of the ray up to here, this crossing included, minus that of entrances"""
    first: npt.NDArray[np.bool_]
    """Whether it is the ray's first crossing"""


def crossings(mesh: Mesh, origins: Array, directions: Array) -> Crossings:
    """The crossings of rays with a mesh, in object space: a ray leaves along a face's normal, and enters against it."""
    triangles = mesh.triangles
    size = float(np.linalg.norm(triangles.places.max(axis=0) - triangles.places.min(axis=0)))
    rays, faces, t = mesh.rays.all(origins, directions, SURFACE * size)
    slope = np.einsum("nc,nc->n", triangles.flat[faces], directions[rays])
    side = np.sign(-slope if mesh.inside_out else slope)
    keep = (t > SURFACE * size) & (side != 0.0)
    order = np.lexsort((t[keep], rays[keep]))
    t, rays, side = t[keep][order], rays[keep][order], side[keep][order]
    # a ray through an edge crosses both of its triangles, but the surface only once
    repeated = (
        (np.diff(rays, prepend=-1) == 0) & (np.diff(t, prepend=0.0) < 1e-7 * size) & (np.diff(side, prepend=0.0) == 0.0)
    )
    t, rays, side = t[~repeated], rays[~repeated], side[~repeated]
    first = np.diff(rays, prepend=-1) != 0
    exits = np.cumsum(side)
    exits -= np.repeat((exits - side)[first], np.diff(np.flatnonzero(first), append=len(rays)))
    return Crossings(rays, t, side, exits, first)


def _inside_parts(mesh: Mesh, origins: Array, directions: Array) -> tuple[Indices, Array, Array, Indices]:
    """The parts of rays inside a mesh between two crossings: their rays, starts, ends, and numbers along the ray."""
    rays, t, side, exits, first = crossings(mesh, origins, directions)
    # parts may be nested; a ray starts inside a part if it leaves more often than it enters
    depth = np.zeros(len(origins))
    np.maximum.at(depth, rays, exits)
    inside = depth[rays] - exits + side > 0.0
    starts: Array = np.where(first, 0.0, np.roll(t, 1))
    number = np.arange(len(rays)) - np.maximum.accumulate(np.where(first, np.arange(len(rays)), 0))
    return rays[inside], starts[inside], t[inside], number[inside]


@intervals.register
def _(geometry: Mesh, origins: Array, directions: Array, needed: int | None = None) -> Array:
    rays, starts, ends, number = _inside_parts(geometry, origins, directions)
    result = np.zeros((len(origins), int(number.max(initial=0)) + 1, 2))
    result[rays, number] = np.stack([starts, ends], axis=1)
    return merge(result)


def alternate(mesh: Mesh, origins: Array, directions: Array) -> npt.NDArray[np.bool_]:
    """Whether rays inward from the surface leave the mesh and enter it by turns, and end outside, (n,).

    Otherwise the mesh has a hole there, or its parts overlap.
    """
    rays, _, _, exits, _ = crossings(mesh, origins, directions)
    passed = np.bincount(rays, (exits < 0.0) | (exits > 1.0), len(origins)) == 0.0
    ends = np.zeros(len(origins))
    ends[rays] = exits  # the last crossing of each ray remains
    result: npt.NDArray[np.bool_] = passed & (ends == 1.0)
    return result


def lengths_ahead(geometry: Geometry, origins: Array, directions: Array) -> Array:
    """The length of rays inside the body, in object space: (n,)."""
    if isinstance(geometry, Mesh):  # its parts need not be merged for a sum
        rays, starts, ends, _ = _inside_parts(geometry, origins, directions)
        return np.bincount(rays, ends - starts, len(origins)).astype(np.float64)
    parts = np.maximum(intervals(geometry, origins, directions), 0.0)
    lengths: Array = (parts[..., 1] - parts[..., 0]).sum(axis=1)
    return lengths


@intervals.register
def _(geometry: Distance, origins: Array, directions: Array, needed: int | None = None) -> Array:
    """The sign changes of the function, bracketed by sphere tracing as in `Distance`."""
    shortest = 1e-4 * geometry.reach
    nearest = -np.einsum("nc,nc->n", origins, directions)
    closest = origins + nearest[:, None] * directions
    half = np.sqrt(np.maximum(geometry.reach**2 - np.einsum("nc,nc->n", closest, closest), 0.0))
    end = np.maximum(nearest + half, 0.0)
    t = np.full(len(origins), 2.0 * shortest)  # past the surface that the ray starts from
    value = geometry.distance(origins + t[:, None] * directions).copy()
    starts_inside = np.flatnonzero(value < 0.0)
    left = (np.inf if needed is None else needed) + (value < 0.0)
    brackets: list[tuple[Any, Array, Array]] = []
    active = t < end
    while active.any():
        rays = np.flatnonzero(active)
        step = np.maximum(np.abs(value[rays]), shortest)
        after = np.minimum(t[rays] + step, end[rays])
        new = geometry.distance(origins[rays] + after[:, None] * directions[rays])
        crossed = (new < 0.0) != (value[rays] < 0.0)
        brackets.append((rays[crossed], t[rays[crossed]], after[crossed]))
        t[rays], value[rays] = after, new
        left[rays[crossed]] -= 1
        active[rays] = (after < end[rays]) & (left[rays] > 0)
    rays, low, high = (np.concatenate(parts) for parts in zip(*brackets, strict=True)) if brackets else (t[:0],) * 3
    rays = rays.astype(np.int64)
    at = geometry.bisect(origins[rays], directions[rays], low, high)
    ends_inside = np.flatnonzero(value < 0.0)
    # entries and exits alternate; a start or an end inside the body counts as one of them
    rays = np.concatenate([starts_inside, rays, ends_inside])
    at = np.concatenate([np.zeros(len(starts_inside)), at, end[ends_inside]])
    order = np.lexsort((at, rays))
    return _gather(rays[order][::2], at[order].reshape(-1, 2), len(origins))


def _gather(rays: Any, ends: Array, count: int) -> Array:
    """The intervals (m, 2) of rays, in order, as an array (count, k, 2)."""
    rank = np.arange(len(rays)) - np.searchsorted(rays, rays)
    result = np.zeros((count, int(rank.max(initial=0)) + 1, 2))
    result[rays, rank] = ends
    return result
