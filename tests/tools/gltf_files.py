"""Small glTF files for tests."""

from __future__ import annotations

import base64
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.interchange.mesh_glb import glb


def box_arrays(size: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The corners (24, 3), uv (24, 2) and triangles (12, 3) of a cube about the origin."""
    corners, uv, faces = [], [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            base = len(corners)
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                point = np.zeros(3)
                point[axis] = sign
                point[(axis + 1) % 3], point[(axis + 2) % 3] = (2 * u - 1) * sign, 2 * v - 1
                corners.append(0.5 * size * point)
                uv.append((u, v))
            faces += [(base, base + 1, base + 2), (base, base + 2, base + 3)]
    return np.array(corners, "<f4"), np.array(uv, "<f4"), np.array(faces, "<u2")


def box(material: dict[str, Any] | None = None, **more: Any) -> tuple[dict[str, Any], bytes]:
    """A cube with a material: the JSON and the bytes of its buffer."""
    corners, uv, faces = box_arrays()
    parts = [corners.tobytes(), uv.tobytes(), faces.tobytes()]
    starts = np.cumsum([0, *map(len, parts)]).tolist()
    views = [{"buffer": 0, "byteOffset": starts[i], "byteLength": len(part)} for i, part in enumerate(parts)]
    content: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [material or {"name": "plain"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3", "min": [-0.5] * 3, "max": [0.5] * 3},
            {"bufferView": 1, "componentType": 5126, "count": 24, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": starts[-1]}],
        **more,
    }
    return content, b"".join(parts)


def write_gltf(path: Path, content: dict[str, Any], data: bytes) -> Path:
    """A .gltf file with its buffer inside, or a .glb file."""
    if path.suffix == ".glb":
        path.write_bytes(glb(content, data))
        return path
    path.write_bytes(inlined(content, data))
    return path


def inlined(content: dict[str, Any], data: bytes) -> bytes:
    """The text of a .gltf file with its buffer inside."""
    if content.get("buffers") and "uri" not in content["buffers"][0]:
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        content = {**content, "buffers": [{**content["buffers"][0], "uri": uri}]}
    return json.dumps(content).encode()


def png(color: tuple[int, ...], size: tuple[int, int] = (2, 2)) -> bytes:
    """A picture of one colour, of 1 to 4 channels."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.new({1: "L", 3: "RGB", 4: "RGBA"}[len(color)], size, color if len(color) > 1 else color[0]).save(
        buffer, "PNG"
    )
    return buffer.getvalue()


def data_uri(picture: bytes) -> str:
    """A picture inside the JSON."""
    return "data:image/png;base64," + base64.b64encode(picture).decode()


def glb_header(length: int) -> bytes:
    """The first twelve bytes of a GLB file."""
    return struct.pack("<4sII", b"glTF", 2, length)
