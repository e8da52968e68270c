"""Thickness maps: the exact length of a body below each texel of its texture coordinates."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np

from sssgen.bake import memory_check as memory
from sssgen.bake.atlas import SHARED, Atlas, atlas, fill_map
from sssgen.bake.bake_facts import SurfaceMapFacts, ThicknessFacts
from sssgen.bake.bake_light import BakeLight
from sssgen.bake.chord_lengths import Chords
from sssgen.bake.mean_length import in_halves
from sssgen.bake.mesh_facts import side_warnings, surface_facts
from sssgen.bake.texture_unwrap import obj, unwrap_mesh
from sssgen.bake.voxel_grid import Array
from sssgen.jobs.executor import Item, Progress, failures, run
from sssgen.jobs.result_store import Store
from sssgen.scene.mesh import Mesh
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.targets.texture_import import import_settings

RAYS = 2**18
"""Rays in a block of work, which takes a few hundred megabytes."""
GROUP, GROUPS = 256, 16
"""The most texels in a group of near ones, whose integrals share work, and the groups in a block of work."""


class Request(NamedTuple):
    """The settings of a thickness map."""

    mode: str = "mean"
    """mean: over inward directions; chord: the length along −N; transmittance: the share of light that passes"""
    light: BakeLight | None = None
    """The map has the length towards this light; None for the mode"""
    rays: int = 256
    """Rays per texel; even"""
    attenuation: float = 0.0
    """For the mode transmittance: the length after which 1 / e of the light remains"""
    seed: int = 0


class Map(NamedTuple):
    """A baked thickness map."""

    values: Array
    """(height, width), row 0 at the top: 0..1, as stored"""
    facts: ThicknessFacts
    """For the JSON file"""
    mesh: str
    """The mesh as a Wavefront file if it has new texture coordinates, otherwise empty"""


def thickness_map(
    path: str,
    size: tuple[int, int],
    request: Request,
    unwrap: bool = False,
    processes: int | None = None,
    scheduler: str = "",
    progress: Progress = lambda *_: None,
) -> Map:
    """The map of a mesh: lengths relative to the largest one, or transmittance.

    Raises SssgenError for a mesh that cannot be read, without an inside, or with unsuitable texture coordinates.
    """
    _check(request)
    width, height = size
    memory.check(width * height * 120.0 + 4 * RAYS * 500.0, "use a smaller --size")
    body = Mesh(path=path)
    mesh = body.triangles
    new_uv = unwrap or mesh.uv is None
    uv = unwrap_mesh(mesh, progress) if new_uv or mesh.uv is None else mesh.uv
    surface = atlas(mesh, uv, size, path)
    if body.inside_out:
        surface = surface._replace(flat=-surface.flat)
    value, error, lost, rays = _measure_chords(body, surface, request, processes, scheduler, progress)
    if lost.min(initial=0.0) >= 1.0 or not value.any():
        raise failure("no ray leaves the mesh: it has no inside", "a flat sheet has no thickness", posix(path))
    is_transmittance = request.mode == "transmittance"
    largest = 1.0 if is_transmittance else float(value.max())
    holds = "transmittance" if is_transmittance else "thickness"
    facts: ThicknessFacts = {
        "kind": holds, "holds": holds, "mode": "direction" if request.light else request.mode,
        "mesh": surface_facts(body, new_uv, surface.shared),
        "light": request.light.facts() if request.light else None,
        "unit": "" if is_transmittance else "of the mesh", "range": [0.0, largest],
        "formula": "transmittance = texel" if is_transmittance else f"thickness = {largest!r} * texel",
        "texels": len(value), "mean": float(value.mean()),
        "error": {
            "mean_standard_error": float(error.mean()), "largest_standard_error": float(error.max()),
        },
        "rays": int(rays.max()), "by_rays": round(float((rays > 0.0).mean()), 6),
        "lost_rays": round(float(lost.mean()), 6),
        "attenuation_distance": request.attenuation or None,
        "parameters": {} if is_transmittance else {"thickness_factor": largest},
        "import": import_settings(),
    }  # fmt: skip
    return Map(fill_map(value / largest, surface.texels, size), facts, obj(body, uv) if new_uv else "")


def warnings(facts: SurfaceMapFacts) -> list[str]:
    """Warnings about a map for the user."""
    messages = side_warnings(facts["mesh"])
    if (shared := facts["mesh"]["shared_texels"]) > SHARED and not facts["mesh"]["new_uv"]:
        messages.append(
            f"{shared:.0%} of the texels have several surface points: --unwrap makes new texture coordinates"
        )
    if (lost := facts["lost_rays"]) > 0.001:
        messages.append(f"{lost:.1%} of the rays left through holes of the mesh and are excluded")
    return messages


def _is_exact(request: Request) -> bool:
    return request.light is not None or request.mode == "chord"


def _check(request: Request) -> None:
    if request.mode == "transmittance" and not 0.0 < request.attenuation < 1e9:
        raise failure(
            "--mode transmittance needs a length",
            "--attenuation D: the length after which 1/e of the light remains, as 0.1",
        )
    if request.mode != "transmittance" and request.attenuation:
        raise failure(f"--mode {request.mode} is a length: it has no attenuation", "use --mode transmittance")
    if not (2 <= request.rays <= 65536 and request.rays % 2 == 0):
        raise failure(f"{request.rays} is not a number of rays", "an even number from 2 to 65536")
    if not 0 <= request.seed < 2**32:
        raise failure(f"{request.seed} is not a seed", "from 0 to 4294967295")


def _measure_chords(
    body: Mesh, surface: Atlas, request: Request, processes: int | None, scheduler: str, progress: Progress
) -> Chords:
    """The chords of all texels, computed in blocks."""
    with open(body.path, "rb") as file:
        mesh = os.path.abspath(body.path), cache.digest(file.read())
    count, items = len(surface.texels), list[Item]()
    by_integral = request.mode == "mean" and request.light is None and body.closed
    if by_integral:
        groups = np.minimum(in_halves(surface.places, GROUP), count - 1)
        blocks = np.split(groups, range(GROUPS, len(groups), GROUPS))
    else:
        block = max(1, RAYS // (1 if _is_exact(request) else request.rays))
        blocks = np.split(np.arange(count), range(block, count, block))
    for number, texels in enumerate(blocks):
        points, flat = surface.places[texels], surface.flat[texels]
        arguments: tuple[Any, ...]
        if by_integral:
            function, arguments = "mean", (flat, request.rays, (request.seed, number * GROUPS))
        elif _is_exact(request):
            directions = request.light.towards(points) if request.light else -flat
            function, arguments = "along", (directions, request.attenuation)
        else:
            function, arguments = "inward", (flat, request.rays, request.attenuation, (request.seed, number))
        items.append(
            Item(f"sssgen.bake.chord_lengths:{function}", (*mesh, points, *arguments), f"{texels.size} texels")
        )
    results = run(items, scheduler, processes, Store(""), progress)
    if failed := failures(results):
        raise failure(f"a part of the map failed: {failed[0].message}", failed[0].hint, file=posix(body.path))
    order = np.argsort(np.concatenate([texels.ravel() for texels in blocks]), kind="stable")[:count]
    return Chords(*(np.concatenate(parts)[order] for parts in zip(*results, strict=True)))
