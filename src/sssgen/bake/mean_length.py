"""The mean length inside a closed mesh over inward directions, as an integral over its triangles: no rays, no noise.

The length along a direction is the sum of the distances of all exits, minus that of all entrances. A piece dA of the
surface is seen as the solid angle |n·ω| dA / r², so the mean, weighted by the cosine to the inward normal w, is

    1/π ∫ (n·ω) max(w·ω, 0) / r dA,

over all of the surface: no piece hides another. A near triangle is integrated in closed form (the field of a uniform
polygon: Wilton et al., Potential Integrals for Uniform and Linear Source Distributions, 1984, and, for the solid angle,
van Oosterom and Strackee 1983). Far triangles are summed in a tree (Barnes and Hut 1986).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array, Indices

OPENING = 0.15
"""The radius of a part of the mesh, relative to its distance, up to which it is one point of the quadrature."""
CLOSE = 2.0
"""The distance of a triangle, relative to its radius, within which it is integrated in closed form."""
COPLANAR = 1e-9
"""The distance from a triangle's plane, in sizes of the mesh, within which it adds nothing."""

Floats = npt.NDArray[Any]


class Level(NamedTuple):
    """The nodes of one depth of a tree: (k,) or (k, 3)."""

    center: Array
    """The centroid by area"""
    radius: Array
    """Of a ball about the centre that contains the node's triangles"""
    across: Array
    """The sum of the triangles' area vectors"""
    offset: Array
    """The sum of the area vectors' products with points of their triangles"""


class MeanLength:
    """The integral for the triangles `places` (v, 3) and `corners` (f, 3), counter-clockwise seen from outside.

    The mesh is closed, and no part of it lies in another: the length of what overlaps would count twice.
    """

    def __init__(self, places: Array, corners: Indices) -> None:
        self.size = float(np.ptp(places, axis=0).max())
        triangles = places[corners]
        order = in_halves(triangles.mean(axis=1), 1)[:, 0]
        self.triangles = triangles[np.minimum(order, len(triangles) - 1)]
        self.triangles[order >= len(triangles)] = triangles[-1, 0]  # what fills the tree has no area
        self.levels = _levels(self.triangles)

    def at(self, points: Array, normals: Array, opening: float = OPENING) -> tuple[Array, Array]:
        """The mean below surface points with outward unit normals, (n, 3) each, and its estimated error: (n,) each.

        Points that are near each other share the work. The error of a quadrature falls with the square of the opening,
        so the mean is extrapolated from two of them (Richardson); the error is that of the better one.
        """
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        reach = float(np.linalg.norm(points - middle, axis=1).max())
        (coarse, _), (fine, leaves) = (
            self._quadrature(middle, reach, points, normals, width) for width in (2.0 * opening, opening)
        )
        point, leaf = np.nonzero(self._next_to(leaves, middle, points))
        triangles = self.triangles[leaves[leaf]] - points[point, None]
        closed = np.bincount(point, _closed(triangles, -normals[point], COPLANAR * self.size), len(points))
        error = (fine - coarse) / (3.0 * np.pi)
        return (fine + closed) / np.pi + error, np.abs(error)

    def _quadrature(
        self, middle: Array, reach: float, points: Array, normals: Array, opening: float
    ) -> tuple[Array, Indices]:
        """The sums over the mesh without the triangles next to each point, (n,), and the leaves with these triangles.

        The points are in a ball of the radius `reach` about `middle`.
        """
        total = np.zeros(len(points))
        nodes = np.zeros(1, np.int64)
        for level in self.levels:
            ahead = np.linalg.norm(level.center[nodes] - middle, axis=1) - reach
            far = level.radius[nodes] < opening * ahead
            some = nodes[far]
            terms = _terms(level.center[some], level.across[some], level.offset[some], middle, points, normals)
            total += terms.sum(axis=1)
            leaves = nodes[~far]
            nodes = np.stack([2 * leaves, 2 * leaves + 1], axis=1).ravel()
        # three points are exact for polynomials of degree 2 (Strang and Fix 1973)
        triangles = self.triangles[leaves]
        thirds = 0.5 * (triangles + triangles.mean(axis=1, keepdims=True))
        across, offset = (np.repeat(values[leaves] / 3.0, 3, axis=0) for values in (level.across, level.offset))
        terms = _terms(thirds.reshape(-1, 3), across, offset, middle, points, normals)
        closed = np.repeat(self._next_to(leaves, middle, points), 3, axis=1)
        return total + np.where(closed, np.float32(0.0), terms).sum(axis=1), leaves

    def _next_to(self, leaves: Indices, middle: Array, points: Array) -> npt.NDArray[np.bool_]:
        """Which triangles are so near to points that they are integrated in closed form: (n, k)."""
        level = self.levels[-1]
        squares = _squares(points - middle, level.center[leaves] - middle)
        near: npt.NDArray[np.bool_] = squares < (CLOSE * level.radius[leaves]) ** 2
        return near


def in_halves(points: Array, most: int) -> Indices:
    """Groups of near points (n, 3): indices (a power of two, k), k at most `most`, halved along their longest axes.

    Indices of n and more fill the last places; they stand for the last point.
    """
    depth = math.ceil(math.log2(max(len(points) / most, 1.0)))
    count = 2**depth * math.ceil(len(points) / 2**depth)
    filled = np.concatenate([points, np.repeat(points[-1:], count - len(points), axis=0)])
    order = np.arange(count)[None]
    for _ in range(depth):
        parts = filled[order]
        axis = np.ptp(parts, axis=1).argmax(axis=1)
        along = np.take_along_axis(parts, axis[:, None, None], axis=2)[..., 0]
        order = np.take_along_axis(order, np.argpartition(along, order.shape[1] // 2, axis=1), axis=1)
        order = order.reshape(2 * len(order), -1)
    return order


def _levels(triangles: Array) -> list[Level]:
    """The levels of the tree over ordered triangles (a power of two, 3, 3), the root first."""
    first, second, third = np.moveaxis(triangles, 1, 0)
    across = 0.5 * np.cross(second - first, third - first)
    area = np.linalg.norm(across, axis=1)
    center = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - center[:, None], axis=2).max(axis=1)
    levels = [Level(center, radius, across, np.einsum("kc,kc->k", across, center))]
    while len(area) > 1:
        below, weight = levels[-1], np.maximum(area, 1e-300).reshape(-1, 2, 1)
        parts = below.center.reshape(-1, 2, 3)
        center = (parts * weight).sum(axis=1) / weight.sum(axis=1)
        reach = np.linalg.norm(parts - center[:, None], axis=2) + below.radius.reshape(-1, 2)
        area = area.reshape(-1, 2).sum(axis=1)
        sums = below.across.reshape(-1, 2, 3).sum(axis=1), below.offset.reshape(-1, 2).sum(axis=1)
        levels.append(Level(center, reach.max(axis=1), *sums))
    return levels[::-1]


def _terms(centers: Array, across: Array, offset: Array, middle: Array, points: Array, normals: Array) -> Floats:
    """The integrand at parts of the mesh for points, (n, k), in float32 about the `middle` of the points."""
    starts, centers = points - middle, centers - middle
    terms = _products((-normals, np.einsum("nc,nc->n", normals, starts)), (centers, np.ones(len(centers))))
    np.maximum(terms, 0.0, out=terms)
    terms *= _products((-starts, np.ones(len(starts))), (across, offset - across @ middle))
    squares = _squares(starts, centers)
    with np.errstate(divide="ignore", invalid="ignore"):
        squares *= np.sqrt(squares)
        terms /= squares
    return terms


def _products(left: Sequence[Array], right: Sequence[Array]) -> Floats:
    """The products of rows (n, c) and (k, c), each given as its parts: (n, k), in float32."""
    rows, columns = (np.column_stack(parts).astype(np.float32) for parts in (left, right))
    products: Floats = rows @ columns.T
    return products


def _squares(points: Array, others: Array) -> Floats:
    """The squares of the distances between points (n, 3) and (k, 3): (n, k), in float32."""
    own, other = (np.einsum("nc,nc->n", places, places) for places in (points, others))
    return _products((-2.0 * points, own, np.ones(len(points))), (others, np.ones(len(others)), other))


def _closed(triangles: Array, inward: Array, tiny: float) -> Array:
    """The integrals about the origin over the parts of triangles (n, 3, 3) in front of it along `inward`, (n, 3)."""
    result = np.zeros(len(triangles))
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
    height = np.einsum("nc,nc->n", triangles[:, 0], normal)
    ahead = np.einsum("nvc,nc->nv", triangles, inward)
    some = np.flatnonzero((np.abs(height) > tiny) & (ahead > 0.0).any(axis=1))
    polygon, inward, normal = _clipped(triangles[some], ahead[some]), inward[some], normal[some]
    length = np.linalg.norm(polygon, axis=2)
    following, next_length = np.roll(polygon, -1, axis=1), np.roll(length, -1, axis=1)
    edges = following - polygon
    side = np.linalg.norm(edges, axis=2)
    both = length + next_length
    logs = np.log((both + side) / np.maximum(both - side, 1e-12 * both))
    # outwards in the plane is edge × normal
    out = np.einsum("nec,nc->ne", edges, np.cross(normal, inward)) / np.maximum(side, 1e-300)
    angle = sum(_solid_angle(polygon[:, [0, k, k + 1]], length[:, [0, k, k + 1]]) for k in (1, 2))
    field = np.einsum("nc,nc->n", inward, normal) * angle - (out * logs).sum(axis=1)
    result[some] = height[some] * field
    return result


def _clipped(triangles: Array, ahead: Array) -> Array:
    """The parts of triangles (n, 3, 3) where `ahead`, (n, 3) at their corners, is positive: polygons (n, 4, 3).

    Some corner is positive. Polygons with three corners have the last one twice.
    """
    front = ahead > 0.0
    count = front.sum(axis=1)
    # the corner that differs from the others comes first
    lone = np.where(count == 1, front.argmax(axis=1), np.where(count == 2, front.argmin(axis=1), 0))
    order = (lone[:, None] + np.arange(3)) % 3
    first, second, third = np.moveaxis(np.take_along_axis(triangles, order[..., None], axis=1), 1, 0)
    at = np.take_along_axis(ahead, order, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        cuts = [
            first + (at[:, 0] / (at[:, 0] - at[:, k]))[:, None] * (other - first)
            for k, other in ((1, second), (2, third))
        ]
    whole = [first, second, third, third]
    corner = [first, cuts[0], cuts[1], cuts[1]]
    quad = [second, third, cuts[1], cuts[0]]
    choice = [np.stack(points, axis=1) for points in (corner, quad, whole)]
    return np.where((count == 3)[:, None, None], choice[2], np.where((count == 2)[:, None, None], choice[1], choice[0]))


def _solid_angle(corners: Array, length: Array) -> Array:
    """The signed solid angles of triangles (n, 3, 3) about the origin, whose corners have distances (n, 3)."""
    first, second, third = np.moveaxis(corners, 1, 0)
    a, b, c = length.T
    volume = np.einsum("nc,nc->n", first, np.cross(second, third))
    dots = [np.einsum("nc,nc->n", *pair) for pair in ((first, second), (second, third), (third, first))]
    angle: Array = 2.0 * np.arctan2(volume, a * b * c + dots[0] * c + dots[1] * a + dots[2] * b)
    return angle
