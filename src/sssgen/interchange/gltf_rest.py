"""The rest of a glTF file: what it shows without the triangles of one material."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable
from typing import Any

import numpy as np

from sssgen.interchange.gltf_buffers import Buffers
from sssgen.interchange.gltf_container import open_file
from sssgen.interchange.mesh_glb import Buffer, glb
from sssgen.scene.arrays import Array

_JPEG = b"\xff\xd8"


def without_material(path: str, material: str) -> bytes:
    """A GLB file with all that a glTF file shows but the triangles of a material; b'' where no others are left.

    It does not move, and has no cameras and lights. Raises SssgenError for a faulty file.
    """
    container = open_file(path)
    buffers, buffer = Buffers(container), Buffer()
    content: dict[str, Any] = copy.deepcopy(container.root.value)
    names = [element.get("name", "") for element in content.get("materials", ())]
    if not _remove_triangles(content, {index for index, name in enumerate(names) if material in (name, str(index))}):
        return b""
    for view, element in zip(content.get("bufferViews", ()), buffers.views, strict=True):
        view |= buffer.views[buffer.view(buffers.view(element))]
    for image, element in zip(content.get("images", ()), container.root.objects("images"), strict=True):
        if "uri" in image:
            data = container.resource(element)
            del image["uri"]
            image |= {"bufferView": buffer.view(data), "mimeType": _mime_type(data)}
            content.setdefault("bufferViews", []).append(buffer.views[-1])
    content["buffers"] = [{"byteLength": len(buffer.data)}]
    for key in ("animations", "skins", "cameras"):
        content.pop(key, None)
    for node in content.get("nodes", ()):
        for key in ("skin", "camera", "extensions"):
            node.pop(key, None)
    content.get("extensions", {}).pop("KHR_lights_punctual", None)
    return glb(content, bytes(buffer.data))


def turned(data: bytes, matrix: Array) -> bytes:
    """A GLB file of `without_material` behind a rotation (3, 3) of columns: a node above those of its scene."""
    length = int.from_bytes(data[12:16], "little")
    content = json.loads(data[20 : 20 + length])
    shown = content.get("scene", 0)
    for scene in content.get("scenes", ())[shown : shown + 1]:
        placed = np.eye(4)
        placed[:3, :3] = matrix
        content["nodes"].append({"children": scene["nodes"], "matrix": placed.T.ravel().tolist()})
        content |= {"scenes": [scene | {"nodes": [len(content["nodes"]) - 1]}], "scene": 0}
    return glb(content, data[28 + length :])


def _remove_triangles(content: dict[str, Any], materials: Iterable[int]) -> bool:
    """Removes the triangles of materials, and meshes that have no others; whether any triangles are left."""
    places: dict[int, int] = {}
    kept: list[dict[str, Any]] = []
    for index, mesh in enumerate(content.get("meshes", ())):
        primitives = [entry for entry in mesh["primitives"] if entry.get("material") not in materials]
        if primitives:
            places[index] = len(kept)
            kept.append(mesh | {"primitives": primitives})
    for node in content.get("nodes", ()):
        if "mesh" in node:
            place = places.get(node.pop("mesh"))
            if place is not None:
                node["mesh"] = place
    content["meshes"] = kept
    return any("mesh" in node for node in content.get("nodes", ()))


def _mime_type(data: bytes) -> str:
    return "image/jpeg" if data.startswith(_JPEG) else "image/png"
