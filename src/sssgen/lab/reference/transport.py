"""The reference: light transport in a translucent body by Monte Carlo, with an estimate of its noise.

Readings are π L / E: outgoing radiance L over the irradiance E of the light on a plane that faces it, times π. A white
Lambert surface that faces the light reads 1.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sssgen.lab.reference.render_cache import Batches, read_batches, store
from sssgen.lab.reference.sampling import Sampling
from sssgen.lab.reference.transport_mitsuba import Body, Channel, Light, Renderer, body_of, mitsuba
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Geometry
from sssgen.scene.geometry_mesh import RESOLUTION
from sssgen.scene.measured.media import Medium
from sssgen.support import cache
from sssgen.support.diagnostics import failure

__all__ = ["BATCH", "FEWEST_BATCHES", "Light", "Transport", "radiance", "radiance_along"]

Array = npt.NDArray[np.float64]

BATCH = 16
"""Samples of a pixel in one batch."""

FEWEST_BATCHES = 8
"""The least number of batches: the noise is estimated from their spread."""

_VERSION = 1
"""The version of cached references: increase it when this package computes other numbers."""

_SECONDS_BETWEEN_WRITES = 5.0


@dataclass(frozen=True)
class Transport:
    """Readings π L / E, with their noise."""

    mean: Array
    """(h, w, 3), row 0 at the bottom, or (n, 3)"""
    error: Array
    """The standard error of each mean, from the spread of independent batches; the same shape"""
    samples: int
    """Per pixel and channel"""

    @property
    def noise(self) -> float:
        """The errors' root mean square over that of the means."""
        level = float(np.sqrt(np.mean(self.mean**2)))
        return float(np.sqrt(np.mean(self.error**2))) / level if level > 0.0 else 0.0


def radiance(
    geometry: Geometry,
    medium: Medium,
    light_direction: tuple[float, float, float] | Light,
    camera: Camera,
    size: tuple[int, int],
    samples: int,
    seed: int = 0,
    resolution: int = RESOLUTION,
) -> Transport:
    """The picture, (height, width, 3), of a body of `medium` in front of black, with one light.

    Its pixels are those of `camera.rays(*size)`, the rays through their centres, row 0 at the bottom; `light_direction`
    is the unit vector towards the light, or a `Light`. `samples` is rounded up to full batches of 16, at
    least 8. Rays that miss the geometry read 0. The same arguments give the same numbers for any number of threads.
    Torus, distance function and mesh are triangles (see `geometry_mesh`, for `resolution`).

    A boundary with an index other than 1 is smooth, and only random paths reach the light through it: the light needs a
    radius then, of about 10 degrees. In this case the light itself is visible through the body.

    Raises SssgenError for values out of these bounds, a body without an inside, a camera in the body, and a missing
    package.
    """
    light = light_direction if isinstance(light_direction, Light) else Light(light_direction)
    width, height = size
    origin, directions = camera.rays(width, height)
    hit = np.flatnonzero(geometry.hits(origin, directions).hit)
    origins = np.broadcast_to(origin, (len(hit), 3))
    result = radiance_along(geometry, medium, light, origins, directions[hit], Sampling(samples, seed), resolution)

    def picture(values: Array) -> Array:
        pixels = np.zeros((height * width, 3))
        pixels[hit] = values
        return pixels.reshape(height, width, 3)

    return Transport(picture(result.mean), picture(result.error), result.samples)


def radiance_along(
    geometry: Geometry,
    medium: Medium,
    light: Light,
    origins: Array,
    directions: Array,
    sampling: Sampling,
    resolution: int = RESOLUTION,
) -> Transport:
    """The readings, (n, 3), along rays from outside the body: origins and unit directions (n, 3), in world space.

    Rays that miss the body see the light, if it has a radius or comes from everywhere. About one sample in ten
    thousand is assigned to the next ray, because Mitsuba indexes them in single precision. Otherwise as `radiance`.
    """
    _check(geometry, medium, light, origins, directions, sampling.samples)
    batches = max(-(-sampling.samples // BATCH), FEWEST_BATCHES)
    shape = (len(directions), 3)
    if not len(directions):
        return Transport(np.zeros(shape), np.zeros(shape), batches * BATCH)
    body = body_of(geometry, resolution)
    rays = np.ascontiguousarray(origins, np.float64), np.ascontiguousarray(directions, np.float64)
    mean, error = np.zeros(shape), np.zeros(shape)
    channels = [
        Channel(extinction, albedo, medium.anisotropy, medium.ior)
        for extinction, albedo in zip(medium.extinction, medium.albedo, strict=True)
    ]
    # each channel separately, because free paths that are sampled for a channel have a large variance in another one
    for channel in dict.fromkeys(channels):
        state = _converge(body, channel, light, rays, batches, sampling)
        equal_channels = [index for index, candidate in enumerate(channels) if candidate == channel]
        mean[:, equal_channels], error[:, equal_channels] = state.mean()[:, None], state.error()[:, None]
    return Transport(mean, error, batches * BATCH)


def _converge(
    body: Body, channel: Channel, light: Light, rays: tuple[Array, Array], count: int, sampling: Sampling
) -> Batches:
    """The `count` batches of one channel: from the cache, and newly rendered."""
    arguments = (_VERSION, mitsuba().__version__, BATCH, channel, light, sampling.seed, sampling.scatterings)
    content = b"".join([repr(arguments).encode(), body.content(), rays[0].tobytes(), rays[1].tobytes()])
    key = cache.digest(content)
    state = read_batches(key, (len(rays[0]),), count)
    if state.number == count:
        return state
    base = int(np.random.SeedSequence(int(cache.digest(content + b"stream"), 16)).generate_state(1)[0])
    renderer = Renderer(body, channel, light, rays, base, sampling.scatterings)
    written_batches, written = 0, time.monotonic()
    while state.number < count:
        state = state.with_batch(renderer.batch(state.number, BATCH))
        if state.number < count and time.monotonic() - written > _SECONDS_BETWEEN_WRITES:
            store(key, state, instead_of=written_batches)
            written_batches, written = state.number, time.monotonic()
    store(key, state, instead_of=written_batches)
    return state


def _check(geometry: Geometry, medium: Medium, light: Light, origins: Array, directions: Array, samples: int) -> None:
    if samples < 1:
        raise failure(
            f"{samples} samples are too few", "a few hundred are enough for a picture, thousands for a reference"
        )
    if not 0.0 <= light.radius < 90.0:
        raise failure(f"the light cannot have a radius of {light.radius:g} degrees", "at least 0, and less than 90")
    if light.direction is not None and abs(np.linalg.norm(light.direction) - 1.0) > 1e-6:
        raise failure("the direction towards the light is not of length 1", "divide it by its length")
    if not np.allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-6):
        raise failure("a ray's direction is not of length 1", "divide it by its length")
    if medium.ior != 1.0 and light.direction is not None and light.radius == 0.0:
        message = f"'{medium.name}' has the refractive index {medium.ior:g}: no path reaches a light without a radius"
        raise failure(message, "use medium.matched(), or a Light with a radius of 10 degrees or so")
    starts = np.unique(origins, axis=0)
    to_object = geometry.to_object()
    if len(starts) and (geometry.distance(starts @ to_object[:3, :3].T + to_object[:3, 3]) < 0.0).any():
        raise failure("a ray starts inside the body", "move the camera out of it")
