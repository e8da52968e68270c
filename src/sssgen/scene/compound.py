"""Compound solids: a capsule, and the union of several shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.geometry_base import Geometry, Hits, planar, spherical, spread, tangent_of, unit


@dataclass(frozen=True)
class Capsule(Geometry):
    """The points within `radius` of a segment of the y axis, `length` long, centred at the origin; uv as on a ball."""

    radius: float = 0.25
    length: float = 1.0

    def cast(self, origin: Array, directions: Array) -> Hits:
        enters, leaves = self.interval(np.broadcast_to(origin, directions.shape), directions)
        hit = (enters < leaves) & (leaves > 0.0)
        t = np.where(enters > 0.0, enters, leaves)[hit]
        position = origin + t[:, None] * directions[hit]
        nearest = np.zeros_like(position)
        nearest[:, 1] = np.clip(position[:, 1], -0.5 * self.length, 0.5 * self.length)
        normal = unit(position - nearest)
        uv, grows_u, grows_v = spherical(position)
        return spread(hit, nearest + self.radius * normal, normal, tangent_of(normal, grows_u, grows_v), uv)

    def distance(self, points: Array) -> Array:
        x, y, z = points.T
        beyond = np.maximum(np.abs(y) - 0.5 * self.length, 0.0)
        distance: Array = np.sqrt(x * x + beyond * beyond + z * z) - self.radius
        return distance

    def interval(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        """Where lines enter and leave, (n,) each, from origins (n, 3) along unit directions; inf and −inf for a miss.

        A capsule is convex and the union of two balls and a cylinder: the first entry and the last exit of these.
        """
        half = 0.5 * self.length
        enters, leaves = np.full(len(directions), np.inf), np.full(len(directions), -np.inf)
        for end in (-half, half):
            way = origins - [0.0, end, 0.0]
            middle = -np.einsum("nc,nc->n", way, directions)
            closest = way + middle[:, None] * directions
            square = self.radius**2 - np.einsum("nc,nc->n", closest, closest)
            root = np.sqrt(np.maximum(square, 0.0))
            enters = np.where(square > 0.0, np.minimum(enters, middle - root), enters)
            leaves = np.where(square > 0.0, np.maximum(leaves, middle + root), leaves)
        flat, across = origins[:, ::2], directions[:, ::2]
        size = np.einsum("nc,nc->n", across, across)
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = -np.einsum("nc,nc->n", flat, across) / size
            closest = flat + middle[:, None] * across
            root = np.sqrt((self.radius**2 - np.einsum("nc,nc->n", closest, closest)) / size)
            for t, first in ((middle - root, True), (middle + root, False)):
                on = np.abs(origins[:, 1] + t * directions[:, 1]) <= half  # false for NaN: a ray along the axis
                enters = np.where(on & first, np.minimum(enters, t), enters)
                leaves = np.where(on & (not first), np.maximum(leaves, t), leaves)
        return enters, leaves


@dataclass(frozen=True)
class Union(Geometry):
    """Several shapes as one body, each with its own transform in the union's object space; they may overlap.

    Rays must start outside all parts. The distance is the smallest of the parts': exact outside, and a lower bound of
    the depth inside.
    """

    parts: tuple[Geometry, ...] = ()
    projection: str = "parts"
    """uv: each part's own (`parts`), or x and y of the whole (`planar`)"""

    def cast(self, origin: Array, directions: Array) -> Hits:
        hits_of_parts = [part.hits(origin, directions) for part in self.parts]
        distances = [
            np.where(hits.hit, np.einsum("nc,nc->n", hits.position - origin, directions), np.inf)
            for hits in hits_of_parts
        ]
        nearest = np.argmin(distances, axis=0)
        rows = np.arange(len(directions))
        chosen = Hits(*(np.stack(parts)[nearest, rows] for parts in zip(*hits_of_parts, strict=True)))
        if self.projection == "parts":
            return chosen
        uv, grows_u, grows_v = planar(chosen.position)
        tangent = tangent_of(chosen.normal, grows_u, grows_v)
        hit = chosen.hit
        return spread(
            hit, chosen.position[hit], chosen.normal[hit], tangent[hit], uv[hit], chosen.front[hit], chosen.uv2[hit],
            chosen.color[hit],
        )  # fmt: skip

    def distance(self, points: Array) -> Array:
        each = [_distance(part, points) for part in self.parts]
        nearest: Array = np.minimum.reduce(each)
        return nearest


def _distance(part: Geometry, points: Array) -> Array:
    """The distance to a transformed part, from points in the union's object space."""
    to_object = part.to_object()
    return part.scale * part.distance(points @ to_object[:3, :3].T + to_object[:3, 3])
