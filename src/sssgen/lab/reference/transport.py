"""The reference: what light transport makes of a translucent body, by Monte Carlo with its noise beside it.

Readings are π L / E: outgoing radiance L over the irradiance E of the light on a plane that faces it, times π. A white
Lambert surface that faces the light reads 1.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sssgen.harness.scenes.camera import Camera
from sssgen.harness.scenes.geometry import Geometry
from sssgen.lab.reference.geometry_mesh import RESOLUTION
from sssgen.lab.reference.render_cache import Batches, keep, kept
from sssgen.lab.reference.transport_mitsuba import Body, Channel, Light, Renderer, body_of, mitsuba
from sssgen.lab.scene.media import Medium
from sssgen.support import cache
from sssgen.support.diagnostics import failure

__all__ = ["BATCH", "FEWEST_BATCHES", "Light", "Transport", "radiance", "radiance_along"]

Array = npt.NDArray[np.float64]

BATCH = 16
"""Samples of a pixel in one batch."""

FEWEST_BATCHES = 8
"""So many are rendered at least: the noise is estimated from their spread."""

_VERSION = 1
"""Of what kept references hold: one more whenever this package would compute other numbers."""

_SECONDS_BETWEEN_WRITES = 5.0


@dataclass(frozen=True)
class Transport:
    """Readings π L / E, with their noise."""

    mean: Array
    """(h, w, 3), row 0 at the bottom, or (n, 3)"""
    error: Array
    """The standard error of each mean, from the spread of independent batches; of the same shape"""
    samples: int
    """Of each pixel and channel"""

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
    """The picture, (height, width, 3), of a body of `medium` in front of black, lit from one direction alone.

    Its pixels are those of `camera.rays(*size)`, the rays through their centres, row 0 at the bottom; `light_direction`
    is the unit vector towards the light, or a `Light`. `samples` is rounded up to whole batches of 16, 8 of them at
    least. Rays that miss the geometry read 0. The same arguments give the same numbers, whatever the number of threads.
    Torus, distance function and mesh are triangles (see `shapes_mesh`, which has `resolution`).

    A boundary with another index than 1 is smooth, and paths must find the light through it by chance: there the light
    needs a radius, 10 degrees or so. The light itself is seen through the body then.

    Raises SssgenError for what is out of these bounds, a body without an inside, a camera in the body, a missing
    package.
    """
    light = light_direction if isinstance(light_direction, Light) else Light(light_direction)
    width, height = size
    origin, directions = camera.rays(width, height)
    hit = np.flatnonzero(geometry.hits(origin, directions).hit)
    origins = np.broadcast_to(origin, (len(hit), 3))
    found = radiance_along(geometry, medium, light, origins, directions[hit], samples, seed, resolution)

    def picture(values: Array) -> Array:
        whole = np.zeros((height * width, 3))
        whole[hit] = values
        return whole.reshape(height, width, 3)

    return Transport(picture(found.mean), picture(found.error), found.samples)


def radiance_along(
    geometry: Geometry,
    medium: Medium,
    light: Light,
    origins: Array,
    directions: Array,
    samples: int,
    seed: int = 0,
    resolution: int = RESOLUTION,
    scatterings: int = 0,
) -> Transport:
    """The readings, (n, 3), along rays from outside the body: origins and unit directions (n, 3), in world space.

    Rays that miss the body see the light, if it has a radius or is everywhere. With `scatterings` above 0 only light
    that was scattered at most so often counts. One sample in ten thousand falls to the ray next in the list, as
    Mitsuba counts them in single precision. The rest is as for `radiance`.
    """
    _check(geometry, medium, light, origins, directions, samples)
    batches = max(-(-samples // BATCH), FEWEST_BATCHES)
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
    # each channel by itself: distances that are drawn for one channel serve another with a far larger spread
    for channel in dict.fromkeys(channels):
        found = _converge(body, channel, light, rays, batches, seed, scatterings)
        same = [at for at, other in enumerate(channels) if other == channel]
        mean[:, same], error[:, same] = found.mean()[:, None], found.error()[:, None]
    return Transport(mean, error, batches * BATCH)


def _converge(
    body: Body, channel: Channel, light: Light, rays: tuple[Array, Array], wanted: int, seed: int, scatterings: int
) -> Batches:
    """So many batches of one channel: those that are kept, and the rest rendered."""
    what = (_VERSION, mitsuba().__version__, BATCH, channel, light, seed, scatterings)
    content = b"".join([repr(what).encode(), body.content(), rays[0].tobytes(), rays[1].tobytes()])
    key = cache.digest(content)
    state = kept(key, (len(rays[0]),), wanted)
    if state.number == wanted:
        return state
    base = int(np.random.SeedSequence(int(cache.digest(content + b"stream"), 16)).generate_state(1)[0])
    renderer = Renderer(body, channel, light, rays, base, scatterings)
    on_the_way, written = 0, time.monotonic()
    while state.number < wanted:
        state = state.and_another(renderer.batch(state.number, BATCH))
        if state.number < wanted and time.monotonic() - written > _SECONDS_BETWEEN_WRITES:
            keep(key, state, instead_of=on_the_way)
            on_the_way, written = state.number, time.monotonic()
    keep(key, state, instead_of=on_the_way)
    return state


def _check(geometry: Geometry, medium: Medium, light: Light, origins: Array, directions: Array, samples: int) -> None:
    if samples < 1:
        raise failure(f"there cannot be {samples} samples", "a few hundred give a picture, thousands a reference")
    if not 0.0 <= light.radius < 90.0:
        raise failure(f"the light cannot have a radius of {light.radius:g} degrees", "it goes from 0 to below 90")
    if light.direction is not None and abs(np.linalg.norm(light.direction) - 1.0) > 1e-6:
        raise failure("the direction towards the light is not of length 1", "divide it by its length")
    if not np.allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-6):
        raise failure("a ray's direction is not of length 1", "divide it by its length")
    if medium.ior != 1.0 and light.direction is not None and light.radius == 0.0:
        message = f"'{medium.name}' has the refractive index {medium.ior:g}: no path finds a light without width"
        raise failure(message, "use medium.matched(), or a Light with a radius of 10 degrees or so")
    places = np.unique(origins, axis=0)
    inside = geometry.to_object()
    if len(places) and (geometry.distance(places @ inside[:3, :3].T + inside[:3, 3]) < 0.0).any():
        raise failure("a ray starts in the body", "move the camera out of it")
