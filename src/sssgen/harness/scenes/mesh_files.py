"""Reads triangles from mesh files, with trimesh."""

from __future__ import annotations

import os
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.harness.scenes.placed import Array
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.extras import need
from sssgen.support.paths import posix

Indices: TypeAlias = npt.NDArray[np.int64]

SUFFIXES = (".obj", ".ply", ".stl", ".glb", ".gltf")


class FileContent(NamedTuple):
    """The content of a file, unchecked."""

    vertices: Array
    """(v, 3)"""
    faces: Indices
    """(f, 3) indices of vertices"""
    uv: Array | None
    """(v, 2), v up, or None where a part of the file has none"""


def check_suffix(path: str) -> None:
    """Raises SssgenError for a path without the suffix of a mesh file."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in SUFFIXES:
        hint = did_you_mean(suffix, SUFFIXES) or f"meshes end in {', '.join(SUFFIXES)}"
        raise failure(f"'{suffix}' is not a mesh file's suffix", hint, posix(path))


def read(path: str) -> FileContent:
    """All triangles of a file, with the transforms of its parts. Raises SssgenError for a missing or faulty file."""
    check_suffix(path)
    if not os.path.isfile(path):
        raise failure("cannot find the mesh", "", posix(path))
    trimesh = need("trimesh")
    kind = os.path.splitext(path)[1].lower()
    try:
        if kind in (".glb", ".gltf"):  # texture coordinates are loaded with the materials
            return _joined(trimesh.load_scene(path, process=False))
        loaded = trimesh.load_mesh(path, process=False, skip_materials=True)
        return _read(loaded.vertices, loaded.faces, getattr(loaded.visual, "uv", None))
    except Exception as error:  # its readers raise exceptions of any type for a faulty file
        # for bytes that are not text it tries to import a package that guesses encodings
        hint = "" if isinstance(error, ImportError) else f"the reader reports: {type(error).__name__}: {error}"
        raise failure(f"the mesh cannot be read: it is not a valid {kind} file", hint, posix(path)) from None


def _read(vertices: Any, faces: Any, uv: Any) -> FileContent:
    return FileContent(
        np.asarray(vertices, np.float64).reshape(-1, 3),
        np.asarray(faces, np.int64).reshape(-1, 3),
        None if uv is None else np.asarray(uv, np.float64),
    )


def _joined(scene: Any) -> FileContent:
    """The meshes of a scene, transformed by its nodes. (trimesh itself would merge their pictures and change uv.)"""
    parts = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not hasattr(mesh, "faces"):  # points and lines
            continue
        part = _read(mesh.vertices, mesh.faces, getattr(mesh.visual, "uv", None))
        faces = part.faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0.0 else part.faces
        parts.append(FileContent(part.vertices @ matrix[:3, :3].T + matrix[:3, 3], faces, part.uv))
    if not parts:
        return _read((), (), None)
    starts = np.cumsum([0] + [len(part.vertices) for part in parts])
    uv = [part.uv for part in parts if part.uv is not None]
    return FileContent(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]),
        np.concatenate(uv) if len(uv) == len(parts) else None,
    )
