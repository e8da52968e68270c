"""The mesh that a preset is for: its triangles as a .glb, and its size."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sssgen.interchange.material_writer import mean_chord
from sssgen.interchange.mesh_glb import mesh_file
from sssgen.presets.preset_stages import BodySize
from sssgen.scene.arrays import Array
from sssgen.scene.geometry_mesh import is_closed
from sssgen.scene.mesh import Mesh, Triangles
from sssgen.scene.mesh_files import FileContent


class UsedMesh(NamedTuple):
    """A mesh, checked."""

    path: str
    glb: bytes
    """With smooth normals where the file has none"""
    size: BodySize
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    """The corners of its box"""
    closed: bool

    @property
    def radius(self) -> float:
        """Half the diagonal of the box."""
        return 0.5 * float(np.linalg.norm(np.subtract(self.high, self.low)))


def used_mesh(path: str, longest_mm: float) -> UsedMesh:
    """Reads a mesh whose longest side is `longest_mm` millimetres. Raises SssgenError for a faulty file."""
    geometry = Mesh(path=path)
    mesh = geometry.triangles
    low, high = geometry.bounds()
    longest = float((high - low).max())
    content = _content(mesh, geometry.inside_out)
    size = BodySize(longest_mm / longest, mean_chord(content))
    return UsedMesh(path, mesh_file(content), size, _corner(low), _corner(high), is_closed(geometry))


def _content(mesh: Triangles, inside_out: bool) -> FileContent:
    """The triangles with the normals that sssgen draws; corners with equal values are one vertex."""
    count = len(mesh.corners)
    normals = mesh.corner_normals(np.arange(count)) * (-1.0 if inside_out else 1.0)
    parts = [mesh.places[mesh.corners], normals, *([] if mesh.uv is None else [mesh.uv])]
    corners = np.concatenate([part.reshape(3 * count, -1) for part in parts], axis=1)
    vertices, numbers = np.unique(corners, axis=0, return_inverse=True)
    faces = numbers.reshape(count, 3)
    faces = faces[:, ::-1] if inside_out else faces
    return FileContent(vertices[:, :3], faces, None if mesh.uv is None else vertices[:, 6:8], normals=vertices[:, 3:6])


def _corner(point: Array) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in point)
    return x, y, z
