"""The multiply scattered fluence of a measured scene's body, for many light directions: traced in parts, kept in the
store of results, so that an interrupted bake continues."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence import octahedron
from sssgen.lab.fluence.photons import Body, Medium, Tracer
from sssgen.lab.fluence.voxels import Grid
from sssgen.lab.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.reference.geometry_mesh import mesh_of
from sssgen.lab.scene import scene_body
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]

GROUP = 32
"""The directions of one work item."""
PARTS = 4
"""The points along each axis of a voxel at which the body's distance is evaluated."""
LEAST_INSIDE = 0.12
"""Voxels with a smaller part inside get the values of the nearest other voxel: few photons collide in them."""


class Settings(NamedTuple):
    """How finely the fluence is traced."""

    voxels: int = 24
    """Along the longest side of the box"""
    side: int = 16
    """Light directions along each side of the octahedral map"""
    photons: int = 24000
    """For each direction and channel"""
    seed: int = 0


class Field(NamedTuple):
    """π times the mean radiance that is scattered at least once, for an irradiance of 1 on a plane facing the light."""

    grid: Grid
    """In the body's object space"""
    values: Array
    """(3, directions, voxels), of voxels that count; see `nearest`"""
    nearest: npt.NDArray[np.int64]
    """(voxels of the grid,): the counting voxel whose value each voxel has"""
    directions: Array
    """(directions, 3), towards the light, in object space"""
    noise: float
    """The standard error of a voxel's value, relative to the mean value"""
    smooth: Array
    """`values` averaged over neighbouring voxels"""


def grid_in_box(scene: MeasuredScene, voxels: int) -> Grid:
    """The grid that fills the box of the body's distance texture."""
    texture = scene_body.distance_texture(scene.geometry)
    low, high = np.array(texture.box_min), np.array(texture.box_max)
    x, y, z = np.maximum(np.rint(voxels * (high - low) / (high - low).max()).astype(int), 1)
    return Grid(low, high, (int(x), int(y), int(z)))


@lru_cache(4)
def tracer(scene: MeasuredScene, voxels: int) -> Tracer:
    """The tracer of a scene's body, in object space."""
    vertices, faces = mesh_of(scene.geometry)
    to_object = scene.geometry.to_object()
    body = Body(vertices @ to_object[:3, :3].T + to_object[:3, 3], faces)
    return Tracer(body, grid_in_box(scene, voxels))


Directions = tuple[tuple[float, float, float], ...]


def traced(
    scene: MeasuredScene, channel: int, towards: Directions, voxels: int, photons: int, seed: int
) -> tuple[np.ndarray, float]:
    """The values (directions, voxels) for lights in the directions `towards` (object space), and their mean squared
    error. Values are per voxel, also where a part of it is outside.
    """
    assert scene.medium is not None
    # a unit of object space is `scale` units of the world, in which the medium is given
    extinction = scene.medium.extinction[channel] * scene.geometry.scale
    medium = Medium(extinction, scene.medium.albedo[channel], scene.medium.anisotropy, scene.medium.ior)
    first, second = (
        tracer(scene, voxels).trace(
            medium, np.array(towards), max(photons // 2, 1), np.random.default_rng([seed, channel, half])
        )
        for half in range(2)
    )
    return (0.5 * (first + second)).astype(np.float32), float(np.mean((0.5 * (first - second)) ** 2))


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
    """The fluence for one light in the direction `light` (3,), object space, with the photons of all directions."""
    return of_directions(scene, light[None], for_light(settings), scheduler, processes, progress)


def for_light(settings: Settings) -> Settings:
    """The settings for a single light, which gets more photons."""
    return settings._replace(photons=settings.photons * settings.side)


def items(scene: MeasuredScene, directions: Array, settings: Settings) -> list[Item]:
    """The work items of `of_directions`, channel by channel."""
    groups = [
        tuple(map(tuple, directions[first : first + GROUP].tolist())) for first in range(0, len(directions), GROUP)
    ]
    return [
        Item(
            "sssgen.lab.fluence.fluence_field:traced",
            (scene, channel, group, settings.voxels, settings.photons, settings.seed),
            f"fluence of {scene.name}",
        )
        for channel in range(3)
        for group in groups
    ]


def of_directions(
    scene: MeasuredScene, directions: Array, settings: Settings, scheduler: str, processes: int | None,
    progress: Progress,
) -> Field:  # fmt: skip
    """The fluence for lights in some directions. Raises SssgenError for a body without an inside, or a failed part."""
    grid = grid_in_box(scene, settings.voxels)
    points = grid.centres(PARTS).reshape(-1, 3)
    inside = (scene.geometry.distance(points) < 0.0).reshape(grid.voxels, -1).mean(axis=1)
    counting = inside > LEAST_INSIDE
    if not counting.any():
        raise failure("no voxel is inside the body", "use more voxels, or close the mesh")
    count = len(directions)
    results = run(items(scene, directions, settings), scheduler, processes, progress=progress)
    for result in results:
        if isinstance(result, Failure):
            raise failure(f"{result.name}: {result.message}")
    values = np.concatenate([part for part, _ in results]).astype(np.float64).reshape(3, count, grid.voxels)
    noise = float(np.sqrt(np.mean([square for _, square in results]))) / max(float(values.mean()), 1e-30)
    values /= np.maximum(inside, LEAST_INSIDE)
    return Field(
        grid, values[..., counting], _nearest(counting, grid), directions, noise, _smooth(values, counting, grid)
    )


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
    share = np.maximum(ndimage.gaussian_filter(mask, 1.0), 1e-9)
    volumes = values.reshape(-1, *mask.shape)
    averages = [(ndimage.gaussian_filter(volume * mask, 1.0) / share).ravel()[counting] for volume in volumes]
    return np.stack(averages).reshape(*values.shape[:2], -1)
