"""Triangle meshes: rays by Embree, distances by libigl, smooth normals and tangents."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene import mesh_files
from sssgen.scene.arrays import Array, Indices
from sssgen.scene.geometry_base import Geometry, Hits, any_tangent, spherical, spread, tangent_of, unit
from sssgen.scene.mesh_distance import MeshDistance, is_inside_out, rim_length
from sssgen.scene.mesh_rays import MeshRays
from sssgen.scene.mesh_repair import flipped, has_inside, repeated, welded
from sssgen.scene.toml_table import ANY
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix

FARTHEST = ANY[1]
"""The largest coordinate, as for a scene's numbers: products of a few of them do not overflow."""

SMALLEST = 1e-6
"""The smallest size of a mesh's longest side, as for a scene's numbers."""


class Triangles(NamedTuple):
    """A mesh for intersections; vertices at the same position are merged, and neighbours face the same way."""

    places: Array
    """(v, 3)"""
    corners: Indices
    """(f, 3) indices of places, counter-clockwise seen from outside"""
    flat: Array
    """(f, 3): the faces' unit normals"""
    normals: Array
    """(v, 3), unit"""
    uv: Array | None
    """(f, 3, 2), or None where the file has none"""
    tangents: Array | None
    """(f, 3, 3): the direction in which u grows at each corner; not unit, 0 where undefined"""
    handedness: Array
    """(f,): -1 where uv is mirrored, else 1"""
    uv2: Array | None = None
    """(f, 3, 2): the second set, or None"""
    color: Array | None = None
    """(f, 3, 4): linear colours with their opacity, or None"""
    own_normals: Array | None = None
    """(f, 3, 3): those of the file, unit; 0 where it has none; or None"""
    turned: int = 0
    """How many triangles were turned, so that neighbours face the same way"""
    repeated: int = 0
    """How many triangles were left out, as they are equal to others"""
    reversed: bool = False
    """Whether all triangles were turned, as the closed mesh of the file is inside out"""

    def corner_normals(self, face: npt.NDArray[Any]) -> Array:
        """The normals at the corners of triangles, (n, 3, 3): those of the file, or else smooth ones."""
        smooth: Array = self.normals[self.corners[face]]
        if self.own_normals is None:
            return smooth
        own = self.own_normals[face]
        normals: Array = np.where((own != 0.0).any(axis=2, keepdims=True), own, smooth)
        return normals


@dataclass(frozen=True)
class Mesh(Geometry):
    """The triangles of an .obj, .ply, .stl, .glb or .gltf file, open or closed. A file's parts become one mesh.

    The second set of uv and the colours of the vertices are the file's, or else 0 and white.

    Normals are those of a glTF file, interpolated. Other files, and parts without normals, have smooth ones: the
    faces' normals, averaged at each vertex by area. uv, v up, are the file's, or else longitude and latitude about the
    bounding box's centre (see `spherical`). Tangents follow Lengyel (Foundations of Game Engine Development 2, 7.5),
    with w = -1 where uv is mirrored.
    """

    path: str = ""
    data: bytes = field(default=b"", repr=False)
    """The content of a file that is not on this machine's disk; `path` is then its name."""

    def cast(self, origin: Array, directions: Array) -> Hits:
        mesh = self.triangles
        low, high = self.bounds()
        # Embree computes in float32, which is more precise near the mesh
        ahead = np.linalg.norm(0.5 * (low + high) - origin) - 0.5 * np.linalg.norm(high - low)
        starts = origin + max(0.0, float(ahead)) * directions
        face = self.rays.first(starts, directions)
        rays = np.flatnonzero(face >= 0)
        face = face[rays]
        slope = np.einsum("nc,nc->n", directions[rays], mesh.flat[face])
        keep = slope != 0.0
        rays, face, slope = rays[keep], face[keep], slope[keep]
        first = mesh.places[mesh.corners[face, 0]]
        t = np.einsum("nc,nc->n", first - origin, mesh.flat[face]) / slope
        position = origin + t[:, None] * directions[rays]
        weights = barycentric(position, mesh.places[mesh.corners[face]])
        hit = np.zeros(len(directions), np.bool_)
        hit[rays] = True
        normal = _interpolate(weights, mesh.corner_normals(face))
        normal = np.where((np.abs(normal) > 0.0).any(axis=1, keepdims=True), unit(normal), mesh.flat[face])
        others = [None if values is None else _interpolate(weights, values[face]) for values in (mesh.uv2, mesh.color)]
        if mesh.uv is None or mesh.tangents is None:
            uv, grows_u, grows_v = spherical(position - 0.5 * (low + high))
            return spread(hit, position, normal, tangent_of(normal, grows_u, grows_v), uv, slope < 0.0, *others)
        along = unit(_interpolate(weights, mesh.tangents[face]))
        along -= np.einsum("nc,nc->n", along, normal)[:, None] * normal
        undefined = np.linalg.norm(along, axis=1, keepdims=True) < 1e-6
        tangent = np.where(undefined, any_tangent(normal), unit(along))
        return spread(
            hit, position, normal, np.c_[tangent, mesh.handedness[face]], _interpolate(weights, mesh.uv[face]),
            slope < 0.0, *others,
        )  # fmt: skip

    def distance(self, points: Array) -> Array:
        """The sign is by the winding number, which open meshes also have. Raises SssgenError without libigl."""
        return self.solid.signed_distance(points)

    def bounds(self) -> tuple[Array, Array]:
        """The smallest and the largest corner, in object space."""
        return self.triangles.places.min(axis=0), self.triangles.places.max(axis=0)

    @cached_property
    def triangles(self) -> Triangles:
        """The mesh, read from its file. Raises SssgenError for a file that is missing or holds none."""
        content = mesh_files.parse(self.data, self.path) if self.data else mesh_files.read(self.path)
        return _prepare(content, posix(self.path))

    @cached_property
    def solid(self) -> MeshDistance:
        """The distance to the triangles, and which points are inside."""
        return MeshDistance(self.triangles.places, self.triangles.corners)

    @cached_property
    def inside_out(self) -> bool:
        """Whether most normals of an open mesh point inwards (by volume); a closed one is turned as it is read."""
        return is_inside_out(self.triangles.places, self.triangles.corners)

    @cached_property
    def closed(self) -> bool:
        """Whether the mesh has no hole."""
        return rim_length(self.triangles.places, self.triangles.corners) == 0.0

    @cached_property
    def rays(self) -> MeshRays:
        """The ray caster for the triangles."""
        return MeshRays(self.triangles.places, self.triangles.corners)


def check_content(content: mesh_files.FileContent, shown: str) -> None:
    """Raises SssgenError for a file without triangles, or with faulty ones; `shown` is its name in messages."""
    vertices, faces = content.vertices, content.faces
    if not len(faces):
        raise failure("the file holds no triangles", "", shown)
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise failure("a triangle refers to a missing vertex", "export it again", shown)
    if not (np.abs(vertices) <= FARTHEST).all():
        raise failure(f"a vertex is not a number, or beyond {FARTHEST:g}", "scale the mesh, or export it again", shown)


def _prepare(content: mesh_files.FileContent, shown: str) -> Triangles:
    check_content(content, shown)
    vertices, faces, uv, uv2, color, own_normals = content
    uv, uv2 = _usable(uv, (len(vertices), 2)), _usable(uv2, (len(vertices), 2))
    color = _usable(color, (len(vertices), 4))
    own_normals = _usable(own_normals, (len(vertices), 3))
    # a file may have vertices that belong to no triangle
    used = np.flatnonzero(np.bincount(faces.ravel(), minlength=len(vertices)))
    number = np.zeros(len(vertices), np.int64)
    number[used] = np.arange(len(used))
    places, place_of = welded(vertices[used], number[faces])
    if (size := float(np.ptp(places, axis=0).max())) < SMALLEST:
        raise failure(f"the mesh is only {size:.1g} units large", f"scale it: at least {SMALLEST:g}", shown)
    corners = place_of[number[faces]]
    first, second, third = np.moveaxis(places[corners], 1, 0)
    across = np.cross(second - first, third - first)
    area = np.linalg.norm(across, axis=1)
    if not area.any():
        raise failure("no triangle has an area", "", shown)
    valid = area > 0.0
    copies = valid.copy()
    copies[valid] = repeated(corners[valid])
    valid &= ~copies
    faces, corners, across = faces[valid], corners[valid], across[valid]
    if (turned := flipped(corners, area[valid])).any():
        faces, corners = (np.where(turned[:, None], rows[:, ::-1], rows) for rows in (faces, corners))
        across = np.where(turned[:, None], -across, across)
    own = None if own_normals is None else unit(own_normals)
    if inside_out := has_inside(corners) and is_inside_out(places, corners):
        faces, corners, across = faces[:, ::-1], np.ascontiguousarray(corners[:, ::-1]), -across
        if own is not None and np.einsum("fkc,fc->", own[faces], across) < 0.0:  # they face as the triangles did
            own = -own
    sums = [np.bincount(corners.ravel(), np.repeat(across[:, axis], 3), len(places)) for axis in range(3)]
    normals: Array = np.stack(sums, axis=1).astype(np.float64)
    uv2, color, own_normals = (None if values is None else values[faces] for values in (uv2, color, own))
    mesh = Triangles(
        places, corners, unit(across), unit(normals), None, None, np.ones(len(faces)), uv2, color, own_normals,
        int(turned.sum()), int(copies.sum()), inside_out,
    )  # fmt: skip
    return mesh if uv is None else _with_tangents(mesh, uv[faces])


def _usable(values: Array | None, shape: tuple[int, int]) -> Array | None:
    """The values of the vertices, or None where they are not of that shape or no usual numbers."""
    usable = values is not None and values.shape == shape and bool((np.abs(values) <= FARTHEST).all())
    return values if usable else None


def _with_tangents(mesh: Triangles, uv: Array) -> Triangles:
    """The mesh with its uv, (f, 3, 2), and the tangents of these."""
    corners = mesh.places[mesh.corners]
    edges, uv_edges = corners[:, 1:] - corners[:, :1], uv[:, 1:] - uv[:, :1]
    area = uv_edges[:, 0, 0] * uv_edges[:, 1, 1] - uv_edges[:, 0, 1] * uv_edges[:, 1, 0]
    along = edges[:, 0] * uv_edges[:, 1, 1, None] - edges[:, 1] * uv_edges[:, 0, 1, None]
    size = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    along = unit(along * np.sign(area)[:, None]) * size[:, None]
    handedness = np.where(area < 0.0, -1.0, 1.0)
    # corners share a tangent if position, uv and handedness agree; otherwise mirrored halves would cancel at their seam
    mirrored = np.repeat(handedness, 3)
    keys = np.c_[mesh.corners.reshape(-1), uv.reshape(-1, 2), mirrored]
    groups, group_of = np.unique(keys, axis=0, return_inverse=True)
    sums = np.zeros((len(groups), 3))
    np.add.at(sums, group_of.reshape(-1), np.repeat(along, 3, axis=0))
    tangents = unit(sums)[group_of.reshape(-1)].reshape(-1, 3, 3)
    return mesh._replace(uv=uv, tangents=tangents, handedness=handedness)


def barycentric(points: Array, triangles: Array) -> Array:
    """The weights (n, 3) of the corners of triangles (n, 3, 3) at points in their planes, clamped to the triangles."""
    first, second, third = np.moveaxis(triangles, 1, 0)
    across = np.cross(second - first, third - first)
    square = np.einsum("nc,nc->n", across, across)
    b = np.einsum("nc,nc->n", np.cross(points - first, third - first), across) / square
    c = np.einsum("nc,nc->n", np.cross(second - first, points - first), across) / square
    weights = np.maximum(np.stack([1.0 - b - c, b, c], axis=1), 0.0)
    normalized: Array = weights / weights.sum(axis=1, keepdims=True)
    return normalized


def _interpolate(weights: Array, values: Array) -> Array:
    """The values (n, 3, k) of corners, interpolated with weights (n, 3)."""
    values_at_points: Array = np.einsum("nv,nvk->nk", weights, values)
    return values_at_points
