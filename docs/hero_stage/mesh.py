"""A mesh of a hero: triangles with normals and what its vertices know of the surface."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
_RAYS = 48
_CHUNK = 40_000
_NEAR_FLOOR = 0.35
"""How far away, in sizes of a body, a floor is dark: it lies in the shadow of the body."""


@dataclass(frozen=True)
class Mesh:
    """Triangles in world units, counter-clockwise seen from outside."""

    vertices: Array
    """(n, 3)"""
    faces: npt.NDArray[np.int64]
    """(m, 3)"""
    normals: Array
    """(n, 3), of unit length"""
    colors: Array = field(default_factory=lambda: np.ones((0, 4)))
    """(n, 4), or none: the surface's factors red to blue, and in alpha the share of the surroundings that it sees"""
    uv: Array = field(default_factory=lambda: np.zeros((0, 2)))
    """(n, 2), or none: (0, 0) is the lower left corner of a picture"""

    def with_colors(self, tint: Array | float = 1.0, occluded: bool = True, floor: float | None = None) -> Mesh:
        """With factors of the surface, (n, 3) or one number, and with the share of the surroundings at each vertex; a
        floor at the height `floor` is in the way, too."""
        seen = self._openness(floor) if occluded else np.ones(len(self.vertices))
        rgb = np.broadcast_to(tint if np.ndim(tint) else np.full(3, tint), (len(self.vertices), 3))
        return dataclasses.replace(self, colors=np.column_stack([rgb, seen]))

    def _openness(self, floor: float | None) -> Array:
        """The share of the hemisphere, weighted by the cosine, that is free at each vertex."""
        import trimesh

        body = trimesh.Trimesh(self.vertices, self.faces, process=False)
        size = float(np.ptp(self.vertices, axis=0).max())
        step = 2e-3 * size
        random, open_share = np.random.default_rng(0), np.zeros(len(self.vertices))
        for start in range(0, len(self.vertices), _CHUNK):
            normals = self.normals[start : start + _CHUNK]
            origins = np.repeat(self.vertices[start : start + _CHUNK] + step * normals, _RAYS, axis=0)
            ways = random.normal(size=origins.shape)
            ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
            ways += np.repeat(normals, _RAYS, axis=0)
            hits = body.ray.intersects_any(origins, ways)
            if floor is not None:
                reach = (origins[:, 1] - floor) / np.maximum(-ways[:, 1], 1e-9)
                hits |= (ways[:, 1] < 0.0) & (reach < _NEAR_FLOOR * size)
            open_share[start : start + _CHUNK] = 1.0 - hits.reshape(-1, _RAYS).mean(axis=1)
        return open_share

    def write_glb(self, path: Path) -> None:
        """As a .glb with normals and, where it has them, colours and texture coordinates."""
        import trimesh

        body = trimesh.Trimesh(self.vertices, self.faces, vertex_normals=self.normals, process=False)
        colors = np.rint(255.0 * np.clip(self.colors, 0, 1)).astype(np.uint8)
        if len(self.uv):
            body.visual = trimesh.visual.TextureVisuals(uv=self.uv)
            if len(colors):
                body.visual.vertex_attributes["color"] = colors
        elif len(colors):
            body.visual = trimesh.visual.ColorVisuals(body, vertex_colors=colors)
        path.write_bytes(trimesh.exchange.gltf.export_glb(body, include_normals=True))


def merged(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)])
    parts = ("vertices", "normals", "colors", "uv")
    return Mesh(faces=faces, **{name: np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in parts})


def mirrored(mesh: Mesh) -> Mesh:
    """On the other side of the plane x = 0."""
    flip = np.array([-1.0, 1.0, 1.0])
    return Mesh(mesh.vertices * flip, mesh.faces[:, ::-1], mesh.normals * flip)
