"""The response of a scene's body to light from anywhere: scattered light as few products, and the light that is not
scattered for each direction."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from sssgen.jobs.executor import Progress
from sssgen.lab.fluence import fluence_field
from sssgen.lab.fluence.factors import factors
from sssgen.lab.fluence.fluence_field import Field, Settings
from sssgen.lab.fluence.fluence_volumes import stored_distance
from sssgen.lab.fluence.traced_body import medium_of
from sssgen.scene import octahedron
from sssgen.scene.light_response import LightResponse, harmonics
from sssgen.scene.measured.measured_scene import MeasuredScene

Array = npt.NDArray[np.float64]

FLOOR = 0.1
"""The value, relative to the 99th percentile of all light, below which errors of scattered light count as at this."""
LEVELS = 15
"""The steps of the root of light that has not been scattered: its volume interpolates them between voxels and
directions, and 255 have the same error, but are much longer in a file."""


def response(
    scene: MeasuredScene, rank: int, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> tuple[LightResponse, Field]:  # fmt: skip
    """The response with `rank` numbers a voxel, and the field that it is made of. Raises SssgenError."""
    traced = fluence_field.field(scene, settings, scheduler, processes, progress)
    return pack(scene, traced, rank), traced


def packed(scene: MeasuredScene, rank: int, settings: Settings) -> LightResponse:
    """`response` as a work item, whose field is in the store. Raises SssgenError."""
    return response(scene, rank, settings, processes=0)[0]


def pack(scene: MeasuredScene, traced: Field, rank: int) -> LightResponse:
    """The numbers of a field as they are stored."""
    channels, count, voxels = traced.values.shape
    extinctions = np.array([medium_of(scene, channel).extinction for channel in range(3)])
    # the channel whose share of light that is not scattered stands for the others
    base = int(np.argsort(extinctions)[1])
    columns = traced.values.reshape(channels * count, voxels).T
    # errors count relative to all light
    whole = (traced.smooth + traced.whole - traced.values).reshape(channels * count, voxels).T
    latents, rows = factors(columns, rank, FLOOR * float(np.percentile(whole, 99.0)), whole)
    low, high = latents.min(axis=0), latents.max(axis=0)
    size = np.maximum(high - low, 1e-12)
    # the ranges of the latents belong to the table
    table = np.concatenate([(low @ rows)[None], size[:, None] * rows]).reshape(-1, channels, count)
    root = np.sqrt(np.maximum(traced.shares[base].astype(np.float64), 0.0))
    highest = max(float(root.max(initial=0.0)), 1e-12)
    around = _around(traced)
    largest = np.maximum(np.abs(around).max(axis=2), 1e-12)
    number = np.uint16 if traced.grid.voxels < 1 << 16 else np.uint32
    levels = np.rint(root * (LEVELS / highest)) * (255 // LEVELS)
    return LightResponse(
        traced.grid.low, traced.grid.high, traced.cells.astype(number),
        traced.nearest.reshape(traced.grid.shape[::-1]).astype(number),
        np.rint(255.0 * (latents - low) / size).astype(np.uint8).T, np.moveaxis(table, 2, 0).astype(np.float16),
        levels.astype(np.uint8).T, highest, extinctions / extinctions[base],
        np.rint(127.0 * around / largest[..., None]).astype(np.int8), largest,
        stored_distance(traced).reshape(traced.grid.shape[::-1]),
    )  # fmt: skip


def _around(traced: Field) -> Array:
    """The integrals of the response times the harmonics, (9, 3, voxels)."""
    angles = octahedron.solid_angles(octahedron.side_of(traced.directions))
    weights = harmonics(traced.directions) * angles[:, None]
    result: Array = np.einsum("dk,cdv->kcv", weights, traced.whole)
    return result
