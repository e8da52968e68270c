"""The triangles of a glTF file, by material, in world space."""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np

from sssgen.interchange.gltf_buffers import Buffers, read_attribute
from sssgen.interchange.gltf_json import JsonElement
from sssgen.interchange.gltf_nodes import node_transforms
from sssgen.interchange.mapping_report import Report
from sssgen.scene.arrays import Array, Indices
from sssgen.scene.geometry_base import unit
from sssgen.scene.mesh import FARTHEST, SMALLEST
from sssgen.scene.mesh_files import FileContent, moved_normals

MOST_TRIANGLES = 20_000_000
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_DRACO = "KHR_draco_mesh_compression"


class Part(NamedTuple):
    """The triangles of a primitive at a node."""

    content: FileContent
    scale: float
    """The cube root of the node's volume scale: lengths of mesh space times this are lengths in world space"""


def meshes(buffers: Buffers, report: Report) -> dict[int, list[Part]]:
    """Index of the material (-1 without one) → the triangles of the file's scene with it.

    Raises SssgenError for nodes in a circle, indices out of range, and accessors that leave their buffers.
    """
    root = buffers.root
    parts: dict[int, list[Part]] = defaultdict(list)
    all_meshes = root.objects("meshes")
    contents: dict[str, FileContent | None] = {}
    materials = root.objects("materials")
    count = 0
    for node, matrix in node_transforms(root):
        if not node.has("mesh"):
            continue
        mesh = node.reference("mesh", all_meshes, "mesh")
        for primitive in mesh.objects("primitives"):
            if primitive.path not in contents:
                contents[primitive.path] = _primitive(primitive, buffers, report)
            content = contents[primitive.path]
            if content is None:
                continue
            count += len(content.faces)
            if count > MOST_TRIANGLES:
                raise node.fault(f"the scene has more than {MOST_TRIANGLES} triangles", "export its parts")
            index = -1
            if primitive.has("material"):
                primitive.reference("material", materials, "material")
                index = primitive.whole("material")
            part = _move(content, matrix)
            if reason := _omission_reason(part.content):
                report.add_omission(node.path, mesh.path, reason)
            else:
                parts[index].append(part)
    return parts


def _omission_reason(content: FileContent) -> str:
    """Why a scene cannot have these triangles, or ''."""
    if not (np.abs(content.vertices) <= FARTHEST).all():
        return f"with the node's transform, it reaches beyond {FARTHEST:g} m"
    if _area(content) == 0.0 or np.ptp(content.vertices, axis=0).max() < SMALLEST:
        return "with the node's transform, no triangle has an area"
    return ""


def join_parts(parts: list[Part]) -> tuple[FileContent, float, float]:
    """The parts as one mesh, the mean of their scales by area, and the relative spread of the scales."""
    contents = [part.content for part in parts]
    starts = np.cumsum([0] + [len(content.vertices) for content in contents])
    white = [np.ones((len(content.vertices), 4)) if content.color is None else content.color for content in contents]
    content = FileContent(
        np.concatenate([content.vertices for content in contents]),
        np.concatenate([content.faces + start for content, start in zip(contents, starts, strict=False)]),
        _join_coordinates([content.uv for content in contents], contents),
        _join_coordinates([content.uv2 for content in contents], contents),
        np.concatenate(white) if any(content.color is not None for content in contents) else None,
        np.concatenate([content.normals for content in contents if content.normals is not None]),
    )
    scales = np.array([part.scale for part in parts])
    areas = np.array([_area(content) for content in contents])
    mean = float((scales * areas).sum() / areas.sum()) if areas.sum() > 0.0 else float(scales.mean())
    return content, mean, float(np.ptp(scales) / mean) if mean > 0.0 else 0.0


def _join_coordinates(sets: list[Array | None], contents: list[FileContent]) -> Array | None:
    """The texture coordinates of all parts, 0 where a part has none; None where no part has any."""
    if all(uv is None for uv in sets):
        return None
    return np.concatenate(
        [np.zeros((len(content.vertices), 2)) if uv is None else uv for uv, content in zip(sets, contents, strict=True)]
    )


def _area(content: FileContent) -> float:
    first, second, third = np.moveaxis(content.vertices[content.faces], 1, 0)
    return 0.5 * float(np.linalg.norm(np.cross(second - first, third - first), axis=1).sum())


def _move(content: FileContent, matrix: Array) -> Part:
    volume = float(np.linalg.det(matrix[:3, :3]))
    faces = content.faces[:, ::-1] if volume < 0.0 else content.faces
    vertices = content.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    normals = moved_normals(content.normals, matrix)
    return Part(content._replace(vertices=vertices, faces=faces, normals=normals), abs(volume) ** (1.0 / 3.0))


def _primitive(primitive: JsonElement, buffers: Buffers, report: Report) -> FileContent | None:
    """The triangles of a primitive in mesh space; None for points and lines."""
    mode = primitive.whole("mode", _TRIANGLES, 0, 6)
    if mode < _TRIANGLES:
        report.add_omission(f"{primitive.path}/mode", mode, "points and lines have no surface")
        return None
    attributes = primitive.child("attributes")
    position = None
    if attributes is not None and attributes.has("POSITION"):
        position = attributes.reference("POSITION", buffers.accessors, "accessor")
    if primitive.extension(_DRACO) is not None and (position is None or not position.has("bufferView")):
        raise primitive.fault(f"its data are compressed with {_DRACO}", "export the file without compression")
    if primitive.has("targets"):
        report.add_omission(f"{primitive.path}/targets", "morph targets", "the mesh is taken as it is without them")
    if attributes is None or position is None:
        report.add_omission(primitive.path, "no POSITION", "a primitive without positions is not drawn")
        return None
    vertices = buffers.numbers(position, 3)
    if primitive.has("indices"):
        accessor = primitive.reference("indices", buffers.accessors, "accessor")
        indices = buffers.numbers(accessor, 1)[:, 0].astype(np.int64)
        if len(indices) and indices.max() >= len(vertices):
            raise accessor.fault(f"the index {indices.max()} is beyond the {len(vertices)} vertices")
    else:
        indices = np.arange(len(vertices))
    uv, uv2 = (_flip_v(read_attribute(attributes, f"TEXCOORD_{index}", buffers, 2), vertices) for index in (0, 1))
    color = read_attribute(attributes, "COLOR_0", buffers, 4)
    color = None if color is None or len(color) != len(vertices) else color
    normals = read_attribute(attributes, "NORMAL", buffers, 3)
    content = FileContent(vertices, _faces(indices, mode), uv, uv2, color, normals)
    return content if normals is not None and len(normals) == len(vertices) else _with_flat_normals(content)


def _with_flat_normals(content: FileContent) -> FileContent:
    """The triangles with the normals of their faces, as for primitives without normals (glTF 2.0, 3.7.2.1)."""
    order = content.faces.reshape(-1)
    corners = content.vertices[content.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    uv, uv2, color = (None if values is None else values[order] for values in (content.uv, content.uv2, content.color))
    faces = np.arange(len(order)).reshape(-1, 3)
    return FileContent(content.vertices[order], faces, uv, uv2, color, np.repeat(unit(across), 3, axis=0))


def _flip_v(uv: Array | None, vertices: Array) -> Array | None:
    """Texture coordinates with v up."""
    if uv is None or len(uv) != len(vertices):
        return None
    return np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)


def _faces(indices: Indices, mode: int) -> Indices:
    """The triangles of a list, a strip or a fan, (f, 3)."""
    if mode == _TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    if mode == _FAN:
        return np.stack([np.broadcast_to(indices[:1], max(len(indices) - 2, 0)), indices[1:-1], indices[2:]], axis=1)
    strip = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
    strip[1::2] = strip[1::2][:, [1, 0, 2]]
    return strip
