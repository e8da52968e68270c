"""The reference for bodies with a refracting surface, and for point lights and environments.

Random paths from the eye enter the body, scatter, and are reflected and refracted at the surface. No straight line
leads from a collision through a smooth surface to a light from afar or a point light. So each collision of a path
reads the light that arrives there without scattering from voxels (`first_light`), for all lights of a scene at once.
An environment shines on the paths that leave the body.

The engine computes the reflection of the surface that the eye sees: the paths begin refracted, with the transmitted
share. So light counts if it entered the body.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.lab.reference.dielectric import Dielectric, axes
from sssgen.lab.reference.first_light import FirstLight, Lamp, Voxels, first_light, voxels_of
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.surface_rays import SurfaceRays
from sssgen.scene.geometry import Geometry
from sssgen.scene.measured.media import Medium
from sssgen.support.diagnostics import failure

Array = npt.NDArray[np.float64]


class Sky(NamedTuple):
    """The surroundings."""

    light: Callable[[Array], Array]
    """The radiance times π, (n, 3), that arrives from unit directions (n, 3) in world space"""
    seen_through: bool = True
    """Whether the light counts that reaches the eye without scattering"""


BATCHES = 16
"""Independent batches: each has its own voxels of light; their spread is the noise."""
RAYS = 120_000
"""Rays of a lamp in one batch."""
FAINT = 1e-3
"""The weight below which Russian roulette ends most paths."""
SURVIVAL = 0.1


class Readings(NamedTuple):
    """Readings π L / E of each light, with their noise."""

    mean: Array
    """(lights, n, 3): the lamps, then the skies"""
    error: Array
    """The standard error of each mean, from the spread of the batches"""


class Eye(NamedTuple):
    """The points that the eye sees."""

    position: Array
    """(n, 3), on the surface, in world space"""
    normal: Array
    """(n, 3), outward"""
    direction: Array
    """(n, 3): from the eye, unit"""


class _Body(NamedTuple):
    """What the paths meet."""

    surface: SurfaceRays
    voxels: Voxels
    boundary: Dielectric
    medium: Medium


class _Channel(NamedTuple):
    extinction: float
    albedo: float
    anisotropy: float


def readings(
    geometry: Geometry,
    medium: Medium,
    eye: Eye,
    lamps: Sequence[Lamp],
    skies: Sequence[Sky],
    sampling: Sampling,
    rays: int = RAYS,
    shape: tuple[int, int, int] | None = None,
) -> Readings:
    """The readings of points.

    The light of a lamp that reaches the eye without scattering does not count. `rays` are those of a lamp in one batch,
    and `shape` is the number of voxels along each axis of the object. Raises SssgenError for a point light in the body,
    and a body without an inside.
    """
    if sampling.samples < 1:
        raise failure(f"{sampling.samples} samples are too few", "a few hundred are enough for a picture")
    surface = SurfaceRays(geometry)
    voxels = Voxels(surface, shape) if shape else voxels_of(surface, max(medium.extinction))
    body = _Body(surface, voxels, Dielectric(medium.ior, medium.roughness), medium)
    eye = eye._replace(position=surface.entrances(eye.position, eye.normal, eye.direction))
    each = sampling._replace(samples=-(-sampling.samples // BATCHES))
    batches = [
        _batch(body, eye, lamps, skies, each, rays, np.random.default_rng(part))
        for part in np.random.SeedSequence(sampling.seed).spawn(BATCHES)
    ]
    values = np.stack(batches)
    return Readings(values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(BATCHES))


def _batch(
    body: _Body,
    eye: Eye,
    lamps: Sequence[Lamp],
    skies: Sequence[Sky],
    sampling: Sampling,
    rays: int,
    rng: np.random.Generator,
) -> Array:
    """One batch of readings: (lights, n, 3)."""
    medium = body.medium
    channels = [
        _Channel(extinction, albedo, medium.anisotropy)
        for extinction, albedo in zip(medium.extinction, medium.albedo, strict=True)
    ]
    unique = list(dict.fromkeys(channels))
    extinction = np.array([channel.extinction for channel in unique])
    fields = [
        first_light(body.voxels, body.boundary, extinction, lamp, rays, rng, directions=medium.anisotropy != 0.0)
        for lamp in lamps
    ]
    result = np.zeros((len(lamps) + len(skies), len(eye.position), 3))
    for number, channel in enumerate(unique):
        same = [index for index, candidate in enumerate(channels) if candidate == channel]
        traced = _trace(body, channel, number, eye, fields, skies, sampling, rng)
        # a sky may differ between channels with the same coefficients
        result[: len(lamps), :, same] = traced[: len(lamps), :, None, 0]
        result[len(lamps) :, :, same] = traced[len(lamps) :, :, same]
    return result


class _Paths(NamedTuple):
    """Random paths of the eye."""

    point: npt.NDArray[np.int64]
    """(n,): the index of the point that the eye sees"""
    position: Array
    direction: Array
    """(n, 3)"""
    weight: Array
    """(n,): the factor of the light that arrives from `direction`"""
    collisions: npt.NDArray[np.int64]
    """(n,)"""

    def only(self, keep: npt.NDArray[np.bool_]) -> _Paths:
        return _Paths(
            self.point[keep], self.position[keep], self.direction[keep], self.weight[keep], self.collisions[keep]
        )


def _enter(body: _Body, eye: Eye, samples: int, rng: np.random.Generator) -> _Paths:
    """Paths behind the surface, `samples` for each point."""
    boundary = body.boundary
    directions, normals = (np.repeat(part, samples, axis=0) for part in (eye.direction, eye.normal))
    turn = boundary.refract(directions, normals, rng)
    position = np.repeat(eye.position, samples, axis=0) + body.surface.step * turn.direction
    point = np.repeat(np.arange(len(eye.position)), samples)
    return _Paths(point, position, turn.direction, turn.weight / boundary.ior**2, np.zeros_like(point))


def _trace(
    body: _Body,
    channel: _Channel,
    number: int,
    eye: Eye,
    fields: Sequence[FirstLight],
    skies: Sequence[Sky],
    sampling: Sampling,
    rng: np.random.Generator,
) -> Array:
    """The readings of each point in one channel: (lights, n, 3); a lamp's is in the first column."""
    surface, voxels, boundary, _ = body
    samples, count = sampling.samples, len(eye.position)
    sums = np.zeros((len(fields) + len(skies), count, 3))
    paths = _enter(body, eye, samples, rng)
    # the first free paths of a point's samples are evenly distributed
    chance = (np.tile(np.arange(samples), count) + rng.random(len(paths.point))) / samples
    while len(paths.point):
        crossing = surface.next(paths.position, paths.direction)
        out = paths.only(~crossing.found)
        for index, sky in enumerate(skies, len(fields)):
            shares = out.weight if sky.seen_through else out.weight * (out.collisions > 0)
            seen = shares[:, None] * sky.light(out.direction)
            for color in range(3):
                sums[index, :, color] += np.bincount(out.point, seen[:, color], count)
        point, position, direction, weight, collisions = paths.only(crossing.found)
        ahead, normal = crossing.ahead[crossing.found], crossing.normal[crossing.found]
        inside = np.einsum("nc,nc->n", direction, normal) > 0.0
        free = -np.log1p(-chance[crossing.found]) / max(channel.extinction, 1e-300)
        collides = inside & (free < ahead)
        position = position + np.where(collides, free, ahead)[:, None] * direction
        hit, meets = np.flatnonzero(collides), np.flatnonzero(~collides)
        weight[hit] *= channel.albedo
        collisions[hit] += 1
        cell = voxels.index(position[hit])
        for light, field in enumerate(fields):
            arriving = weight[hit] * field.fluence[number, cell]
            if field.direction is None:
                arriving = arriving / (4.0 * np.pi)
            else:
                cosine = np.einsum("nc,nc->n", -direction[hit], field.direction[number, cell])
                arriving = arriving * _phase(cosine, channel.anisotropy)
            sums[light, :, 0] += np.pi * np.bincount(point[hit], arriving, count)
        direction[hit] = _scatter(direction[hit], channel.anisotropy, rng)
        turn = boundary.reflect_or_refract(direction[meets], normal[meets], rng)
        factor = np.where(turn.crosses, boundary.radiance(direction[meets], normal[meets]), 1.0)
        weight[meets] *= turn.weight * factor
        direction[meets] = turn.direction
        position[meets] += surface.step * turn.direction
        faint = weight < FAINT / boundary.ior**2
        lives = (weight > 0.0) & ~(faint & (rng.random(len(weight)) > SURVIVAL))
        if sampling.scatterings:
            lives &= collisions < sampling.scatterings
        weight = np.where(faint, weight / SURVIVAL, weight)
        paths = _Paths(point, position, direction, weight, collisions).only(lives)
        chance = rng.random(len(paths.point))
    return sums / samples


def _phase(cosine: Array, anisotropy: float) -> Array:
    """Henyey and Greenstein's phase function; `cosine` is that between the light's ways before and after."""
    g = anisotropy
    value: Array = (1.0 - g * g) / (4.0 * np.pi * (1.0 + g * g - 2.0 * g * cosine) ** 1.5)
    return value


def _scatter(direction: Array, anisotropy: float, rng: np.random.Generator) -> Array:
    """Directions after a collision, by Henyey and Greenstein's phase function."""
    count = len(direction)
    cosine = 2.0 * rng.random(count) - 1.0
    if anisotropy:
        g = anisotropy
        cosine = (1.0 + g * g - ((1.0 - g * g) / (1.0 + g * cosine)) ** 2) / (2.0 * g)
    sine, angle = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 2.0 * np.pi * rng.random(count)
    x, y = sine * np.cos(angle), sine * np.sin(angle)
    if not anisotropy:
        return np.stack([x, y, cosine], axis=1)
    first, second = axes(direction)
    turned: Array = x[:, None] * first + y[:, None] * second + cosine[:, None] * direction
    return turned
