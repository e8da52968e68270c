"""New texture coordinates for meshes, by xatlas."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.bake.atlas import Indices
from sssgen.bake.voxel_grid import Array
from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.jobs.result_store import Store
from sssgen.scene.mesh import Mesh, Triangles
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

PADDING = 4
"""Texels between charts, on a map of RESOLUTION."""
RESOLUTION = 1024


def unwrap_mesh(mesh: Triangles, progress: Progress = lambda *_: None) -> Array:
    """New texture coordinates, (f, 3, 2), in 0..1, without overlaps.

    xatlas crashes on some valid meshes, so it runs in its own process. If it fails on the mesh, the mesh is split
    into six parts, by the axis that a triangle faces most. Raises SssgenError if that fails too, and without xatlas.
    """
    need("xatlas", extra="bake")
    low, high = mesh.places.min(axis=0), mesh.places.max(axis=0)
    places = ((mesh.places - low) / float((high - low).max())).astype(np.float32)  # xatlas uses 32-bit floats
    axis = np.abs(mesh.flat).argmax(axis=1)
    facing = 2 * axis + (mesh.flat[np.arange(len(axis)), axis] < 0.0)
    result: Any = None
    for parts in (np.zeros(len(axis), np.int64), facing):
        progress(0, 1, f"texture coordinates of {len(axis)} triangles")
        item = Item("sssgen.bake.texture_unwrap:charts", (places, mesh.corners, parts), "texture coordinates")
        (result,) = run([item], processes=1, store=Store(""), progress=progress)
        if not isinstance(result, Failure):
            return np.asarray(result, np.float64)
    hint = "add texture coordinates to the mesh in a modelling program"
    raise failure(f"xatlas finds no texture coordinates for this mesh: {result.message}", hint)


def charts(places: npt.NDArray[np.float32], corners: Indices, parts: Indices) -> npt.NDArray[np.float32]:
    """The texture coordinates (f, 3, 2) of triangles; each of the parts, (f,), is laid out separately."""
    xatlas = need("xatlas", extra="bake")
    atlas = xatlas.Atlas()
    faces = [np.flatnonzero(parts == part) for part in np.unique(parts)]
    for part_faces in faces:
        used, indices = np.unique(corners[part_faces], return_inverse=True)
        atlas.add_mesh(places[used], indices.reshape(-1, 3).astype(np.uint32))
    pack = xatlas.PackOptions()
    pack.padding, pack.bilinear, pack.resolution = PADDING, True, RESOLUTION
    atlas.generate(xatlas.ChartOptions(), pack)
    result = np.zeros((len(corners), 3, 2), np.float32)
    for number, part_faces in enumerate(faces):
        _, indices, uv = atlas[number]
        result[part_faces] = uv[indices.astype(np.int64)]
    return result


def obj(body: Mesh, uv: Array) -> str:
    """The mesh as a Wavefront file with these texture coordinates, its triangles as the bake takes them: outwards."""
    mesh, order = body.triangles, -1 if body.inside_out else 1
    coordinates, index = np.unique(uv.reshape(-1, 2), axis=0, return_inverse=True)
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in mesh.places]
    lines += [f"vt {u:.9g} {v:.9g}" for u, v in coordinates]
    for face, uv_face in zip(mesh.corners + 1, index.reshape(-1, 3) + 1, strict=True):
        corners = [f"{vertex}/{texture}" for vertex, texture in zip(face, uv_face, strict=True)]
        lines.append("f " + " ".join(corners[::order]))
    return "\n".join(lines) + "\n"
