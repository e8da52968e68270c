"""The multiply scattered fluence of a measured scene's body, for many light directions: traced in parts, kept in the
store of results, so that an interrupted bake continues."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.fluence.traced_body import grid_in_box, medium_of, projection_of, tracer, walks_of
from sssgen.lab.fluence.unscattered import shares
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene import octahedron
from sssgen.scene.light_response import UNSCATTERED
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]

GROUP = 32
"""The directions of one work item."""
SHARED = 128
"""The walks in a channel, relative to the photons for each direction, where walks serve all directions."""
STARTS = 1 << 20
"""The points from which the walks of one work item start, times the directions: a length is computed for each."""
WALK_ITEMS = 4
"""The work items of the walks: their differences give the standard error."""


class Settings(NamedTuple):
    """How finely the fluence is traced."""

    voxels: int = 24
    """Along the longest side of the box"""
    side: int = 16
    """Light directions along each side of the octahedral map"""
    photons: int = 24000
    """For each direction and channel"""
    seed: int = 0
    fixed: bool = False
    """For one light: the field includes unscattered light, and the light has `side` times as many photons"""


class Field(NamedTuple):
    """π times the mean radiance inside, for an irradiance of 1 on a plane facing the light.

    Of light that is scattered at least once; of all light behind a refracting surface, or for a fixed light.
    """

    grid: Grid
    """In the body's object space"""
    values: Array
    """(3, directions, voxels), of voxels that count (see `cells`): texels for trilinear interpolation, which noise
    may make negative"""
    cells: npt.NDArray[np.int64]
    """(voxels,): the numbers of the voxels that count in the grid"""
    nearest: npt.NDArray[np.int64]
    """(voxels of the grid,): the counting voxel whose value each voxel has"""
    directions: Array
    """(directions, 3), towards the light, in object space"""
    noise: float
    """The standard error of a voxel's estimate, relative to the mean estimate"""
    smooth: Array
    """`values` averaged over neighbouring voxels"""
    distance: Array
    """(voxels of the grid,), from the surface to the voxels' centres, negative inside, in object space"""


Directions = tuple[tuple[float, float, float], ...]


def trace_photons(
    scene: MeasuredScene, channel: int, towards: Directions, voxels: int, photons: int, seed: int, unscattered: bool
) -> tuple[np.ndarray, float]:
    """The estimates (directions, voxels) of `Tracer.trace` for lights in the directions `towards` (object space), and
    their mean squared error."""
    medium = medium_of(scene, channel)
    first, second = (
        tracer(scene, voxels).trace(
            medium, np.array(towards), max(photons // 2, 1), np.random.default_rng([seed, channel, half]), unscattered
        )
        for half in range(2)
    )
    return (0.5 * (first + second)).astype(np.float32), float(np.mean((0.5 * (first - second)) ** 2))


def trace_walks(scene: MeasuredScene, part: int, towards: Directions, voxels: int, walks: int, seed: int) -> np.ndarray:
    """The estimates of `Walks.trace` in all channels, (3, directions, voxels) in float32."""
    walker, rng = walks_of(scene, voxels), np.random.default_rng([seed, part])
    starts = walker.starts(max(min(walks, STARTS // len(towards)), 1), np.array(towards), rng)
    return np.stack([walker.trace(medium_of(scene, channel), starts, walks, rng) for channel in range(3)])


def field(
    scene: MeasuredScene, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> Field:  # fmt: skip
    """The fluence of a scene's body for lights from everywhere. Raises SssgenError as `of_directions` does."""
    return of_directions(scene, octahedron.directions(settings.side), settings, scheduler, processes, progress)


def of_light(
    scene: MeasuredScene, light: Array, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> Field:  # fmt: skip
    """All light inside for one light in the direction `light` (3,), object space."""
    return of_directions(scene, light[None], for_light(settings), scheduler, processes, progress)


def for_light(settings: Settings) -> Settings:
    """The settings for a single light that is fixed to the body."""
    return settings._replace(fixed=True)


def items(scene: MeasuredScene, directions: Array, settings: Settings) -> list[Item]:
    """The work items of `of_directions`."""
    label = f"fluence of {scene.name}"
    if _by_walks(scene):
        walks = max(settings.photons * SHARED // WALK_ITEMS, 1)
        arguments = (_tuples(directions), settings.voxels, walks, settings.seed)
        return [
            Item("sssgen.lab.fluence.fluence_field:trace_walks", (scene, part, *arguments), label)
            for part in range(WALK_ITEMS)
        ]
    photons = settings.photons * settings.side if settings.fixed else settings.photons
    groups = [_tuples(directions[first : first + GROUP]) for first in range(0, len(directions), GROUP)]
    return [
        Item(
            "sssgen.lab.fluence.fluence_field:trace_photons",
            (scene, channel, group, settings.voxels, photons, settings.seed, settings.fixed),
            label,
        )
        for channel in range(3)
        for group in groups
    ]


def has_all_light(scene: MeasuredScene, settings: Settings) -> bool:
    """Whether the field has light that is not scattered, too."""
    return settings.fixed or (scene.medium is not None and scene.medium.ior != 1.0)


def _by_walks(scene: MeasuredScene) -> bool:
    """Whether walks serve all directions."""
    return scene.medium is not None and scene.medium.ior == 1.0 and scene.medium.anisotropy == 0.0


def _tuples(directions: Array) -> Directions:
    return tuple((float(x), float(y), float(z)) for x, y, z in directions)


def of_directions(
    scene: MeasuredScene, directions: Array, settings: Settings, scheduler: str, processes: int | None,
    progress: Progress,
) -> Field:  # fmt: skip
    """The fluence for lights in some directions. Raises SssgenError for a body without an inside, or a failed part."""
    grid, projection = grid_in_box(scene, settings.voxels), projection_of(scene, settings.voxels)
    counting = projection.counting
    results = run(items(scene, directions, settings), scheduler, processes, progress=progress)
    for result in results:
        if isinstance(result, Failure):
            raise failure(f"{result.name}: {result.message}", result.hint)
    estimates, error = (_mean if _by_walks(scene) else _join)(results, len(directions))
    noise = error / max(float(estimates.mean()), 1e-30)
    values = projection.texels(estimates.reshape(-1, grid.voxels)).reshape(3, len(directions), -1)
    if settings.fixed and _by_walks(scene):
        extinctions = [medium_of(scene, channel).extinction for channel in range(3)]
        values += UNSCATTERED * shares(scene, directions, extinctions, settings.voxels)
    distance = scene.geometry.distance(grid.centres()[:, 0])
    nearest, smooth = _nearest(counting, grid), _smooth(values, counting, grid)
    return Field(grid, values, np.flatnonzero(counting), nearest, directions, noise, smooth, distance)


def _join(results: list[tuple[np.ndarray, float]], directions: int) -> tuple[Array, float]:
    """The estimates (3, directions, voxels) of photons and their standard error."""
    values = np.concatenate([part for part, _ in results]).astype(np.float64).reshape(3, directions, -1)
    return values, float(np.sqrt(np.mean([square for _, square in results])))


def _mean(results: list[np.ndarray], directions: int) -> tuple[Array, float]:
    """The same of walks."""
    mean: Array = np.stack(results).mean(axis=0, dtype=np.float64)
    squares = [float(((result - mean) ** 2).mean()) for result in results]
    return mean, float(np.sqrt(np.mean(squares) / max(len(results) - 1, 1)))


def _nearest(counting: npt.NDArray[np.bool_], grid: Grid) -> npt.NDArray[np.int64]:
    """For each voxel of the grid the number of the nearest counting one."""
    ndimage, shape = need("scipy.ndimage", "scipy", "chart"), grid.shape[::-1]
    where = ndimage.distance_transform_edt(~counting.reshape(shape), return_distances=False, return_indices=True)
    number: npt.NDArray[np.int64] = np.cumsum(counting) - 1
    nearest: npt.NDArray[np.int64] = number[np.ravel_multi_index(where.reshape(3, -1), shape)]
    return nearest


def _smooth(values: Array, counting: npt.NDArray[np.bool_], grid: Grid) -> Array:
    """The values of counting voxels, averaged over their neighbours."""
    ndimage = need("scipy.ndimage", "scipy", "chart")
    mask = counting.reshape(grid.shape[::-1]).astype(float)
    share = np.maximum(ndimage.gaussian_filter(mask, 1.0), 1e-9)[mask > 0.0]
    averages = []
    for row in values.reshape(-1, values.shape[-1]):
        volume = np.zeros(mask.shape)
        volume[mask > 0.0] = row
        averages.append(ndimage.gaussian_filter(volume, 1.0)[mask > 0.0] / share)
    return np.stack(averages).reshape(values.shape)
