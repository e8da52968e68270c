"""Solids with closed-form ray intersections: ball, box, slab, torus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from sssgen.scene.arrays import Array, Bools, Vector
from sssgen.scene.geometry_base import Geometry, Hits, any_tangent, spherical, spread, tangent_of, unit


@dataclass(frozen=True)
class Ball(Geometry):
    """A ball about the origin.

    u goes once around the y axis, to the viewer's right, with its seam at the back (−z); v goes up from the south pole
    (−y). u = 0.5 faces +z.
    """

    radius: float = 1.0

    def cast(self, origin: Array, directions: Array) -> Hits:
        nearest = -directions @ origin
        # the point of the ray nearest to the centre, so that the root is precise for a distant origin
        closest = origin + nearest[:, None] * directions
        half = self.radius**2 - np.einsum("nc,nc->n", closest, closest)
        half = np.sqrt(half, out=np.full_like(half, np.nan), where=half >= 0.0)
        t = np.where(nearest - half > 0.0, nearest - half, nearest + half)
        hit = t > 0.0
        normal = unit(origin + t[hit, None] * directions[hit])
        uv, grows_u, grows_v = spherical(normal)
        return spread(hit, self.radius * normal, normal, tangent_of(normal, grows_u, grows_v), uv)

    def distance(self, points: Array) -> Array:
        distance: Array = np.linalg.norm(points, axis=1) - self.radius
        return distance


# The directions in which u and v grow, of the faces +x, −x, +y, −y, +z, −z
_RIGHT = np.array([[0, 0, -1], [0, 0, 1], [1, 0, 0], [1, 0, 0], [1, 0, 0], [-1, 0, 0]], np.float64)
_UP = np.array([[0, 1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0], [0, 1, 0]], np.float64)


@dataclass(frozen=True)
class Box(Geometry):
    """A box about the origin, along the axes.

    Each face has uv 0 to 1, seen from outside u to the right and v up; on the top v goes to the back (−z), on the
    bottom to the front.
    """

    size: Vector = (1.0, 1.0, 1.0)

    def cast(self, origin: Array, directions: Array) -> Hits:
        return _cast_box(np.array(self.size, np.float64), origin, directions)

    def distance(self, points: Array) -> Array:
        return _box_distance(np.array(self.size, np.float64), points)


@dataclass(frozen=True)
class Slab(Geometry):
    """A flat box about the origin that faces +z, `thickness` thick along z; uv as on a box."""

    width: float = 2.0
    height: float = 2.0
    thickness: float = 0.1

    def cast(self, origin: Array, directions: Array) -> Hits:
        return _cast_box(np.array([self.width, self.height, self.thickness]), origin, directions)

    def distance(self, points: Array) -> Array:
        return _box_distance(np.array([self.width, self.height, self.thickness]), points)


def _cast_box(size: Array, origin: Array, directions: Array) -> Hits:
    half = 0.5 * size
    sign = np.where(directions < 0.0, -1.0, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        enters, leaves = (-sign * half - origin) / directions, (sign * half - origin) / directions
    # a ray parallel to a pair of faces is always or never between them
    between = np.where(np.abs(origin) <= half, np.inf, -np.inf)
    enters = np.where(directions == 0.0, -between, enters)
    leaves = np.where(directions == 0.0, between, leaves)
    first, last = enters.max(axis=1), leaves.min(axis=1)
    hit = (first <= last) & (last > 0.0)
    outside = first > 0.0
    t = np.where(outside, first, last)[hit]
    axis = np.where(outside, enters.argmax(axis=1), leaves.argmin(axis=1))[hit]
    rows = np.arange(len(axis))
    side = np.where(outside[hit], -1.0, 1.0) * sign[hit][rows, axis]
    position = origin + t[:, None] * directions[hit]
    position[rows, axis] = side * half[axis]
    position = np.clip(position, -half, half)
    normal = np.zeros_like(position)
    normal[rows, axis] = side
    face = 2 * axis + (side < 0.0)
    uv = np.stack([0.5 + (position / size * axes[face]).sum(axis=1) for axes in (_RIGHT, _UP)], axis=1)
    return spread(hit, position, normal, np.c_[_RIGHT[face], np.ones(len(face))], uv)


def _box_distance(size: Array, points: Array) -> Array:
    """Quilez, Distance functions: exact on both sides."""
    beyond = np.abs(points) - 0.5 * size
    distance: Array = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
    return distance


@dataclass(frozen=True)
class Torus(Geometry):
    """A ring about the y axis, `major` from the axis to the tube's middle, `minor` < `major` the tube's radius.

    u goes once around the axis, as on a ball; v once around the tube, upwards on its outside: 0.5 at the outer
    equator, 0.75 on top, the seam at the inner equator.
    """

    major: float = 1.0
    minor: float = 0.4

    def cast(self, origin: Array, directions: Array) -> Hits:
        nearest, closest, reach, near = self._near(np.broadcast_to(origin, directions.shape), directions)
        t, has_root = self._first_root(closest[near], directions[near], reach, -nearest[near])
        hit = np.zeros(len(directions), np.bool_)
        hit[near[has_root]] = True
        position = closest[hit] + t[has_root, None] * directions[hit]
        # project onto the surface: for a grazing ray the error of the root is along the ray
        ring = position * [1.0, 0.0, 1.0]
        centre = self.major * unit(ring)
        normal = unit(position - centre)
        x, _, z = ring.T
        angle = np.arctan2(position[:, 1], np.hypot(x, z) - self.major)
        uv = 0.5 + np.stack([np.arctan2(x, z), angle], axis=1) / (2.0 * np.pi)
        along = unit(np.stack([z, np.zeros_like(x), -x], axis=1))
        undefined = np.linalg.norm(along, axis=1) < 0.5
        tangent = np.where(undefined[:, None], any_tangent(normal), along)
        return spread(hit, centre + self.minor * normal, normal, np.c_[tangent, np.ones(len(x))], uv)

    def distance(self, points: Array) -> Array:
        x, y, z = points.T
        distance: Array = np.hypot(np.hypot(x, z) - self.major, y) - self.minor
        return distance

    def intervals(self, origins: Array, directions: Array) -> Array:
        """The two intervals of each line inside the torus, (n, 2, 2), in order; an empty one has equal ends."""
        nearest, closest, reach, near = self._near(origins, directions)
        quartic, ends, change = self._pieces(closest[near], directions[near], -reach, reach)
        # a line can enter, leave, enter and leave, in this order; with one interval, it does the first and the last
        rows, piece = np.nonzero(change)
        roots = np.zeros(change.shape)
        roots[rows, piece] = _bracketed_root(quartic[:, rows], ends[rows, piece], ends[rows, piece + 1])
        enters, exits, enters_again, exits_at_last = roots.T
        crosses, again = change[:, 0], change[:, 2]
        first = np.stack([enters, np.where(change[:, 1], exits, exits_at_last)], axis=1)
        second = np.stack([enters_again, exits_at_last], axis=1)
        result = np.zeros((len(directions), 2, 2))
        result[near, 0] = np.where(crosses[:, None], first + nearest[near, None], 0.0)
        result[near, 1] = np.where(again[:, None], second + nearest[near, None], 0.0)
        return result

    def _near(self, origins: Array, directions: Array) -> tuple[Array, Array, Array, Any]:
        """Each line's parameter and point nearest to the centre, and of the lines near the torus their numbers.

        For these also half the length within a ball that is wider than the torus: both ends are outside the torus.
        """
        nearest = -np.einsum("nc,nc->n", origins, directions)
        closest = origins + nearest[:, None] * directions
        reach = (1.001 * (self.major + self.minor)) ** 2 - np.einsum("nc,nc->n", closest, closest)
        near = np.flatnonzero(reach > 0.0)
        return nearest, closest, np.sqrt(reach[near]), near

    def _pieces(self, closest: Array, directions: Array, low: Array, high: Array) -> tuple[Array, Array, Bools]:
        """Coefficients of the quartic t⁴ + a t² + b t + c, which is negative inside, (3, n); its monotonic pieces.

        t counts from the point nearest to the centre, so the quartic has no cubic term and its turning points have a
        closed form. Between two of the five ends of the pieces, (n, 5), there is at most one root: the last result,
        (n, 4), says where there is one.
        """
        y, slope = closest[:, 1], directions[:, 1]
        square = np.einsum("nc,nc->n", closest, closest)
        k = square + self.major**2 - self.minor**2
        a = 2.0 * k - 4.0 * self.major**2 * (1.0 - slope**2)
        b = 8.0 * self.major**2 * y * slope
        c = k * k - 4.0 * self.major**2 * (square - y * y)
        ends = np.stack([low, *_turning_points(a, b).T, high], axis=1)
        ends = np.clip(ends, low[:, None], np.maximum(high, low)[:, None])
        values = ((ends * ends + a[:, None]) * ends + b[:, None]) * ends + c[:, None]
        return np.stack([a, b, c]), ends, (values[:, :-1] > 0.0) != (values[:, 1:] > 0.0)

    def _first_root(self, closest: Array, directions: Array, reach: Array, start: Array) -> tuple[Array, Bools]:
        """The first t after `start`, within ± `reach`, at which rays hit the torus, and which rays do."""
        low = np.maximum(-reach, start)
        quartic, ends, change = self._pieces(closest, directions, low, reach)
        has_root = change.any(axis=1) & (low < reach)
        rows = np.flatnonzero(has_root)
        piece = change[rows].argmax(axis=1)
        t = np.zeros(len(low))
        t[rows] = _bracketed_root(quartic[:, rows], ends[rows, piece], ends[rows, piece + 1])
        return t, has_root


def _turning_points(a: Array, b: Array) -> Array:
    """The roots of 4 t³ + 2 a t + b in order, (n, 3); where there is one, three times the same."""
    p, q = 0.5 * a, 0.25 * b  # t³ + p t + q
    roots = np.empty((len(a), 3))
    three = 4.0 * p**3 + 27.0 * q**2 < 0.0
    radius = 2.0 * np.sqrt(-p[three] / 3.0)
    cosine = np.clip(3.0 * q[three] / (p[three] * radius), -1.0, 1.0)
    turns = (np.arccos(cosine)[:, None] - 2.0 * np.pi * np.arange(3)) / 3.0
    roots[three] = np.sort(radius[:, None] * np.cos(turns), axis=1)
    p, q = p[~three], q[~three]
    # Cardano, with the cube root without cancellation
    inner = np.sqrt(np.maximum(0.25 * q * q + p**3 / 27.0, 0.0))
    large = np.cbrt(-0.5 * q - np.where(q < 0.0, -inner, inner))
    roots[~three] = (large - p / np.where(large == 0.0, 1.0, 3.0 * large))[:, None]
    return roots


def _bracketed_root(quartic: Array, low: Array, high: Array) -> Array:
    """The root of t⁴ + a t² + b t + c between two points of different sign: Newton's method, limited to the bracket."""
    a, b, c = quartic
    rises = ((high * high + a) * high + b) * high + c > 0.0
    t = 0.5 * (low + high)
    for _ in range(80):
        value = ((t * t + a) * t + b) * t + c
        above = (value > 0.0) == rises
        high, low = np.where(above, t, high), np.where(above, low, t)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = t - value / ((4.0 * t * t + 2.0 * a) * t + b)
        middle = 0.5 * (low + high)
        after = np.where((step > low) & (step < high), step, middle)
        if np.all(np.abs(after - t) <= 1e-15 * (1.0 + np.abs(t))):
            break
        t = after
    return t
