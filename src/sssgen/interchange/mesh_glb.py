"""Writes triangles as binary glTF (GLB), with texture coordinates, colours of vertices and a material.

trimesh's exporter has one set of texture coordinates; pygltflib would write the header that `glb` writes, and leaves
the views and accessors to its caller.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.mesh_files import FileContent
from sssgen.version import VERSION

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_FLOAT, _UNSIGNED_INT = 5126, 5125
_JSON, _BIN = 0x4E4F534A, 0x004E4942


class Buffer:
    """The binary part of a glTF file, and the views and accessors of it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int = 0) -> int:
        """Appends bytes; returns the number of their view."""
        self.data += bytes(-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append({**view, "target": target} if target else view)
        self.data += data
        return len(self.views) - 1

    def vectors(self, values: Array, bounds: bool = False) -> int:
        """Appends float vectors (n, k); returns the number of their accessor."""
        stored = np.ascontiguousarray(values, "<f4")
        accessor: dict[str, Any] = {
            "bufferView": self.view(stored.tobytes(), _ARRAY_BUFFER),
            "componentType": _FLOAT,
            "count": len(stored),
            "type": f"VEC{stored.shape[1]}",
        }
        if bounds:
            accessor |= {"min": stored.min(axis=0).tolist(), "max": stored.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def indices(self, faces: Any) -> int:
        """Appends the corners of triangles; returns the number of their accessor."""
        stored = np.ascontiguousarray(faces, "<u4").reshape(-1)
        view = self.view(stored.tobytes(), _ELEMENT_ARRAY_BUFFER)
        accessor = {"bufferView": view, "componentType": _UNSIGNED_INT, "count": len(stored), "type": "SCALAR"}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def primitive(mesh: FileContent, buffer: Buffer, tangents: Array | None = None) -> dict[str, Any]:
    """A glTF primitive of the triangles; texture coordinates of the mesh have v up. `tangents`: (v, 4), unit."""
    attributes = {"POSITION": buffer.vectors(mesh.vertices, bounds=True)}
    if mesh.normals is not None:
        attributes["NORMAL"] = buffer.vectors(_unit_normals(mesh.normals))
    if tangents is not None:
        attributes["TANGENT"] = buffer.vectors(tangents)
    for name, uv in (("TEXCOORD_0", mesh.uv), ("TEXCOORD_1", mesh.uv2)):
        if uv is not None:
            attributes[name] = buffer.vectors(np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1))
    if mesh.color is not None:
        attributes["COLOR_0"] = buffer.vectors(np.clip(mesh.color, 0.0, 1.0))
    return {"attributes": attributes, "indices": buffer.indices(mesh.faces)}


def _unit_normals(normals: Array) -> Array:
    """Unit vectors, upwards in place of a zero vector, which glTF does not allow."""
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    usual: Array = np.where(lengths > 0.0, normals / np.maximum(lengths, 1e-300), (0.0, 1.0, 0.0))
    return usual


def document(buffer: Buffer, primitives: Sequence[Mapping[str, Any]], **more: Any) -> dict[str, Any]:
    """The JSON of a glTF file with one mesh, or none; `more` has further arrays, such as materials."""
    drawn: dict[str, Any] = {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": list(primitives)}],
    }
    stored = {"accessors": buffer.accessors, "bufferViews": buffer.views}
    return {
        "asset": {"version": "2.0", "generator": f"sssgen {VERSION}"},
        **(drawn if primitives else {}),
        **{key: values for key, values in stored.items() if values},
        **({"buffers": [{"byteLength": len(buffer.data)}]} if buffer.data else {}),
        **more,
    }


def glb(content: Mapping[str, Any], data: bytes) -> bytes:
    """The bytes of a GLB file (glTF 2.0, section 4.4)."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(data) + bytes(-len(data) % 4)
    chunks = struct.pack("<II", len(text), _JSON) + text
    chunks += struct.pack("<II", len(binary), _BIN) + binary if binary else b""
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def mesh_file(mesh: FileContent, tangents: Array | None = None) -> bytes:
    """A GLB file of the triangles, with an empty material: without one, trimesh drops texture coordinates."""
    buffer = Buffer()
    drawn = {**primitive(mesh, buffer, tangents), "material": 0}
    return glb(document(buffer, [drawn], materials=[{}]), bytes(buffer.data))
