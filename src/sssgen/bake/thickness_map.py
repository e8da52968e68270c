"""Thickness maps: the exact length of a body below each texel of its texture coordinates."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np

from sssgen.bake import memory_check as memory
from sssgen.bake.atlas import SHARED, Atlas, atlas, filled
from sssgen.bake.bake_light import BakeLight
from sssgen.bake.texture_unwrap import obj, unwrapped
from sssgen.bake.voxel_grid import Array
from sssgen.harness.scenes.mesh import Mesh
from sssgen.harness.scenes.mesh_distance import MIXED, mixed_sides
from sssgen.lab.jobs.executor import Item, Progress, failures, run
from sssgen.lab.jobs.result_store import Store
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.targets.texture_import import import_settings

RAYS = 2**18
"""In a block of work: some hundred megabytes."""


class Request(NamedTuple):
    """What a thickness map is to hold."""

    mode: str = "mean"
    """mean: over inward directions; chord: the length along −N; transmittance: the share of light that passes"""
    light: BakeLight | None = None
    """If given, the map has the length towards this light"""
    rays: int = 256
    """Rays per texel; even"""
    attenuation: float = 0.0
    """For the mode transmittance: the length after which 1 / e of the light remains"""
    seed: int = 0


class Map(NamedTuple):
    """A baked thickness map."""

    values: Array
    """(height, width), row 0 at the top: 0..1, as stored"""
    facts: dict[str, Any]
    """For the JSON file"""
    mesh: str
    """The mesh as a Wavefront file if it got new texture coordinates, otherwise empty"""


def thickness_map(
    path: str,
    size: tuple[int, int],
    wanted: Request,
    unwrap: bool = False,
    processes: int | None = None,
    scheduler: str = "",
    progress: Progress = lambda *_: None,
) -> Map:
    """The map of a mesh: lengths relative to the largest one, or transmittance.

    Raises SssgenError for a mesh that cannot be read, without an inside, or with unfit texture coordinates.
    """
    _check(wanted)
    width, height = size
    memory.check(width * height * 120.0 + 4 * RAYS * 500.0, "take a smaller --size")
    body = Mesh(path=path)
    mesh = body.triangles
    fresh = unwrap or mesh.uv is None
    uv = unwrapped(mesh, progress) if fresh or mesh.uv is None else mesh.uv
    shown = atlas(mesh, uv, size, path)
    if body.inside_out:
        shown = shown._replace(flat=-shown.flat)
    chords = [
        np.concatenate(parts)
        for parts in zip(*_measured(path, shown, wanted, processes, scheduler, progress), strict=True)
    ]
    value, error, lost = chords
    if lost.min(initial=0.0) >= 1.0 or not value.any():
        raise failure("no ray leaves the mesh: it has no inside", "is it a sheet?", posix(path))
    passing = wanted.mode == "transmittance"
    top = 1.0 if passing else float(value.max())
    holds = "transmittance" if passing else "thickness"
    facts = {
        "kind": holds, "holds": holds, "mode": "direction" if wanted.light else wanted.mode,
        "mesh": {
            "triangles": len(mesh.corners), "new_uv": fresh, "inside_out": body.inside_out,
            "shared_texels": round(shown.shared, 6), "mixed_sides": mixed_sides(mesh.corners),
        },
        "light": wanted.light.facts() if wanted.light else None,
        "unit": "" if passing else "of the mesh", "range": [0.0, top],
        "formula": "transmittance = texel" if passing else f"thickness = {top!r} * texel",
        "texels": len(value), "mean": float(value.mean()),
        "error": {
            "mean_standard_error": float(error.mean()), "largest_standard_error": float(error.max()),
        },
        "rays": 1 if _is_exact(wanted) else wanted.rays, "lost_rays": round(float(lost.mean()), 6),
        "attenuation_distance": wanted.attenuation or None,
        "parameters": {} if passing else {"thickness_factor": top},
        "import": import_settings(),
    }  # fmt: skip
    return Map(filled(value / top, shown.texels, size), facts, obj(mesh, uv) if fresh else "")


def warnings(facts: dict[str, Any]) -> list[str]:
    """Warnings about a map for the user."""
    messages = ["the mesh is inside out: its normals are reversed for the bake"] if facts["mesh"]["inside_out"] else []
    if (shared := facts["mesh"]["shared_texels"]) > SHARED and not facts["mesh"]["new_uv"]:
        messages.append(
            f"{shared:.0%} of the texels have several surface points: --unwrap makes new texture coordinates"
        )
    if facts["mesh"]["mixed_sides"]:
        messages.append(MIXED)
    if (lost := facts["lost_rays"]) > 0.001:
        messages.append(f"{lost:.1%} of the rays left through holes of the mesh and are excluded")
    return messages


def _is_exact(wanted: Request) -> bool:
    return wanted.light is not None or wanted.mode == "chord"


def _check(wanted: Request) -> None:
    if wanted.mode == "transmittance" and not 0.0 < wanted.attenuation < 1e9:
        raise failure(
            "--mode transmittance needs a length",
            "--attenuation D: the length after which 1/e of the light remains, as 0.1",
        )
    if wanted.mode != "transmittance" and wanted.attenuation:
        raise failure(f"--mode {wanted.mode} is a length: it has no attenuation", "take --mode transmittance")
    if not (2 <= wanted.rays <= 65536 and wanted.rays % 2 == 0):
        raise failure(f"{wanted.rays} is no number of rays", "an even number from 2 to 65536")
    if not 0 <= wanted.seed < 2**32:
        raise failure(f"{wanted.seed} is no seed", "from 0 to 4294967295")


def _measured(
    path: str, shown: Atlas, wanted: Request, processes: int | None, scheduler: str, progress: Progress
) -> list[Any]:
    """The chords of each block of texels, in order."""
    with open(path, "rb") as file:
        digest = cache.digest(file.read())
    path, items = os.path.abspath(path), list[Item]()
    exact = _is_exact(wanted)
    block = max(1, RAYS // (1 if exact else wanted.rays))
    for number, start in enumerate(range(0, len(shown.texels), block)):
        places, flat = shown.places[start : start + block], shown.flat[start : start + block]
        name = f"{min(start + block, len(shown.texels))} texels"
        if exact:
            ways = wanted.light.towards(places) if wanted.light else -flat
            items.append(
                Item("sssgen.bake.chord_lengths:along", (path, digest, places, ways, wanted.attenuation), name)
            )
        else:
            sampling = (wanted.rays, wanted.attenuation, (wanted.seed, number))
            items.append(Item("sssgen.bake.chord_lengths:inward", (path, digest, places, flat, *sampling), name))
    results = run(items, scheduler, processes, Store(""), progress)
    if wrong := failures(results):
        raise failure(f"a part of the map failed: {wrong[0].message}", file=posix(path))
    return results
