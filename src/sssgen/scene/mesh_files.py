"""Reads triangles from mesh files, with trimesh."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.spans import Span
from sssgen.scene.arrays import Array, Indices
from sssgen.scene.obj_lines import faulty_line, is_doubtful
from sssgen.scene.obj_polygons import without_concave
from sssgen.scene.pictures.images import decode_srgb
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean, failure
from sssgen.support.extras import need
from sssgen.support.file_memo import note
from sssgen.support.paths import posix
from sssgen.support.text_files import refuse_folder

SUFFIXES = (".obj", ".ply", ".stl", ".glb", ".gltf")

COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
"""Extensions of glTF that store triangles in another way."""


class FileContent(NamedTuple):
    """The content of a file, unchecked."""

    vertices: Array
    """(v, 3)"""
    faces: Indices
    """(f, 3) indices of vertices"""
    uv: Array | None
    """(v, 2), v up, or None where a part of the file has none"""
    uv2: Array | None = None
    """(v, 2): glTF's second set, v up, or None where a part of the file has none"""
    color: Array | None = None
    """(v, 4): linear colours with their opacity, or None where no part of the file has any"""
    normals: Array | None = None
    """(v, 3): a glTF file's own normals, 0 where a part has none; None where no part has any"""


def check_suffix(path: str) -> None:
    """Raises SssgenError for a path without the suffix of a mesh file."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in SUFFIXES:
        hint = did_you_mean(suffix, SUFFIXES) or f"export the mesh as one that ends in {', '.join(SUFFIXES)}"
        raise failure(f"'{suffix}' is not a mesh file's suffix", hint, posix(path))


def read(path: str) -> FileContent:
    """All triangles of a file, with the transforms of its parts. Raises SssgenError for a missing or faulty file."""
    refuse_folder(path, SUFFIXES)
    check_suffix(path)
    note(path)
    if not os.path.isfile(path):
        raise failure("cannot find the mesh", "", posix(path))
    kind = os.path.splitext(path)[1].lower()

    def content() -> bytes:
        with open(path, "rb") as file:
            return file.read()

    return _parse(content, kind, posix(path), path)


def parse(data: bytes, name: str) -> FileContent:
    """All triangles of a file's bytes; `name` gives its type, and files that it refers to are not read.

    Raises SssgenError for a faulty file.
    """
    check_suffix(name)
    return _parse(lambda: data, os.path.splitext(name)[1].lower(), name)


def _parse(content: Callable[[], bytes], kind: str, shown: str, beside: str = "") -> FileContent:
    """The triangles of a file; those that it refers to are read next to `beside`, and not at all without it."""
    trimesh, data = need("trimesh"), b""
    try:
        data = content()
        if kind in (".glb", ".gltf"):
            _refuse_compressed(data, kind, shown)
            # texture coordinates are loaded with the materials
            return _join(trimesh.load_scene(*_gltf(data, kind, beside), process=False))
        # the reader of .obj knows spaces alone, and makes fans of polygons
        read = without_concave(data.replace(b"\t", b" ")) if kind == ".obj" else data
        loaded = trimesh.load_mesh(io.BytesIO(read), file_type=kind[1:], process=False, skip_materials=True)
        uv, color = getattr(loaded.visual, "uv", None), _colors(loaded)
        if kind == ".obj" and is_doubtful(data, uv is not None):
            _refuse_faulty_line(data, shown)
        if color is not None:  # of a file format without a colour space: as its editors show them
            color[:, :3] = decode_srgb(color[:, :3])
        return _read(loaded.vertices, loaded.faces, uv, None, color)
    except SssgenError:
        raise
    except FileNotFoundError as error:
        hint = "copy it to the same folder"
        raise failure(f"there is no file '{error.filename or error}' beside this one", hint, shown) from None
    except Exception as error:  # its readers raise exceptions of any type for a faulty file
        if kind == ".obj":
            _refuse_faulty_line(data, shown)
        # for bytes that are not text it tries to import a package that guesses encodings
        report = "" if isinstance(error, ImportError) or kind == ".obj" else f"; its reader reports: {error}"
        hint = f"it may be cut off, or another kind of file: export it again{report}"
        raise failure(f"the mesh cannot be read: it is not a valid {kind} file", hint, shown) from None


def _refuse_faulty_line(data: bytes, shown: str) -> None:
    """Raises SssgenError for the first wrong line of an .obj file."""
    if (fault := faulty_line(data)) is not None:
        number, text, message = fault
        span = Span(shown, number, 1, number, len(text) + 1)
        raise SssgenError([Diagnostic("error", message, span, "correct the line, or export the mesh again", text)])


def _read(vertices: Any, faces: Any, uv: Any, uv2: Any = None, color: Any = None) -> FileContent:
    return FileContent(
        np.asarray(vertices, np.float64).reshape(-1, 3),
        np.asarray(faces, np.int64).reshape(-1, 3),
        None if uv is None else np.asarray(uv, np.float64),
        uv2,
        color,
    )


_SECOND, _NORMAL = b'"TEXCOORD_1"', b'"NORMAL"'
_CUSTOM, _OWN_NORMAL = b'"_TEXCOORD1"', b'"_NORML"'
"""Of the same lengths: trimesh reads attributes with names of an application's own. It has no second set of texture
coordinates, and its normals do not say whether they are the file's."""


def _gltf(data: bytes, kind: str, beside: str) -> tuple[Any, str, Any]:
    """A glTF file for trimesh, its attributes renamed: the file, its type, and what finds files beside it."""
    from trimesh.resolvers import FilePathResolver

    # the JSON of a .glb is its first chunk
    end = 20 + int.from_bytes(data[12:16], "little") if kind == ".glb" else len(data)
    resolver = FilePathResolver(beside) if beside else None
    head = data[:end].replace(_SECOND, _CUSTOM).replace(_NORMAL, _OWN_NORMAL)
    return io.BytesIO(head + data[end:]), kind[1:], resolver


def _refuse_compressed(data: bytes, kind: str, shown: str) -> None:
    """Raises SssgenError for a glTF file that needs a decoder of its triangles: they would be read as zeros."""
    text = data[20 : 20 + int.from_bytes(data[12:16], "little")] if kind == ".glb" else data
    required = json.loads(text).get("extensionsRequired", ())
    for name in COMPRESSED:
        if name in required:
            hint = "export the mesh without compression"
            raise failure(f"its triangles are compressed by {name}, which is not read", hint, shown)


def _second(mesh: Any) -> Array | None:
    """The second set of texture coordinates of a mesh of a glTF file, v up."""
    raw = mesh.vertex_attributes.get(_CUSTOM.decode().strip('"'))
    if raw is None:
        return None
    uv = _fractions(raw)
    return np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)


def _own_normals(mesh: Any) -> Array | None:
    """The normals of a mesh of a glTF file."""
    raw = mesh.vertex_attributes.get(_OWN_NORMAL.decode().strip('"'))
    return None if raw is None else np.asarray(raw, np.float64)


def _colors(mesh: Any) -> Array | None:
    """The colours of a mesh's vertices, (v, 4), as the file has them."""
    visual = mesh.visual
    raw = visual.vertex_attributes.get("color") if hasattr(visual, "vertex_attributes") else None
    if raw is None and visual.kind == "vertex":
        raw = visual.vertex_colors
    if raw is None:
        return None
    values = _fractions(raw)
    return np.c_[values, np.ones(len(values))] if values.shape[1] == 3 else values


def _fractions(raw: Any) -> Array:
    """Numbers, where those of unsigned integers are shares of the largest."""
    values = np.asarray(raw)
    scale = float(np.iinfo(values.dtype).max) if values.dtype.kind == "u" else 1.0
    fractions: Array = values.astype(np.float64) / scale
    return fractions


def _join(scene: Any) -> FileContent:
    """The meshes of a scene, transformed by its nodes. (trimesh itself would merge their pictures and change uv.)"""
    parts = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not hasattr(mesh, "faces"):  # points and lines
            continue
        part = _read(mesh.vertices, mesh.faces, getattr(mesh.visual, "uv", None), _second(mesh), _colors(mesh))
        faces = part.faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0.0 else part.faces
        normals = moved_normals(_own_normals(mesh), matrix)
        vertices = part.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        parts.append(part._replace(vertices=vertices, faces=faces, normals=normals))
    if not parts:
        return _read((), (), None)
    starts = np.cumsum([0] + [len(part.vertices) for part in parts])
    white = [np.ones((len(part.vertices), 4)) if part.color is None else part.color for part in parts]
    unknown = [np.zeros((len(part.vertices), 3)) if part.normals is None else part.normals for part in parts]
    return FileContent(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]),
        _of_all([part.uv for part in parts]),
        _of_all([part.uv2 for part in parts]),
        np.concatenate(white) if any(part.color is not None for part in parts) else None,
        np.concatenate(unknown) if any(part.normals is not None for part in parts) else None,
    )


def moved_normals(normals: Array | None, matrix: Array) -> Array | None:
    """Normals (v, 3) after the transform of their body; they keep their side where it mirrors. None stays None."""
    if normals is None:
        return None
    volume = np.linalg.det(matrix[:3, :3])
    if volume == 0.0:
        return np.zeros_like(normals)
    moved: Array = normals @ np.linalg.inv(matrix[:3, :3])
    return moved


def _of_all(parts: list[Array | None]) -> Array | None:
    """The values of all parts, or None where one has none."""
    given = [part for part in parts if part is not None]
    return np.concatenate(given) if len(given) == len(parts) else None
