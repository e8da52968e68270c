"""Triangle meshes: rays by Embree, distances by libigl, smooth normals and tangents."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.harness.scenes import mesh_files
from sssgen.harness.scenes.mesh_distance import MeshDistance, is_inside_out
from sssgen.harness.scenes.mesh_rays import MeshRays
from sssgen.harness.scenes.placed import Array, Geometry, Hits, any_tangent, spherical, spread, tangent_of, unit
from sssgen.harness.scenes.toml_table import ANY
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix

Indices: TypeAlias = npt.NDArray[np.int64]

FARTHEST = ANY[1]
"""The largest coordinate: of a scene's numbers, so that no product of a few of them overflows."""

SMALLEST = 1e-6
"""The least that the largest side of a mesh may be: of a scene's numbers, too."""


class Triangles(NamedTuple):
    """A mesh as it is needed here; vertices at the same place are one."""

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
    """(f, 3, 3): of each corner, the direction in which u grows; of any length, 0 where there is none"""
    handedness: Array
    """(f,): -1 where uv is mirrored, else 1"""


@dataclass(frozen=True)
class Mesh(Geometry):
    """The triangles of an .obj, .ply, .stl, .glb or .gltf file; open ones, too. A file's parts become one mesh.

    Normals are smooth: the faces' at a vertex, weighted by area, interpolated; a file's own are not read. uv, v up,
    are the file's; without, longitude and latitude about the box's centre (see `spherical`). Tangents are Lengyel's
    (Foundations of Game Engine Development 2, 7.5), where uv is mirrored with w = -1.
    """

    path: str = ""

    def cast(self, origin: Array, directions: Array) -> Hits:
        mesh = self.triangles
        low, high = self.bounds()
        # Embree counts in 32 bits: near the mesh there are more of them to spare
        way = np.linalg.norm(0.5 * (low + high) - origin) - 0.5 * np.linalg.norm(high - low)
        starts = origin + max(0.0, float(way)) * directions
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
        normal = _mixed(weights, mesh.normals[mesh.corners[face]])
        normal = np.where((np.abs(normal) > 0.0).any(axis=1, keepdims=True), unit(normal), mesh.flat[face])
        if mesh.uv is None or mesh.tangents is None:
            uv, grows_u, grows_v = spherical(position - 0.5 * (low + high))
            return spread(hit, position, normal, tangent_of(normal, grows_u, grows_v), uv)
        along = unit(_mixed(weights, mesh.tangents[face]))
        along -= np.einsum("nc,nc->n", along, normal)[:, None] * normal
        lost = np.linalg.norm(along, axis=1, keepdims=True) < 1e-6
        tangent = np.where(lost, any_tangent(normal), unit(along))
        return spread(hit, position, normal, np.c_[tangent, mesh.handedness[face]], _mixed(weights, mesh.uv[face]))

    def distance(self, points: Array) -> Array:
        """Its sign is that of the winding number, which open meshes have too. Raises SssgenError without libigl."""
        return self.solid.signed(points)

    def bounds(self) -> tuple[Array, Array]:
        """The smallest and the largest corner, in object space."""
        return self.triangles.places.min(axis=0), self.triangles.places.max(axis=0)

    @cached_property
    def triangles(self) -> Triangles:
        """The mesh, read from its file. Raises SssgenError for a file that is missing or holds none."""
        return _prepare(mesh_files.read(self.path), posix(self.path))

    @cached_property
    def solid(self) -> MeshDistance:
        """What knows the distance to the triangles, and which points are inside."""
        return MeshDistance(self.triangles.places, self.triangles.corners)

    @cached_property
    def inside_out(self) -> bool:
        """Whether the triangles' normals look inwards, on the whole."""
        return is_inside_out(self.triangles.places, self.triangles.corners)

    @cached_property
    def rays(self) -> MeshRays:
        """What casts rays at the triangles."""
        return MeshRays(self.triangles.places, self.triangles.corners)


def _prepare(read: mesh_files.Read, shown: str) -> Triangles:
    vertices, faces, uv = read
    if not len(faces):
        raise failure("the file holds no triangles", "", shown)
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise failure("a triangle names a vertex that there is not", "write it anew", shown)
    if not (np.abs(vertices) <= FARTHEST).all():
        raise failure(f"a vertex is no number, or beyond {FARTHEST:g}", "scale the mesh, or write it anew", shown)
    if uv is not None and (uv.shape != (len(vertices), 2) or not (np.abs(uv) <= FARTHEST).all()):
        uv = None
    named, at = np.unique(faces, return_inverse=True)  # a file may have vertices that belong to no triangle
    places, place_of = np.unique(vertices[named], axis=0, return_inverse=True)
    if (size := float(np.ptp(places, axis=0).max())) < SMALLEST:
        raise failure(f"the mesh is only {size:.1g} units large", f"scale it: at least {SMALLEST:g}", shown)
    corners = place_of.reshape(-1)[at.reshape(faces.shape)]
    first, second, third = np.moveaxis(places[corners], 1, 0)
    across = np.cross(second - first, third - first)
    area = np.linalg.norm(across, axis=1)
    if not area.any():
        raise failure("all triangles are without area", "", shown)
    full = area > 0.0
    faces, corners, across = faces[full], corners[full], across[full]
    normals = np.zeros_like(places)
    np.add.at(normals, corners, across[:, None, :])
    mesh = Triangles(places, corners, unit(across), unit(normals), None, None, np.ones(len(faces)))
    return mesh if uv is None else _with_tangents(mesh, uv[faces])


def _with_tangents(mesh: Triangles, uv: Array) -> Triangles:
    """The mesh with its uv, (f, 3, 2), and the tangents that follow from them."""
    corners = mesh.places[mesh.corners]
    edges, turns = corners[:, 1:] - corners[:, :1], uv[:, 1:] - uv[:, :1]
    area = turns[:, 0, 0] * turns[:, 1, 1] - turns[:, 0, 1] * turns[:, 1, 0]
    along = edges[:, 0] * turns[:, 1, 1, None] - edges[:, 1] * turns[:, 0, 1, None]
    size = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    along = unit(along * np.sign(area)[:, None]) * size[:, None]
    handedness = np.where(area < 0.0, -1.0, 1.0)
    # corners share a tangent where place, uv and handedness agree: else mirrored halves would cancel at their seam
    mirrored = np.repeat(handedness, 3)
    keys = np.c_[mesh.corners.reshape(-1), uv.reshape(-1, 2), mirrored]
    groups, group_of = np.unique(keys, axis=0, return_inverse=True)
    sums = np.zeros((len(groups), 3))
    np.add.at(sums, group_of.reshape(-1), np.repeat(along, 3, axis=0))
    tangents = unit(sums)[group_of.reshape(-1)].reshape(-1, 3, 3)
    return mesh._replace(uv=uv, tangents=tangents, handedness=handedness)


def barycentric(points: Array, triangles: Array) -> Array:
    """The weights (n, 3) of the corners of triangles (n, 3, 3) at points in their planes, cut to the triangles."""
    first, second, third = np.moveaxis(triangles, 1, 0)
    across = np.cross(second - first, third - first)
    square = np.einsum("nc,nc->n", across, across)
    b = np.einsum("nc,nc->n", np.cross(points - first, third - first), across) / square
    c = np.einsum("nc,nc->n", np.cross(second - first, points - first), across) / square
    weights = np.maximum(np.stack([1.0 - b - c, b, c], axis=1), 0.0)
    whole: Array = weights / weights.sum(axis=1, keepdims=True)
    return whole


def _mixed(weights: Array, values: Array) -> Array:
    """The values (n, 3, k) of corners, mixed by their weights (n, 3)."""
    mixed: Array = np.einsum("nv,nvk->nk", weights, values)
    return mixed
