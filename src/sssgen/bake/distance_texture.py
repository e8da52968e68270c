"""Distance textures of meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.bake import memory_check as memory
from sssgen.bake.bake_facts import DistanceError, DistanceFacts
from sssgen.bake.distance_encoding import ENCODINGS, encode, error_at_texels
from sssgen.bake.mesh_facts import solid_facts
from sssgen.bake.voxel_distance import BLOCK, distances, inside
from sssgen.bake.voxel_grid import Array, Grid, around
from sssgen.scene.mesh import Mesh
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.support.progress import Progress
from sssgen.targets.texture_import import import_settings

SHEET = 1e-5
"""A mesh whose thickness is below this share of its size is a sheet, without an inside."""
POINT_BYTES = 200
"""Bytes of memory for each point of a query."""
TRIANGLE_BYTES = 800
"""Bytes of memory for each triangle in the trees."""


class Volume(NamedTuple):
    """A baked distance texture."""

    texels: npt.NDArray[Any]
    """(z, y, x), as stored"""
    grid: Grid
    reach: float
    """The distance of the largest stored number"""
    facts: DistanceFacts
    """For the JSON file"""


def sdf(
    path: str,
    resolution: Sequence[int] = (64,),
    padding: float = 0.05,
    encoding: str = "r16",
    reach: float | None = None,
    thin: float | None = None,
    progress: Progress = lambda *_: None,
) -> Volume:
    """The signed distance to a mesh, in its own space and units, negative inside.

    `resolution`, `padding`: see `voxel_grid.around`. `reach`: the largest stored distance; by default the largest that
    occurs. `thin`: treats the mesh as a sheet of this thickness, which has no inside. Raises SssgenError for a mesh
    without an inside, and for a grid that does not fit into memory.
    """
    if encoding not in ENCODINGS:
        hint = did_you_mean(encoding, ENCODINGS) or f"one of: {', '.join(ENCODINGS)}"
        raise failure(f"unknown encoding '{encoding}'", hint)
    mesh, form = Mesh(path=path), ENCODINGS[encoding]
    low, high = mesh.bounds()
    for name, value in (("range", reach), ("thin", thin)):
        if value is not None and not 1e-9 < value < 1e9:
            raise failure(f"--{name} {value:g} is not a length", "units of the mesh, more than 0")
    places = mesh.triangles.places
    if thin is None and _is_flat(places):
        hint = "give it a thickness with --thin, in units of the mesh"
        raise failure("the mesh is a flat sheet: it has no inside", hint, posix(path))
    extra = 0.5 * (thin or 0.0)
    grid = around(low - extra, high + extra, resolution, padding)
    across, up, deep = grid.counts
    size = np.dtype(form.dtype).itemsize
    needed = (
        across * up * deep * (4 + 2 + 2 * size)
        + max(4 * BLOCK, across * up) * POINT_BYTES
        + len(mesh.triangles.corners) * TRIANGLE_BYTES
    )
    memory.check(needed, "use a lower --resolution")
    solid = mesh.solid
    unsigned = distances(solid, grid, progress)
    if thin is None:
        within = inside(solid, grid, unsigned)
    else:
        within = unsigned < extra
        unsigned = np.abs(unsigned - np.float32(extra))
    if not within.any():
        _without_inside(path, solid.rim > 0.0, thin, grid)
    reach = float(unsigned.max()) if reach is None else reach
    texels = encode(unsigned, within, reach, form)
    error: DistanceError = {
        "at_texels": error_at_texels(reach, form, grid.diagonal),
        "between_texels": 0.5 * float(np.linalg.norm(grid.voxel)),
    }
    if solid.rim and thin is None:
        error["but"] = "not across its holes, where the sign jumps"
    facts: DistanceFacts = {
        "kind": "distance", "holds": None,
        "mesh": solid_facts(mesh),
        "texels": list(grid.counts), "voxel": _floats(grid.voxel),
        "box_min": _floats(grid.low), "box_max": _floats(grid.high),
        "encoding": encoding, "formula": "distance = (2 texel - 1) * range, texel from 0 to 1",
        "range": reach, "beyond_range": round(float((unsigned > reach).mean()), 6),
        "sign": f"negative within {thin:g} / 2 of the sheet" if thin else
                "negative where the generalised winding number is more than 0.5",
        "error": error,
        "inside": round(float(within.mean()), 6),
        "parameters": {"box_min": _floats(grid.low), "box_max": _floats(grid.high), "distance_range": reach},
        "import": import_settings("3D", "clamp", mipmaps=False),
    }  # fmt: skip
    return Volume(texels, grid, reach, facts)


def _is_flat(places: Array) -> bool:
    """Whether all vertices lie in a plane."""
    spread = np.linalg.svd(np.cov((places - places.mean(axis=0)).T), compute_uv=False)
    return bool(np.sqrt(spread[-1]) <= SHEET * np.sqrt(spread[0]))


def _without_inside(path: str, is_open: bool, thin: float | None, grid: Grid) -> None:
    voxel = float(grid.voxel.max())
    if is_open and thin is None:
        hint = "give a sheet a thickness with --thin; close the holes of a body, or raise --resolution for thin walls"
        raise failure(f"no voxel of {voxel:.3g} units lies inside the mesh, which is open", hint, posix(path))
    hint = f"raise --resolution (a voxel is {voxel:.3g} units), or treat its walls as a sheet with --thin"
    raise failure("no voxel lies inside the mesh: its walls are thinner than a voxel", hint, posix(path))


def _floats(vector: Array) -> list[float]:
    return [float(value) for value in vector]
