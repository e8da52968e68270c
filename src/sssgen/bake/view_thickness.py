"""Directional maps: the length inside a body along every ray of an eye, nine numbers for each texel.

The numbers are those of `sssgen.lab.reference.view_harmonics`, in three pictures. Each number has its own range over
the map, so that 8 bits are enough.
"""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np

from sssgen.bake import memory_check as memory
from sssgen.bake.atlas import atlas, fill_map
from sssgen.bake.bake_facts import ViewThicknessFacts
from sssgen.bake.mesh_facts import surface_facts
from sssgen.bake.texture_unwrap import obj, unwrap_mesh
from sssgen.bake.voxel_grid import Array
from sssgen.jobs.executor import Item, Progress, failures, run
from sssgen.jobs.result_store import Store
from sssgen.lab.reference import view_harmonics
from sssgen.material.baked import ParameterValue, mesh_key
from sssgen.scene import body_identity
from sssgen.scene.measured import measured_scene, media
from sssgen.scene.measured.media import Medium
from sssgen.scene.mesh import Mesh
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.targets.texture_import import import_settings

IMAGES = 3
"""Pictures with three of the numbers each."""
BITS = 8
TEXTURE = "view_harmonics"
"""The textures in the technique are called this, with the number of the picture."""
NO_INSIDE = 0.99
"""The share of lost rays above which a mesh has no inside: rays in the plane of a sheet may hit it."""
BLOCK_RAYS = 2**18
"""Rays in a block of work, which takes a few hundred megabytes."""


class Map(NamedTuple):
    """A baked map."""

    pictures: list[Array]
    """(height, width, 3) each, row 0 at the top: 0..1, as stored"""
    facts: ViewThicknessFacts
    """For the JSON files"""
    mesh: str
    """The mesh as a Wavefront file if it has new texture coordinates, otherwise empty"""


def body(path: str, mean_free_path: float | None, medium: str, unit_mm: float) -> tuple[Mesh, float]:
    """The mesh of a file or a scene, and the mean free path of its medium in units of the mesh. Raises SssgenError."""
    if path.endswith(".toml"):
        if medium or mean_free_path is not None:
            raise failure("the scene has its own medium", "leave --medium and --mean-free-path out", posix(path))
        scene = measured_scene.load(path)
        if not isinstance(scene.geometry, Mesh):
            shape = body_identity.name(scene.geometry)
            hint = "a map needs a mesh; back_face_thickness and march_view need no map"
            raise failure(f"the scene's body is not a mesh but a {shape}", hint, posix(path))
        if scene.medium is None:
            raise failure("the scene has no medium", "add [medium]", posix(path))
        return scene.geometry, _mean_free_path(scene.medium) / scene.geometry.scale
    if mean_free_path is not None:
        if medium:
            raise failure("the medium has its own mean free path", "leave --medium or --mean-free-path out")
        return Mesh(path=path), mean_free_path
    if not medium:
        hint = "give --mean-free-path M in units of the mesh, or name a --medium"
        raise failure("a mesh has no medium", hint, posix(path))
    return Mesh(path=path), _mean_free_path(media.preset(medium, unit_mm))


def _mean_free_path(medium: Medium) -> float:
    return 3.0 / max(sum(medium.extinction), 3.0 * media.CLEAR)


def bake(
    body: Mesh, size: tuple[int, int], mean_free_path: float, rays: int = view_harmonics.RAYS, unwrap: bool = False,
    processes: int | None = None, scheduler: str = "", progress: Progress = lambda *_: None,
) -> Map:  # fmt: skip
    """The map of a mesh, in its own space; `mean_free_path` is in units of the mesh.

    Raises SssgenError for a mesh that cannot be read, without an inside, or with unsuitable texture coordinates.
    """
    if not 0.0 < mean_free_path < 1e9:
        raise failure(f"{mean_free_path:g} is not a mean free path", "a length above 0, in units of the mesh")
    if not 16 <= rays <= 65536:
        raise failure(f"{rays} is not a number of rays", "from 16 to 65536: nine numbers are fitted to them")
    width, height = size
    memory.check(width * height * 400.0 + 4 * BLOCK_RAYS * 700.0, "use a smaller --size")
    body = Mesh(path=body.path)
    mesh = body.triangles
    new_uv = unwrap or mesh.uv is None
    uv = unwrap_mesh(mesh, progress) if new_uv or mesh.uv is None else mesh.uv
    surface = atlas(mesh, uv, size, body.path)
    normals = -surface.flat if body.inside_out else surface.flat
    length = view_harmonics.fade_length(body, mean_free_path)
    fit = _fit(body.path, surface.places, normals, length, rays, processes, scheduler, progress)
    if fit.lost.mean() > NO_INSIDE:
        raise failure("no ray enters the mesh: it has no inside", "a flat sheet has no thickness", posix(body.path))
    lowest, highest = fit.coefficients.min(axis=0), fit.coefficients.max(axis=0)
    span = np.maximum(highest - lowest, 1e-6)
    text = obj(body, uv) if new_uv else ""
    identity = body_identity.identity(body, scaled=False)
    if text:  # the map belongs to the mesh that is written with it
        identity["key"] = mesh_key(text.encode())
    parameters: dict[str, ParameterValue] = {"fade_length": length}
    for number in range(IMAGES):
        part = slice(3 * number, 3 * number + 3)
        parameters[f"harmonics_lowest_{number + 1}"] = lowest[part].tolist()
        parameters[f"harmonics_span_{number + 1}"] = span[part].tolist()
    facts: ViewThicknessFacts = {
        "kind": "view_thickness", "holds": None,
        "body": identity,
        "mesh": surface_facts(body, new_uv, surface.shared),
        "mean_free_path": mean_free_path, "unit": "of the mesh",
        "formula": "length = -fade_length ln(1 - f), f = sum of (lowest + span texel) times the harmonics of the "
        "eye's ray in object space",
        "texels": len(fit.error), "rays": rays, "lost_rays": round(float(fit.lost.mean()), 6),
        "error": {
            "mean_of_fit": float(np.sqrt((fit.error**2).mean())), "largest_of_fit": float(fit.error.max()),
            "rounding": _rounding(span, normals), "relative_to": "f, which is 0 to 1",
        },
        "parameters": parameters,
        "import": import_settings(),
    }  # fmt: skip
    stored = fill_map((fit.coefficients - lowest) / span, surface.texels, size)
    return Map([stored[..., 3 * number : 3 * number + 3] for number in range(IMAGES)], facts, text)


def _rounding(span: Array, normals: Array) -> float:
    """The root of the mean square of f's error by texels of BITS bits, over inward directions of some texels."""
    some = normals[:: max(1, len(normals) // 256)]
    squares = (view_harmonics.harmonics(view_harmonics.inward(some, 64)) ** 2).mean(axis=(0, 1))
    steps = span / (2**BITS - 1)
    return float(np.sqrt((squares * steps**2).sum() / 12.0))


def _fit(
    path: str, places: Array, normals: Array, fade_length: float, rays: int, processes: int | None, scheduler: str,
    progress: Progress,
) -> view_harmonics.Fit:  # fmt: skip
    """The fit of all texels, in blocks."""
    with open(path, "rb") as file:
        digest = cache.digest(file.read())
    block = max(1, BLOCK_RAYS // rays)
    items = [
        Item(
            "sssgen.bake.chord_lengths:directional",
            (os.path.abspath(path), digest, places[start : start + block], normals[start : start + block], fade_length,
             rays),
            f"{min(start + block, len(places))} texels",
        )
        for start in range(0, len(places), block)
    ]  # fmt: skip
    results = run(items, scheduler, processes, Store(""), progress)
    if failed := failures(results):
        raise failure(f"a part of the map failed: {failed[0].message}", failed[0].hint, file=posix(path))
    return view_harmonics.Fit(*(np.concatenate(parts) for parts in zip(*results, strict=True)))
