"""Closed triangle meshes of geometry, for renderers that support only triangles.

Boxes, slabs, meshes and their unions are exact. The vertices of other meshes are on the torus or on the zero level of
the distance function; the triangles are inside by at most c² / 8r, for edges of length c and a radius of curvature r.
Parts thinner than a cell of the grid may be missing.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.mesh_distance import is_inside_out
from sssgen.scene.mesh_repair import has_inside
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

RESOLUTION = 96
"""Cells along a side of a distance function's grid, and half of the steps around a torus and its tube."""

_NEWTON_STEPS = 4
_ON_LEVEL = 1e-6
"""The distance, in cells, at which a vertex is on the zero level."""


def mesh_of(geometry: Geometry, resolution: int = RESOLUTION) -> tuple[Array, Indices]:
    """A closed mesh in world space: vertices (v, 3), and faces (f, 3), counter-clockwise seen from outside.

    Raises SssgenError for a mesh with a hole, a distance function without negative values, and a missing libigl.
    """
    if isinstance(geometry, Mesh):
        vertices, faces = geometry.triangles.places, geometry.triangles.corners
        _check_closed(geometry)
    elif isinstance(geometry, Torus):
        vertices, faces = _ring(geometry.major, geometry.minor, 2 * resolution)
    elif isinstance(geometry, Box | Slab):
        vertices, faces = _box(np.array(box_size(geometry)))
    elif isinstance(geometry, Union):
        vertices, faces = _union([mesh_of(part, resolution) for part in geometry.parts])
    else:
        reach = geometry.reach if isinstance(geometry, Distance) else _radius(geometry)
        vertices, faces = _level(geometry.distance, reach, resolution)
    if is_inside_out(vertices, faces):
        faces = faces[:, ::-1]
    matrix = geometry.to_world()
    return vertices @ matrix[:3, :3].T + matrix[:3, 3], np.ascontiguousarray(faces)


def box_size(box: Box | Slab) -> tuple[float, float, float]:
    """The lengths of the edges along x, y and z, in object space."""
    return box.size if isinstance(box, Box) else (box.width, box.height, box.thickness)


def _radius(geometry: Geometry) -> float:
    if isinstance(geometry, Ball):
        return geometry.radius
    if isinstance(geometry, Capsule):
        return 1.01 * (geometry.radius + 0.5 * geometry.length)
    raise failure(f"there is no mesh of a {type(geometry).__name__}")


def _box(size: Array) -> tuple[Array, Indices]:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return corners * size, _halves(quads)


def _ring(major: float, minor: float, steps: int) -> tuple[Array, Indices]:
    """A torus about y, with equally many steps around the axis and around the tube."""
    around, tube = (angle.ravel() for angle in np.meshgrid(*[np.arange(steps) * (2.0 * np.pi / steps)] * 2))
    distance = major + minor * np.cos(tube)
    vertices = np.stack([distance * np.sin(around), minor * np.sin(tube), distance * np.cos(around)], axis=1)
    corner = np.arange(steps * steps).reshape(steps, steps)
    right, up = np.roll(corner, -1, axis=1), np.roll(corner, -1, axis=0)
    quads = np.stack([corner, right, np.roll(right, -1, axis=0), up], axis=-1).reshape(-1, 4)
    return vertices, _halves(quads)


def _union(parts: list[tuple[Array, Indices]]) -> tuple[Array, Indices]:
    """The surface of the union of closed meshes."""
    manifold = need("manifold3d", "manifold3d", "reference")
    solids = [
        manifold.Manifold(manifold.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(faces, np.uint64)))
        for vertices, faces in parts
    ]
    union = manifold.Manifold.batch_boolean(solids, manifold.OpType.Add).to_mesh64()
    return np.asarray(union.vert_properties, np.float64)[:, :3], np.asarray(union.tri_verts, np.int64)


def _halves(quads: Indices) -> Indices:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _level(distance: Callable[[Array], Array], reach: float, resolution: int) -> tuple[Array, Indices]:
    """The zero level of a distance inside the ball of radius `reach`: marching cubes, then Newton steps."""

    def cut(points: Array) -> Array:
        values: Array = np.maximum(distance(points), np.linalg.norm(points, axis=1) - reach)
        return values

    igl = need("igl", "libigl")
    half = reach * (1.0 + 2.0 / resolution)
    cells = _cells_near(cut, half, resolution)
    corners = cells[:, None] + _CORNERS
    keys = corners @ [1, resolution + 1, (resolution + 1) ** 2]
    unique, places = np.unique(keys, return_inverse=True)
    x, y, z = unique % (resolution + 1), unique // (resolution + 1) % (resolution + 1), unique // (resolution + 1) ** 2
    grid = half * (np.stack([x, y, z], axis=1) * (2.0 / resolution) - 1.0)
    values = np.concatenate([cut(part) for part in np.array_split(grid, 16)])
    if not (values < 0.0).any():
        raise failure("the distance function has no negative value: the body has no inside", "widen its reach")
    # a value of exactly 0 at a grid point makes triangles without area
    values = np.where(np.abs(values) < 1e-9 * reach, 1e-9 * reach, values)
    result = igl.marching_cubes(values, grid, np.ascontiguousarray(places.reshape(-1, 8), np.int64), 0.0)
    vertices, faces = np.asarray(result[0], np.float64), np.asarray(result[1], np.int64)
    return _on_level(cut, vertices, 2.0 * half / resolution), faces


_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
"""Of a cell, in the order of libigl."""
_CAUTION = 1.5
"""By how much a distance function may grow faster than the distance before a cell is missed."""


def _cells_near(cut: Callable[[Array], Array], half: float, resolution: int) -> Indices:
    """The cells (c, 3) of a grid over ±`half` that the zero level may cross: a coarse grid, divided near the level."""
    divisions = 1
    while resolution % (2 * divisions) == 0 and resolution // (2 * divisions) >= _COARSEST:
        divisions *= 2
    side = np.arange(resolution // divisions)
    cells = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    while True:
        size = 2.0 * half * divisions / resolution
        near = np.abs(cut(np.asarray((cells + 0.5) * size - half, np.float64))) <= _CAUTION * 0.5 * np.sqrt(3.0) * size
        cells = np.asarray(cells[near], np.int64)
        if divisions == 1:
            return cells
        divisions //= 2
        cells = (2 * cells[:, None] + _CORNERS).reshape(-1, 3)


_COARSEST = 12
"""The fewest cells along a side of the coarse grid."""


def _on_level(cut: Callable[[Array], Array], vertices: Array, farthest: float) -> Array:
    """Vertices moved onto the zero level by Newton steps along the gradient, at most by `farthest`."""
    step = 1e-4 * farthest
    points, first = vertices.copy(), cut(vertices)
    values = first.copy()
    for _ in range(_NEWTON_STEPS):
        off = np.flatnonzero(np.abs(values) > _ON_LEVEL * farthest)
        if not len(off):
            break
        at = points[off]
        slope = np.stack([cut(at + step * axis) - cut(at - step * axis) for axis in np.eye(3)], axis=1) / (2.0 * step)
        square = np.maximum(np.einsum("nc,nc->n", slope, slope), 1e-6)
        moved = at - (values[off] / square)[:, None] * slope - vertices[off]
        length = np.linalg.norm(moved, axis=1, keepdims=True)
        points[off] = vertices[off] + moved * np.minimum(1.0, farthest / np.maximum(length, 1e-30))
        values[off] = cut(points[off])
    closer = np.abs(values) <= np.abs(first)
    return np.where(closer[:, None], points, vertices)


def is_closed(mesh: Mesh) -> bool:
    """Whether each edge has equally many triangles in both directions: the mesh has an inside."""
    return has_inside(mesh.triangles.corners)


def _check_closed(mesh: Mesh) -> None:
    """Raises SssgenError for a mesh without an inside."""
    if not is_closed(mesh):
        message = "the mesh has a hole, or triangles with different orientations: light transport needs an inside"
        raise failure(message, "close it, and make all its triangles counter-clockwise seen from outside", mesh.path)
