"""The fluence inside a measured scene's body, for many light directions: computed in parts, kept in the store of
results, so that an interrupted bake continues."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.fluence.exchange import scattered
from sssgen.lab.fluence.traced_body import fitting_voxels, grid_in_box, medium_of, projection_of, tracer
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene import octahedron
from sssgen.scene.light_response import UNSCATTERED
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Array = npt.NDArray[np.float64]

GROUP = 32
"""The directions of one work item."""
PHOTONS_OF_FLIGHT = 500
"""Where flights serve all directions, one from each point for so many photons: about the same noise."""
PHOTONS_OF_RAY = 4
"""Behind a refracting surface, one ray of light that has not been scattered for so many photons."""
OF_NEIGHBOURS = 4
"""A direction of many has the photons divided by this: products of few factors share those of its neighbours."""
OF_FIXED = 16
"""A light that is fixed to the body has so many times the photons."""


class Settings(NamedTuple):
    """How finely the fluence is traced."""

    voxels: int = 24
    """Along the longest side of the box"""
    side: int = 32
    """Light directions along each side of the octahedral map: parts of a body shade each other with sharp edges"""
    photons: int = 24000
    """For a light in each channel; see `OF_NEIGHBOURS` and `OF_FIXED`"""
    seed: int = 0
    fixed: bool = False
    """For one light: the field includes light that is not scattered"""


class Field(NamedTuple):
    """π times the mean radiance inside, for an irradiance of 1 on a plane facing the light."""

    grid: Grid
    """In the body's object space"""
    values: Array
    """(3, directions, voxels), of voxels that count (see `cells`): texels for trilinear interpolation, which noise
    may make negative. Of light that is scattered at least once; of all light where `shares` is empty"""
    shares: npt.NDArray[np.float32]
    """(3, directions, voxels): the share of light that arrives without being scattered; (3, 0, voxels) where `values`
    has it"""
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

    @property
    def whole(self) -> Array:
        """All light, as `values`."""
        return self.values + UNSCATTERED * self.shares if self.shares.size else self.values


Directions = tuple[tuple[float, float, float], ...]


def trace_photons(
    scene: MeasuredScene, channel: int, towards: Directions, voxels: int, photons: int, seed: int, unscattered: bool
) -> tuple[np.ndarray, float]:
    """The estimates (directions, voxels) of `Tracer.trace` for lights in the directions `towards` (object space), and
    their standard error, root mean square."""
    medium = medium_of(scene, channel)
    first, second = (
        tracer(scene, voxels).trace(
            medium, np.array(towards), max(photons // 2, 1), np.random.default_rng([seed, channel, half]), unscattered
        )
        for half in range(2)
    )
    return (0.5 * (first + second)).astype(np.float32), float(np.sqrt(np.mean((0.5 * (first - second)) ** 2)))


def trace_shares(scene: MeasuredScene, towards: Directions, voxels: int) -> np.ndarray:
    """The texels of the share of light from some directions that is not scattered on its way, in all channels:
    (3, directions, counting voxels) in float32."""
    projection, rays = projection_of(scene, voxels), tracer(scene, voxels)
    extinctions = [medium_of(scene, channel).extinction for channel in range(3)]
    texels = []
    for direction in np.array(towards):
        lengths = rays.lengths(projection.points, direction[None])[:, 0].astype(np.float64)
        texels.append(projection.texels(projection.integrals(np.exp(-np.outer(extinctions, lengths)))))
    return np.stack(texels, axis=1).astype(np.float32)


def trace_arriving(scene: MeasuredScene, towards: Directions, voxels: int, rays: int, seed: int) -> np.ndarray:
    """As `trace_shares`, behind a refracting surface: by `rays` rays for each direction."""
    projection, media = projection_of(scene, voxels), [medium_of(scene, channel) for channel in range(3)]
    extinctions = np.array([medium.extinction for medium in media])
    rng = np.random.default_rng([seed, *np.rint(1e6 * np.abs(towards[0])).astype(int)])
    texels = []
    for direction in np.array(towards):
        light = tracer(scene, voxels).arriving(extinctions, media[0].boundary, direction, rays, rng)
        texels.append(projection.texels(projection.folded(light)) / UNSCATTERED)
    return np.stack(texels, axis=1).astype(np.float32)


def trace_flights(
    scene: MeasuredScene, channel: int, shares: np.ndarray, voxels: int, flights: int, seed: int
) -> tuple[np.ndarray, float]:
    """The scattered light for the `shares` of a channel, (directions, counting voxels), and its standard error."""
    light = UNSCATTERED * shares.astype(np.float64)
    rays, projection = tracer(scene, voxels), projection_of(scene, voxels)
    result = scattered(rays, projection, medium_of(scene, channel), light, flights, seed)
    return result.texels.astype(np.float32), result.noise


def settings_for(scene: MeasuredScene) -> Settings:
    """The settings with as many voxels as fit the budget."""
    return Settings(fitting_voxels(scene))


def field(
    scene: MeasuredScene, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> Field:  # fmt: skip
    """The fluence of a scene's body for lights from everywhere. Raises SssgenError for a body without an inside, or
    a part of the work that failed."""
    return of_directions(scene, octahedron.directions(settings.side), settings, scheduler, processes, progress)


def of_light(
    scene: MeasuredScene, light: Array, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> Field:  # fmt: skip
    """All light inside for one light in the direction `light` (3,), object space. Raises SssgenError as `field`."""
    return of_directions(scene, light[None], for_light(settings), scheduler, processes, progress)


def of_directions(
    scene: MeasuredScene, directions: Array, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> Field:  # fmt: skip
    """The fluence for lights in some directions (n, 3), object space. Raises SssgenError as `field` does."""
    work = _Work(scene, settings, scheduler, processes, progress)
    return work.field(directions, work.shares(directions))


def for_light(settings: Settings) -> Settings:
    """The settings for a single light that is fixed to the body."""
    return settings._replace(fixed=True)


def by_flights(scene: MeasuredScene) -> bool:
    """Whether flights serve all directions: in an isotropic medium."""
    return scene.medium is not None and scene.medium.anisotropy == 0.0


class _Work(NamedTuple):
    """The parts of a field, as items that the executor runs."""

    scene: MeasuredScene
    settings: Settings
    scheduler: str
    processes: int | None
    progress: Progress

    @property
    def refracts(self) -> bool:
        """Whether the surface bends light."""
        return self.scene.medium is not None and self.scene.medium.ior != 1.0

    @property
    def by_photons_alone(self) -> bool:
        """Whether photons have the light that has not been scattered, too."""
        return not by_flights(self.scene) and (self.refracts or self.settings.fixed)

    def shares(self, directions: Array) -> npt.NDArray[np.float32]:
        """The shares of light that has not been scattered, (3, directions, voxels); (3, 0, voxels) where photons have
        it: behind a refracting surface and for a fixed light, if the medium is anisotropic."""
        scene, settings = self.scene, self.settings
        if self.by_photons_alone:
            return np.zeros((3, 0, int(projection_of(scene, settings.voxels).counting.sum())), np.float32)
        function = "trace_shares"
        traced: tuple[int, ...] = ()
        if self.refracts:
            photons = settings.photons * (OF_FIXED if settings.fixed else 1)
            function, traced = "trace_arriving", (max(photons // PHOTONS_OF_RAY, 1), settings.seed)
        groups = _groups(directions)
        parts = self._results("step 1 of 2, ", function, [(scene, group, settings.voxels, *traced) for group in groups])
        return np.concatenate(parts, axis=1)

    def field(self, directions: Array, shares: npt.NDArray[np.float32]) -> Field:
        """The field with the `shares` for its directions."""
        scene, settings = self.scene, self.settings
        grid, projection = grid_in_box(scene, settings.voxels), projection_of(scene, settings.voxels)
        channels = range(3)
        each: list[tuple[Any, ...]]
        step = "" if self.by_photons_alone else "step 2 of 2, "
        if by_flights(scene):
            flights = max(settings.photons // PHOTONS_OF_FLIGHT, 2)
            each = [(scene, channel, shares[channel], settings.voxels, flights, settings.seed) for channel in channels]
            results = self._results(step, "trace_flights", each)
            values = np.stack([texels for texels, _ in results]).astype(np.float64)
        else:
            photons = settings.photons * OF_FIXED if settings.fixed else max(settings.photons // OF_NEIGHBOURS, 2)
            rest = (settings.voxels, photons, settings.seed, settings.fixed)
            groups = _groups(directions)
            each = [(scene, channel, group, *rest) for channel in channels for group in groups]
            results = self._results(step, "trace_photons", each)
            estimates = np.concatenate([part for part, _ in results]).astype(np.float64)
            values = projection.texels(projection.folded(estimates)).reshape(3, len(directions), -1)
        noise = float(np.sqrt(np.mean([error**2 for _, error in results]))) / max(float(values.mean()), 1e-30)
        if settings.fixed and shares.size:
            values, shares = values + UNSCATTERED * shares, shares[:, :0]
        distance = scene.geometry.distance(grid.centres()[:, 0])
        smooth = _smooth(values, projection.counting, grid)
        cells = np.flatnonzero(projection.counting)
        return Field(
            grid, values, shares, cells, projection.nearest, directions, noise, smooth, distance
        )  # fmt: skip

    def _results(self, step: str, function: str, each: list[tuple[Any, ...]]) -> list[Any]:
        label = f"{step}fluence of {self.scene.name}"
        items = [Item(f"sssgen.lab.fluence.fluence_field:{function}", arguments, label) for arguments in each]
        results = run(items, self.scheduler, self.processes, progress=self.progress)
        for result in results:
            if isinstance(result, Failure):
                raise failure(f"{result.name}: {result.message}", result.hint)
        return results


def _groups(directions: Array) -> list[Directions]:
    """The directions of each work item."""
    return [
        tuple((float(x), float(y), float(z)) for x, y, z in directions[first : first + GROUP])
        for first in range(0, len(directions), GROUP)
    ]


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
