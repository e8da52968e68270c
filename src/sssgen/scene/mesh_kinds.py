"""Which kind of file the bytes are that a mesh's name stands for: a picture may have been renamed."""

from __future__ import annotations

from sssgen.support.diagnostics import SssgenError, failure

TITLES = {
    ".obj": "an .obj file", ".ply": "a .ply file", ".stl": "an .stl file", ".glb": "a .glb file",
    ".gltf": "a .gltf file",
}  # fmt: skip
_PICTURES = {b"\x89PNG\r\n": "a PNG picture", b"\xff\xd8\xff": "a JPEG picture"}
_MESHES = {b"glTF": ".glb", b"ply\n": ".ply", b"ply\r": ".ply", b"solid ": ".stl"}
"""What files begin with → their suffixes."""
_HEAD, _TRIANGLE = 84, 50
"""Bytes of a binary .stl file before its triangles, the last four of which are their number, and of a triangle."""


def refuse_other_kind(data: bytes, suffix: str, shown: str) -> None:
    """Raises SssgenError for the bytes of a picture, or of a mesh whose name ends otherwise."""
    for start, title in _PICTURES.items():
        if data.startswith(start):
            raise failure(f"this is {title}, not {TITLES[suffix]}", "name a mesh, or export it again", shown)
    kind = next((kind for start, kind in _MESHES.items() if data.startswith(start)), "")
    kind = ".stl" if not kind and _is_binary_stl(data) else kind
    if kind not in ("", suffix):
        raise failure(f"this is {TITLES[kind]}, not {TITLES[suffix]}", f"rename it, so that it ends in {kind}", shown)


def without_triangles(data: bytes, suffix: str, shown: str) -> SssgenError:
    """The error for a file in which no triangle was found."""
    begins = data.lstrip()[:5].lower()
    is_right = {".stl": begins == b"solid" or _is_binary_stl(data), ".obj": b"v " in data}
    if data and not is_right.get(suffix, True):
        return failure(f"this is not {TITLES[suffix]}", "it may be another kind of file: export it again", shown)
    return failure("the file holds no triangles", "", shown)


def _is_binary_stl(data: bytes) -> bool:
    count = int.from_bytes(data[_HEAD - 4 : _HEAD], "little")
    return len(data) >= _HEAD and len(data) == _HEAD + _TRIANGLE * count
