"""The response of a scene's body to light from anywhere: scattered light as few products, and the light that is not
scattered for each direction."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.fluence import fluence_field
from sssgen.lab.fluence.factors import factors
from sssgen.lab.fluence.fluence_field import Field, Settings
from sssgen.lab.fluence.traced_body import medium_of
from sssgen.scene import octahedron
from sssgen.scene.light_response import UNSCATTERED, LightResponse, harmonics
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure

Array = npt.NDArray[np.float64]

SIDE = 14
"""The directions along each side of the map of light that is not scattered."""
GROUP = 14
"""Of these, the directions of one work item."""
FLOOR = 0.1
"""The value, relative to the 99th percentile of all light, below which errors of scattered light count as at this."""


def items(scene: MeasuredScene, settings: Settings) -> list[Item]:
    """The work items of `response`."""
    return [*fluence_field.items(scene, octahedron.directions(settings.side), settings), *_shares(scene, settings)]


def response(
    scene: MeasuredScene, rank: int, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> tuple[LightResponse, Field]:  # fmt: skip
    """The response with `rank` numbers a voxel, and the field that it is made of. Raises SssgenError."""
    traced = fluence_field.field(scene, settings, scheduler, processes, progress)
    results = run(_shares(scene, settings), scheduler, processes, progress=progress)
    for result in results:
        if isinstance(result, Failure):
            raise failure(f"{result.name}: {result.message}", result.hint)
    passing = np.concatenate(results).astype(np.float64) if results else np.zeros((0, len(traced.cells)))
    return pack(scene, traced, np.maximum(passing, 0.0), rank), traced


def _shares(scene: MeasuredScene, settings: Settings) -> list[Item]:
    """Those of light that is not scattered; none where the field has it."""
    if fluence_field.has_all_light(scene, settings):
        return []
    directions = [(float(x), float(y), float(z)) for x, y, z in octahedron.directions(SIDE)]
    groups = [tuple(directions[first : first + GROUP]) for first in range(0, len(directions), GROUP)]
    function = "sssgen.lab.fluence.unscattered:trace_shares"
    arguments = [(scene, group, _mean_extinction(scene), settings.voxels) for group in groups]
    return [Item(function, each, f"light that enters {scene.name}") for each in arguments]


def _mean_extinction(scene: MeasuredScene) -> float:
    return float(np.mean([medium_of(scene, channel).extinction for channel in range(3)]))


def pack(scene: MeasuredScene, traced: Field, passing: Array, rank: int) -> LightResponse:
    """The stored numbers; `passing` (directions, voxels) is the share that arrives at the mean extinction."""
    channels, count, voxels = traced.values.shape
    powers = np.array([medium_of(scene, channel).extinction for channel in range(3)]) / _mean_extinction(scene)
    unscattered = _unscattered(traced.directions, passing, powers)
    columns = traced.values.reshape(channels * count, voxels).T
    # errors count relative to all light
    whole = (traced.smooth + unscattered).reshape(channels * count, voxels).T
    latents, rows = factors(columns, rank, FLOOR * float(np.percentile(whole, 99.0)), whole)
    low, high = latents.min(axis=0), latents.max(axis=0)
    size = np.maximum(high - low, 1e-12)
    # the ranges of the latents belong to the table
    table = np.concatenate([(low @ rows)[None], size[:, None] * rows]).reshape(-1, channels, count)
    root = np.sqrt(passing)
    highest = max(float(root.max(initial=0.0)), 1e-12)
    around = _around(traced, unscattered)
    largest = np.maximum(np.abs(around).max(axis=2), 1e-12)
    number = np.uint16 if traced.grid.voxels < 1 << 16 else np.uint32
    return LightResponse(
        traced.grid.low, traced.grid.high, traced.cells.astype(number),
        traced.nearest.reshape(traced.grid.shape[::-1]).astype(number),
        np.rint(255.0 * (latents - low) / size).astype(np.uint8).T, np.moveaxis(table, 2, 0).astype(np.float16),
        np.rint(root * (255.0 / highest)).astype(np.uint8), highest, powers,
        np.rint(127.0 * around / largest[..., None]).astype(np.int8), largest,
    )  # fmt: skip


def _unscattered(directions: Array, passing: Array, powers: Array) -> Array:
    """Light that is not scattered for other directions, (3, directions, voxels)."""
    if not len(passing):
        return np.zeros((3, 1, 1))
    texels, weights = octahedron.mix(directions, octahedron.side_of(passing))
    shares = np.einsum("dt,dtv->dv", weights, passing[texels])
    result: Array = UNSCATTERED * shares[None] ** powers[:, None, None]
    return result


def _around(traced: Field, unscattered: Array) -> Array:
    """The integrals of the response times the harmonics, (9, 3, voxels)."""
    angles = octahedron.solid_angles(octahedron.side_of(traced.directions))
    weights = harmonics(traced.directions) * angles[:, None]
    result: Array = np.einsum("dk,cdv->kcv", weights, traced.values + unscattered)
    return result
