"""The mesh that a preset is for: its triangles as a .glb, its size, and what is kept of its material."""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np

from sssgen.interchange.gltf_rest import turned
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import mean_chord
from sssgen.interchange.mesh_glb import mesh_file
from sssgen.presets.kept_material import GltfPart, is_gltf, read_part
from sssgen.presets.preset_stages import BodySize
from sssgen.scene.arrays import Array
from sssgen.scene.geometry_base import any_tangent
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_files import FileContent
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix


class Pose(NamedTuple):
    """How the body of a file is put into the view, whose up is +y and which looks at the body from +z."""

    z_is_up: bool = False
    """Whether the file's up is +z, and its front -y, as in Blender and CAD"""
    turn: float = 0.0
    """Degrees about up, counter-clockwise seen from above"""

    @property
    def matrix(self) -> Array:
        """The rotation (3, 3) of columns."""
        sine, cosine = np.sin(np.radians(self.turn)), np.cos(np.radians(self.turn))
        turned = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]]).round(15)
        return turned @ _Y_FROM_Z if self.z_is_up else turned


_Y_FROM_Z = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
_AS_IT_IS = Pose()


class UsedMesh(NamedTuple):
    """A mesh, checked."""

    path: str
    content: FileContent
    """With smooth normals where the file has none"""
    tangents: Array | None
    """(v, 4) for a normal map; w is -1 where uv is mirrored"""
    size: BodySize
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    """The corners of its box"""
    geometry: Mesh
    """The body as rays see it, as it is in the file"""
    part: GltfPart | None
    """Of a glTF file"""
    report: Report
    """What became of the elements of a glTF file"""

    @property
    def glb(self) -> bytes:
        """The triangles as a file."""
        return mesh_file(self.content, self.tangents)

    @property
    def longest_mm(self) -> float:
        """The longest side of the box in millimetres."""
        return self.size.unit_mm * self._longest

    @property
    def thickness(self) -> float:
        """The mean chord over the longest side of the box."""
        return self.size.mean_chord / self._longest

    @property
    def _longest(self) -> float:
        return max(high - low for low, high in zip(self.low, self.high, strict=True))

    @property
    def radius(self) -> float:
        """Half the diagonal of the box."""
        return 0.5 * float(np.linalg.norm(np.subtract(self.high, self.low)))


def used_mesh(path: str, longest_mm: float | None, material: str = "", pose: Pose = _AS_IT_IS) -> UsedMesh:
    """Reads a mesh whose longest side is `longest_mm` millimetres, or which is in metres where that is None.

    It is turned to `pose`, with the other parts of the file. Of a glTF file, the triangles with one material alone, if
    it is named. Raises SssgenError for a faulty file.
    """
    report, part = Report(os.path.basename(path)), None
    if is_gltf(path) and os.path.isfile(path):
        part = read_part(path, material, report)
        if part.rest and pose != _AS_IT_IS:
            part = part._replace(rest=turned(part.rest, pose.matrix))
        geometry = Mesh(path=f"{os.path.splitext(path)[0]}.glb", data=mesh_file(part.mesh))
    elif material:
        raise failure("a material is chosen of a glTF file", "leave --material out", posix(path))
    else:
        geometry = Mesh(path=path)
    low, high = geometry.bounds()
    longest = float((high - low).max())
    has_relief = part is not None and part.imported is not None and part.imported.model.normal.image is not None
    content, tangents = _content(geometry, has_relief)
    if pose != _AS_IT_IS:
        content, tangents = _posed(content, tangents, pose.matrix.T)
        low, high = content.vertices.min(axis=0), content.vertices.max(axis=0)
    size = BodySize(1000.0 if longest_mm is None else longest_mm / longest, mean_chord(content))
    return UsedMesh(path, content, tangents, size, _corner(low), _corner(high), geometry, part, report)


def _content(geometry: Mesh, has_relief: bool) -> tuple[FileContent, Array | None]:
    """The triangles with the normals that sssgen draws, and tangents; corners with equal values are one vertex."""
    mesh = geometry.triangles
    count, side = len(mesh.corners), -1.0 if geometry.inside_out else 1.0
    normals = mesh.corner_normals(np.arange(count)) * side
    parts = [mesh.places[mesh.corners], normals, *([] if mesh.uv is None else [mesh.uv])]
    if has_relief and mesh.tangents is not None:
        handedness = np.broadcast_to(side * mesh.handedness[:, None, None], (count, 3, 1))
        parts += [_tangents(mesh.tangents, normals), handedness]
    corners = np.concatenate([part.reshape(3 * count, -1) for part in parts], axis=1)
    vertices, numbers = np.unique(corners, axis=0, return_inverse=True)
    faces = numbers.reshape(count, 3)
    faces = faces[:, ::-1] if geometry.inside_out else faces
    uv = None if mesh.uv is None else vertices[:, 6:8]
    tangents = vertices[:, 8:12] if vertices.shape[1] == 12 else None
    return FileContent(vertices[:, :3], faces, uv, normals=vertices[:, 3:6]), tangents


def _posed(mesh: FileContent, tangents: Array | None, matrix: Array) -> tuple[FileContent, Array | None]:
    """The triangles and tangents behind a rotation of rows."""
    assert mesh.normals is not None
    posed = mesh._replace(vertices=mesh.vertices @ matrix, normals=mesh.normals @ matrix)
    return posed, None if tangents is None else np.c_[tangents[:, :3] @ matrix, tangents[:, 3]]


def _tangents(along: Array, normals: Array) -> Array:
    """Unit tangents (f, 3, 3), across the normals."""
    across = along - (along * normals).sum(axis=2, keepdims=True) * normals
    length = np.linalg.norm(across, axis=2, keepdims=True)
    others = any_tangent(normals.reshape(-1, 3)).reshape(normals.shape)
    result: Array = np.where(length > 1e-6, across / np.maximum(length, 1e-6), others)
    return result


def _corner(point: Array) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in point)
    return x, y, z
