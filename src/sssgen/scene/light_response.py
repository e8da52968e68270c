"""How a body responds to light from anywhere: what `sssgen bake fluence --relit` stores, and its sum for some lights.

Each voxel has a few numbers, which weight a table of directions: the light that has been scattered inside. Light that
has not been scattered varies too fast for few numbers: each voxel has its share for each direction. The surroundings
are spherical harmonics of order 2 (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment
Maps, SIGGRAPH 2001), which a voxel weights once for all.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene import octahedron
from sssgen.scene.arrays import Array
from sssgen.scene.scene import Light

HARMONICS = 9
"""Spherical harmonics up to order 2."""
SUFFIX = ".bin"
"""Of the name of a response's file"""
UNSCATTERED = 0.25
"""π times the mean radiance of light that has not been scattered, relative to its irradiance."""


class LightResponse(NamedTuple):
    """The response of the voxels that count; the others have that of the nearest of these."""

    low: Array
    high: Array
    """(3,): the corners of the box, in object space"""
    cells: npt.NDArray[np.unsignedinteger]
    """(voxels,): where the voxels that count are in the box, x fastest, then y"""
    nearest: npt.NDArray[np.unsignedinteger]
    """(z, y, x): the number of a voxel that counts"""
    latents: npt.NDArray[np.uint8]
    """(rank, voxels): numbers in 0..1, times 255"""
    table: npt.NDArray[np.float16]
    """(side², 1 + rank, 3): for each direction of an octahedral map the constant and what the numbers weight"""
    arriving: npt.NDArray[np.uint8]
    """(voxels, side²): the root of the share that arrives without being scattered in one channel, times 255 /
    `highest`, for the directions of an octahedral map; (voxels, 0) where the table has all light"""
    highest: float
    powers: Array
    """(3,): the powers of this share that are those of the channels, below a share of 1"""
    surroundings: npt.NDArray[np.int8]
    """(9, 3, voxels): the weights of spherical harmonics, times 127 / `largest`"""
    largest: Array
    """(9, 3)"""
    distance: npt.NDArray[np.uint8]
    """(z, y, x): the distance from the surface, 0 the reach inside, 255 the reach outside"""

    @property
    def shape(self) -> tuple[int, int, int]:
        """The voxels along x, y and z."""
        z, y, x = self.nearest.shape
        return x, y, z

    def places(self) -> Array:
        """The centres of the voxels that count, (voxels, 3), in object space."""
        z, y, x = np.unravel_index(self.cells, self.nearest.shape)
        size = (self.high - self.low) / np.array(self.shape)
        centres: Array = self.low + (np.stack([x, y, z], axis=1) + 0.5) * size
        return centres


class Incoming(NamedTuple):
    """A light at the voxels: one row where it is the same for all of them."""

    towards: Array
    """(voxels or 1, 3): unit directions towards the light, in object space"""
    irradiance: Array
    """(voxels or 1, 3): on a plane that faces the light, with shadows of other bodies"""


def from_light(response: LightResponse, light: Light, to_object: Array) -> Incoming:
    """A light of a scene at the voxels of a body, without shadows; `to_object` (4, 4) is from world to object space."""
    color = np.array([light.color])
    if light.position is None:
        ways = np.array([light.direction]) @ to_object[:3, :3].T
        return Incoming(ways / np.linalg.norm(ways, axis=1, keepdims=True), color)
    ways = (np.append(light.position, 1.0) @ to_object.T)[:3] - response.places()
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    # the length of a unit of the world in object space
    unit = np.cbrt(abs(np.linalg.det(to_object[:3, :3])))
    return Incoming(ways / np.maximum(lengths, 1e-9), color / np.maximum(lengths / unit, 1e-2) ** 2)


def lit(response: LightResponse, lights: list[Incoming], surroundings: Array | None = None) -> Array:
    """The light in all voxels, (z, y, x, 3): π times the mean radiance.

    `surroundings` (9, 3): the integrals of the light from each direction times the harmonics, in object space, where
    light of 1 from everywhere is the irradiance π.
    """
    light = np.zeros((3, response.latents.shape[1]))
    numbers = response.latents / 255.0
    for towards, irradiance in lights:
        light += irradiance.T * _scattered(response, numbers, towards)
        if response.arriving.size:
            light += irradiance.T * (UNSCATTERED * _arriving(response, towards))
    if surroundings is not None:
        weights = response.surroundings * (response.largest / 127.0)[..., None]
        light += np.einsum("kcv,kc->cv", weights, surroundings)
    texels: Array = np.maximum(light, 0.0)[:, response.nearest]
    return np.moveaxis(texels, 0, -1)


def volume(response: LightResponse, lights: list[Incoming], surroundings: Array | None = None) -> Array:
    """The texels of the volume, (z, y, x, 4): the light as `lit` has it, and the stored distance, 0 to 1."""
    distance = response.distance[..., None] / 255.0
    return np.concatenate([lit(response, lights, surroundings), distance], axis=-1)


def _scattered(response: LightResponse, numbers: Array, towards: Array) -> Array:
    """(3, voxels), for an irradiance of 1."""
    texels, weights = octahedron.mix(towards, octahedron.side_of(response.table))
    rows = np.einsum("nt,ntkc->nkc", weights, response.table[texels].astype(np.float64))
    if len(rows) == 1:
        of_all: Array = rows[0, 0][:, None] + rows[0, 1:].T @ numbers
        return of_all
    result: Array = rows[:, 0].T + np.einsum("nkc,kn->cn", rows[:, 1:], numbers)
    return result


def _arriving(response: LightResponse, towards: Array) -> Array:
    """(3, voxels): the share of light that arrives without being scattered."""
    texels, weights = octahedron.mix(towards, octahedron.side_of(response.arriving.T))
    root = (weights * response.arriving[np.arange(len(response.arriving))[:, None], texels]).sum(axis=1)
    return arriving_shares(root * (response.highest / 255.0), response.powers).T


def arriving_shares(roots: Array, powers: Array) -> Array:
    """The shares of the channels whose stored root is one of `roots` (n,), before it became a byte: (n, 3).

    A share above 1 is light that a curved surface focuses: it is the same for all channels, and only what the medium
    leaves of light differs between them.
    """
    share = np.maximum(roots, 3e-5)[:, None] ** 2
    result: Array = np.where(share < 1.0, share**powers, share)
    return result


def harmonics(directions: Array) -> Array:
    """The real spherical harmonics up to order 2 at unit directions (n, 3): (n, 9)."""
    x, y, z = directions.T
    one = np.ones_like(x)
    return np.stack(
        [
            0.28209479 * one, 0.48860251 * y, 0.48860251 * z, 0.48860251 * x, 1.09254843 * x * y, 1.09254843 * y * z,
            0.31539157 * (3.0 * z * z - 1.0), 1.09254843 * x * z, 0.54627422 * (x * x - y * y),
        ],
        axis=1,
    )  # fmt: skip


# Files: arrays one behind the other, which the JSON beside them describes; all are compressed (zlib, RFC 1950).

_ARRAYS = ("cells", "nearest", "latents", "table", "arriving", "surroundings", "distance")


def to_bytes(response: LightResponse) -> tuple[bytes, dict[str, Any]]:
    """The bytes of a file, and the description of its arrays for JSON: name → type, shape, and the first byte of what
    is decompressed."""
    parts, described, start = [], {}, 0
    for name in _ARRAYS:
        values: npt.NDArray[Any] = np.ascontiguousarray(getattr(response, name))
        data = values.astype(values.dtype.newbyteorder("<")).tobytes()
        described[name] = {"type": values.dtype.name, "shape": list(values.shape), "start": start}
        parts.append(data + bytes(-len(data) % 4))
        start += len(parts[-1])
    return zlib.compress(b"".join(parts), 9), described


def checksum(data: bytes) -> int:
    """The Adler-32 of what is compressed, which ends a stream of zlib: the JSON has it, so that readers notice the JSON
    of another file."""
    return int.from_bytes(data[-4:], "big")


def is_of_file(data: bytes, about: Mapping[str, Any]) -> bool:
    """Whether a file's bytes are those that the entry `file` of a JSON describes; older JSONs have no checksum."""
    return bool(len(data) == about["bytes"] and checksum(data) == about.get("adler32", checksum(data)))


def from_bytes(data: bytes, facts: Mapping[str, Any]) -> LightResponse:
    """The response of a file with its JSON. Raises KeyError, TypeError or ValueError for a JSON of another file, and
    for a file of another kind."""
    if not is_of_file(data, facts["file"]):
        raise ValueError("the JSON is that of another file")
    try:
        data = zlib.decompress(data)
    except zlib.error as error:
        raise ValueError(str(error)) from error
    arrays: dict[str, Any] = {}
    for name in _ARRAYS:
        about = facts["arrays"][name]
        count = int(np.prod(about["shape"]))
        dtype = np.dtype(about["type"]).newbyteorder("<")
        arrays[name] = np.frombuffer(data, dtype, count, about["start"]).reshape(about["shape"])
    response = LightResponse(
        np.array(facts["box_min"], float), np.array(facts["box_max"], float), highest=float(facts["highest"]),
        powers=np.array(facts["powers"], float), largest=np.array(facts["largest"], float), **arrays,
    )  # fmt: skip
    _check_shapes(response)
    return response


def _check_shapes(response: LightResponse) -> None:
    """Raises ValueError for arrays that do not belong together."""
    voxels, rank = len(response.cells), len(response.latents)
    fits = (
        response.latents.shape == (rank, voxels) and response.table.shape[1:] == (1 + rank, 3)
        and response.arriving.ndim == 2 and len(response.arriving) == voxels
        and response.surroundings.shape == (HARMONICS, 3, voxels)
        and response.largest.shape == (HARMONICS, 3) and response.distance.shape == response.nearest.shape
        and response.low.shape == response.high.shape == response.powers.shape == (3,)
        and response.nearest.max() < voxels and response.cells.max() < response.nearest.size
    )  # fmt: skip
    if not fits:
        raise ValueError("the arrays do not belong together")
