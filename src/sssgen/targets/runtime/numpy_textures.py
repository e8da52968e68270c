"""Textures for Python printed from a shader: OpenGL's sampling rules, on NumPy arrays in the runtime's layout."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[Any]

# For each face of a cube (+x, -x, +y, -y, +z, -z) the directions of its s and t and its outward normal: the table of
# "Cube Map Texture Selection" in the OpenGL ES 3.0 specification.
_FACES = np.array(
    [
        [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
        [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
    ]
)


class _Read(NamedTuple):
    """The options of a filtered read."""

    layer: Array | None
    offset: Array | None
    reference: Array | None


class Texture:
    """An image to sample.

    `data` is (height, width, channels), (depth, height, width, channels), or for `dim="Cube"` (6, size, size,
    channels) with the faces +x, -x, +y, -y, +z, -z; row 0 is at v = 0. With `layers`, the first axis is for them.
    Missing channels read as 0, alpha as 1.
    Texel i of N has its centre at (i + 0.5)/N. `filter` is linear or nearest; `wrap` is repeat, clamp or mirror (a cube
    wraps over its edges; at a corner the missing texel is the mean of the other three). With `mipmaps`, each level is
    box-filtered from the previous one, and reads blend the two nearest levels; without, there is only level 0.
    Samples have the floating-point type of the coordinate. `kind` is that of the texels: float, or int or uint, which
    are only fetched. With `compare`, a read compares: 1 where the reference is at most the texel's first channel, else
    0, and filters that.
    """

    def __init__(
        self,
        data: npt.ArrayLike,
        filter: str = "linear",
        wrap: str = "repeat",
        dim: str = "",
        mipmaps: bool = False,
        *,
        layers: bool = False,
        kind: str = "float",
        compare: bool = False,
    ) -> None:
        data = np.asarray(data)
        self.layers, self.kind, self.compare = layers, kind, compare
        self.dim = dim or {3: "2D", 4: "3D"}.get(data.ndim - layers, "")
        if data.ndim - layers != {"2D": 3, "3D": 4, "Cube": 4}.get(self.dim) or not 1 <= data.shape[-1] <= 4:
            raise ValueError(f"data of shape {data.shape} does not fit a {self.dim or 'texture'}: see Texture")
        if self.dim == "Cube" and (data.shape[-4] != 6 or data.shape[-3] != data.shape[-2]):
            raise ValueError(f"a cube has 6 square faces, not {data.shape[:-1]}")
        if filter not in ("linear", "nearest") or wrap not in ("repeat", "clamp", "mirror"):
            raise ValueError(f"filter={filter!r}, wrap={wrap!r}: see Texture")
        self.filter, self.wrap = filter, wrap
        floating: np.dtype[Any] = np.result_type(data, np.float16)
        numbers = {"float": floating, "int": np.dtype(np.int32), "uint": np.dtype(np.uint32)}[kind]
        filled = np.zeros((*data.shape[:-1], 4), numbers)
        filled[..., 3] = 1
        filled[..., : data.shape[-1]] = data
        self.levels = [filled]
        while mipmaps and max(self.size(len(self.levels) - 1)) > 1:
            self.levels.append(self._halve(self.levels[-1]))

    @classmethod
    def of_levels(
        cls, levels: Sequence[npt.ArrayLike], filter: str = "linear", wrap: str = "repeat", dim: str = ""
    ) -> Texture:
        """A texture whose levels are given, each with half the side of the one before."""
        each = [cls(level, filter, wrap, dim) for level in levels]
        each[0].levels = [texture.levels[0] for texture in each]
        return each[0]

    @property
    def axes(self) -> int:
        """How many components a coordinate has, without that for the layer."""
        return 2 if self.dim == "2D" else 3

    def size(self, level: int = 0) -> tuple[int, ...]:
        """Width, height and, for 3D, depth of a level in texels."""
        shape: tuple[int, ...] = self.levels[level].shape[self._outer() : -1]
        return shape[::-1]

    def _outer(self) -> int:
        """How many axes precede those of the texels' places: for layers, for a cube's faces."""
        return self.layers + (self.dim == "Cube")

    def level(self, coord: Array, dx: Array, dy: Array) -> Array:
        """The level of detail, (n,), for a coordinate (without a layer) that changes by dx and dy from pixel to pixel.

        log2 of the longer of the two steps in texels; on a cube, of the step across the face's plane.
        """
        scale = np.array(self.size()).reshape(-1, 1)
        if self.dim == "Cube":
            scale = scale[:1] / (2.0 * np.abs(coord).max(axis=0))
        with np.errstate(all="ignore"):
            step = np.maximum(((dx * scale) ** 2).sum(axis=0), ((dy * scale) ** 2).sum(axis=0))
            level: Array = (0.5 * np.log2(step)).astype(coord.dtype)
        return level

    def sample(
        self, coord: Array, level: float | Array = 0.0, offset: Array | None = None, reference: Array | None = None
    ) -> Array:
        """The filtered texels, (4, n), at coordinates (2, n) or (3, n), one more for a layer; `level` is () or (n,).

        `offset`, (2, 1) or (3, 1), is in texels of each level. With a `reference`, () or (n,), the texels are 1 or 0.
        """
        coord, layer = self._layer(coord)
        read = _Read(layer, offset, reference)
        with np.errstate(all="ignore"):
            if len(self.levels) == 1:
                return self._sample(0, coord, read)
            detail = np.clip(np.asarray(level, coord.dtype), 0.0, len(self.levels) - 1)
            result = np.zeros((4, *np.broadcast_shapes(detail.shape, coord.shape[-1:])), coord.dtype)
            for number in range(len(self.levels)):
                weight = np.maximum(1.0 - np.abs(detail - number), 0.0)
                if weight.any():
                    result += weight * self._sample(number, coord, read)
            return result

    def nearest(self, coord: Array, offset: Array | None = None) -> Array:
        """The nearest texels of level 0, (4, n), as `sample` with this filter has them: those of integers stay so."""
        coord, layer = self._layer(coord)
        face = None
        if self.dim == "Cube":
            face, coord = _project(coord)
        with np.errstate(all="ignore"):
            low = [np.floor(part * side) for part, side in zip(coord, self.size(), strict=True)]
            return self._corner(0, low, (0,) * len(low), face, _Read(layer, offset, None))

    def gather(self, coord: Array, channel: int, offset: Array | None = None, reference: Array | None = None) -> Array:
        """One channel of the four texels, (4, n), that a linear filter reads at level 0, in this order:
        (0, 1), (1, 1), (1, 0), (0, 0). With a `reference`, () or (n,), they are 1 or 0."""
        coord, layer = self._layer(coord)
        face = None
        with np.errstate(all="ignore"):
            if self.dim == "Cube":
                face, coord = _project(coord)
            low = [np.floor(c * n - 0.5) for c, n in zip(coord, self.size(), strict=True)]
        read = _Read(layer, offset, reference)
        corners = [self._corner(0, low, corner, face, read) for corner in ((0, 1), (1, 1), (1, 0), (0, 0))]
        gathered = np.stack([texels[channel] for texels in corners])
        return gathered if gathered.dtype.kind in "iu" else gathered.astype(coord.dtype)  # integers stay so

    def fetch(self, place: Array, level: int = 0) -> Array:
        """The texels, (4, n), at integer places (2, n) or (3, n), one more for a layer; 0 outside of what exists."""
        if not 0 <= level < len(self.levels):
            return np.zeros_like(self.fetch(place))
        count = (len(self.levels[0]),) if self.layers else ()
        size = np.array((*self.size(level), *count)).reshape(-1, 1)
        inside = ((place >= 0) & (place < size)).all(axis=0)
        return np.where(inside, self._texels(level, list(np.clip(place, 0, size - 1))), 0)

    def _layer(self, coord: Array) -> tuple[Array, Array | None]:
        """The coordinate without its last component where that is the layer, and the layer."""
        if not self.layers:
            return coord, None
        return coord[:-1], np.clip(_integers(np.rint(coord[-1])), 0, len(self.levels[0]) - 1)

    def _texels(self, level: int, places: list[Array]) -> Array:
        """The texels at x, y, (z or face), (layer)."""
        return np.moveaxis(self.levels[level][tuple(places[::-1])], -1, 0)

    def _sample(self, level: int, coord: Array, read: _Read) -> Array:
        size = self.size(level)
        face = None
        if self.dim == "Cube":
            face, coord = _project(coord)
        base = [c * n - (0.5 if self.filter == "linear" else 0.0) for c, n in zip(coord, size, strict=True)]
        low = [np.floor(b) for b in base]
        if self.filter == "nearest":
            return self._corner(level, low, (0,) * len(base), face, read)
        result = np.zeros((4, *coord.shape[1:]), coord.dtype)
        corners = list(product((0, 1), repeat=len(base)))
        values = [self._corner(level, low, corner, face, read) for corner in corners]
        if face is not None:
            values = _with_cube_corners(values, corners, low, size[0])
        for corner, value in zip(corners, values, strict=True):
            weight = np.ones((), coord.dtype)
            for b, p, bit in zip(base, low, corner, strict=True):
                weight = weight * (b - p if bit else 1.0 - (b - p))
            result = result + weight * value
        return result

    def _corner(self, level: int, low: list[Array], corner: tuple[int, ...], face: Array | None, read: _Read) -> Array:
        """The texels, (4, n), of one corner of the filter from the lowest one, or their comparisons."""
        shift = np.zeros((len(low), 1), np.int64) if read.offset is None else read.offset
        places = [_integers(p) + bit + o for p, bit, o in zip(low, corner, shift, strict=True)]
        texels = self._wrap(level, places, face, read.layer)
        values = texels if self.kind != "float" else texels.astype(low[0].dtype)
        if read.reference is None:
            return values
        reference = np.clip(read.reference, 0.0, 1.0)  # as depths of fixed point do
        return np.where(reference <= values[:1], 1.0, 0.0).astype(values.dtype)

    def _wrap(self, level: int, places: list[Array], face: Array | None, layer: Array | None) -> Array:
        size = self.size(level)
        rest = [] if layer is None else [layer]
        if face is not None:
            return self._texels(level, [*_over_edges(places, size[0], face), *rest])
        wrapped = []
        for p, n in zip(places, size, strict=True):
            if self.wrap == "clamp":
                p = np.clip(p, 0, n - 1)
            elif self.wrap == "repeat":
                p = p % n
            else:
                p = np.minimum(p % (2 * n), 2 * n - 1 - p % (2 * n))
            wrapped.append(p)
        return self._texels(level, [*wrapped, *rest])

    def _halve(self, data: Array) -> Array:
        """The next level: each axis of N texels averaged into N // 2; an odd N shares its texels by area."""
        for axis in range(self._outer(), data.ndim - 1):
            data = np.moveaxis(data, axis, 0)
            count = len(data) // 2
            if len(data) > 1 and len(data) % 2 == 0:
                data = (data[::2] + data[1::2]) / 2
            elif len(data) > 1:
                i = np.arange(count).reshape(-1, *(1,) * (data.ndim - 1)).astype(data.dtype)
                data = (data[:-1:2] * (count - i) + data[1::2] * count + data[2::2] * (i + 1)) / len(data)
            data = np.moveaxis(data, 0, axis)
        return data


def cube_directions(side: int) -> Array:
    """The unit directions of the texels' centres of a cube map, (6, side, side, 3)."""
    at = (2.0 * np.arange(side) + 1.0) / side - 1.0
    t, s = np.meshgrid(at, at, indexing="ij")
    along = _FACES.astype(np.float64)[:, :, None, None, :]
    ways = along[:, 0] * s[..., None] + along[:, 1] * t[..., None] + along[:, 2]
    result: Array = ways / np.linalg.norm(ways, axis=-1, keepdims=True)
    return result


def _integers(number: Array) -> Array:
    """Whole floats as integers; NaN gives 0."""
    return np.nan_to_num(number).astype(np.int64)


def _project(direction: Array) -> tuple[Array, Array]:
    """The face that a direction hits, (n,), and the coordinates there in [0, 1], (2, n)."""
    along = np.einsum("fac,c...->fa...", _FACES.astype(direction.dtype), direction)
    face = np.argmax(np.nan_to_num(along[:, 2]), axis=0)
    s, t, m = np.take_along_axis(along, face[None, None], axis=0)[0]
    return face, np.stack([s / m, t / m]) * 0.5 + 0.5


def _with_cube_corners(values: list[Array], corners: list[tuple[int, ...]], low: list[Array], size: int) -> list[Array]:
    """The texels of a filter; one beyond a corner of the cube, where three faces meet, is the mean of the others."""
    total = sum(values[1:], values[0])
    filled = []
    for value, corner in zip(values, corners, strict=True):
        beyond = [(p + bit < 0) | (p + bit >= size) for p, bit in zip(low, corner, strict=True)]
        filled.append(np.where(beyond[0] & beyond[1], (total - value) / 3.0, value).astype(value.dtype))
    return filled


def _over_edges(places: list[Array], size: int, face: Array) -> list[Array]:
    """Texels that may be one beyond an edge of their face, as x, y and face of the neighbouring texels.

    The direction of the centre of a texel beyond the edge hits the neighbouring face inside the intended texel.
    """
    s, t = ((2.0 * p + 1.0) / size - 1.0 for p in places)
    axes = np.moveaxis(_FACES[face], 0, -1)
    face, coord = _project(axes[0] * s + axes[1] * t + axes[2])
    return [*(np.clip(c * size, 0, size - 1).astype(np.int64) for c in coord), face]
