"""The builtins that read textures or neighbouring lanes, for Python printed from a shader."""

from __future__ import annotations

import numpy as np

from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.runtime.numpy_values import Value, arrays, image_shape, working

# Texture reads; see `Texture`


def _level(level: Value) -> int:
    """The level of all lanes, taken from the first."""
    return int(np.ravel(level)[0])


def textureSize(texture: Texture, level: Value | None = None) -> Value:
    """The size of each lane's level, (k, n); a level that does not exist, undefined in GLSL, is the nearest one.

    A texture with samples has no levels; its samples are layers.
    """
    count = (len(texture.levels[0]),) if texture.layers and level is not None else ()
    level = 0 if level is None else level
    sizes = np.array([(*texture.size(index), *count) for index in range(len(texture.levels))], np.int32)
    return sizes[np.clip(np.ravel(level), 0, len(sizes) - 1)].T


def textureQueryLevels(texture: Texture) -> Value:
    return np.int32(len(texture.levels))


def textureQueryLod(texture: Texture, coord: Value) -> Value:
    """The level that is read, and the one that follows from the derivatives; needs a `grid`."""
    level = texture.level(coord, dFdx(coord), dFdy(coord))
    return np.stack([np.clip(level, 0.0, len(texture.levels) - 1), level])


def _by_derivatives(texture: Texture, coord: Value, bias: Value) -> Value:
    """The implicit level of a read. With mipmaps it needs a `grid`, for the derivatives."""
    if len(texture.levels) == 1:
        return 0.0
    place = coord[: texture.axes]
    return texture.level(place, dFdx(place), dFdy(place)) + bias


def _is_whole(texture: Texture) -> bool:
    """Whether its texels are integers, which have no filter: `ir.intrinsics.integer_reads`."""
    return texture.levels[0].dtype.kind in "iu"


def texture(texture: Texture, coord: Value, bias: Value = 0.0) -> Value:
    """With mipmaps it needs a `grid`, for the derivatives. For a texture that compares, the last component is the
    reference."""
    if texture.compare:
        return textureCompare(texture, coord[:-1], coord[-1])
    if _is_whole(texture):
        return texture.nearest(coord)
    return texture.sample(coord, _by_derivatives(texture, coord, bias))


def textureOffset(texture: Texture, coord: Value, offset: Value, bias: Value = 0.0) -> Value:
    """The offset is the same in all lanes."""
    if texture.compare:
        return textureCompareOffset(texture, coord[:-1], coord[-1], offset)
    if _is_whole(texture):
        return texture.nearest(coord, _first(offset))
    return texture.sample(coord, _by_derivatives(texture, coord, bias), _first(offset))


def textureLod(texture: Texture, coord: Value, level: Value) -> Value:
    if texture.compare:
        return textureCompareLod(texture, coord[:-1], coord[-1])
    if _is_whole(texture):
        return texture.nearest(coord)
    return texture.sample(coord, level)


def textureLodOffset(texture: Texture, coord: Value, level: Value, offset: Value) -> Value:
    """The offset is the same in all lanes."""
    if texture.compare:
        return textureCompareLodOffset(texture, coord[:-1], coord[-1], offset)
    if _is_whole(texture):
        return texture.nearest(coord, _first(offset))
    return texture.sample(coord, level, _first(offset))


def textureGrad(texture: Texture, coord: Value, dx: Value, dy: Value) -> Value:
    if texture.compare:
        return textureCompareLod(texture, coord[:-1], coord[-1])
    if _is_whole(texture):
        return texture.nearest(coord)
    return texture.sample(coord, texture.level(coord[: texture.axes], dx, dy))


def textureGradOffset(texture: Texture, coord: Value, dx: Value, dy: Value, offset: Value) -> Value:
    """The offset is the same in all lanes."""
    if texture.compare:
        return textureCompareLodOffset(texture, coord[:-1], coord[-1], offset)
    if _is_whole(texture):
        return texture.nearest(coord, _first(offset))
    return texture.sample(coord, texture.level(coord[: texture.axes], dx, dy), _first(offset))


def texelFetch(texture: Texture, place: Value, level: Value) -> Value:
    """The level is the same in all lanes; 0 outside of it. In the working precision.

    A texture with samples has them as layers, and a sample in place of the level.
    """
    if texture.layers and len(place) == 2:
        place, level = np.array(np.broadcast_arrays(*place, level)), 0
    texels = texture.fetch(place, _level(level))
    return texels if texels.dtype.kind in "iu" else texels.astype(working())


def texelFetchOffset(texture: Texture, place: Value, level: Value, offset: Value) -> Value:
    place = np.array(np.broadcast_arrays(*place, *offset)[: len(place)])
    place[: len(offset)] += offset
    return texelFetch(texture, place, level)


def textureGather(texture: Texture, coord: Value, channel_or_reference: Value = 0) -> Value:
    """At level 0. The channel is the same in all lanes; a texture that compares has a reference."""
    return _gather(texture, coord, channel_or_reference, None)


def textureGatherOffset(texture: Texture, coord: Value, first: Value, second: Value = 0) -> Value:
    """The offset, which is the same in all lanes, precedes the channel, and follows the reference."""
    offset, rest = (second, first) if texture.compare else (first, second)
    return _gather(texture, coord, rest, _first(offset))


def _gather(texture: Texture, coord: Value, channel_or_reference: Value, offset: Value | None) -> Value:
    if texture.compare:
        return texture.gather(coord, 0, offset, np.asarray(channel_or_reference, coord.dtype))
    return texture.gather(coord, _level(channel_or_reference), offset)


def _first(offset: Value) -> Value:
    """The offset of all lanes, (2, 1) or (3, 1), taken from the first."""
    return np.asarray(offset).reshape(len(offset), -1)[:, :1]


# Layers and references as separate arguments


def textureLayer(texture: Texture, coord: Value, layer: Value, bias: Value = 0.0) -> Value:
    coordinates = _with(coord, layer)
    return texture.sample(coordinates, _by_derivatives(texture, coordinates, bias))


def textureLayerLod(texture: Texture, coord: Value, layer: Value, level: Value) -> Value:
    return texture.sample(_with(coord, layer), level)


def textureLayerGrad(texture: Texture, coord: Value, layer: Value, dx: Value, dy: Value) -> Value:
    return texture.sample(_with(coord, layer), texture.level(coord, dx, dy))


def texelFetchLayer(texture: Texture, place: Value, layer: Value, level: Value) -> Value:
    return texelFetch(texture, _with(place, layer), level)


def textureCompare(texture: Texture, coord: Value, *rest: Value) -> Value:
    """At level 0, the only one of depth textures here. `rest`: a layer where there are layers, then the reference."""
    *layer, reference = rest
    return _compare(texture, _with(coord, *layer), reference, None)


textureCompareLod = textureCompare


def textureLayerOffset(texture: Texture, coord: Value, layer: Value, offset: Value, bias: Value = 0.0) -> Value:
    return textureOffset(texture, _with(coord, layer), offset, bias)


def textureLayerLodOffset(texture: Texture, coord: Value, layer: Value, level: Value, offset: Value) -> Value:
    return textureLodOffset(texture, _with(coord, layer), level, offset)


def textureLayerGradOffset(texture: Texture, coord: Value, layer: Value, dx: Value, dy: Value, offset: Value) -> Value:
    return textureGradOffset(texture, _with(coord, layer), dx, dy, offset)


def textureCompareOffset(texture: Texture, coord: Value, *rest: Value) -> Value:
    """`rest`: a layer where there are layers, then the reference and the offset."""
    *layer, reference, offset = rest
    return _compare(texture, _with(coord, *layer), reference, _first(offset))


textureCompareLodOffset = textureCompareOffset


def textureGatherLayer(texture: Texture, coord: Value, layer: Value, channel_or_reference: Value = 0) -> Value:
    return textureGather(texture, _with(coord, layer), channel_or_reference)


def textureGatherLayerOffset(texture: Texture, coord: Value, layer: Value, first: Value, second: Value = 0) -> Value:
    return textureGatherOffset(texture, _with(coord, layer), first, second)


def _compare(texture: Texture, coord: Value, reference: Value, offset: Value | None) -> Value:
    return texture.sample(coord, 0.0, offset, np.asarray(reference, coord.dtype))[0]


def _with(coord: Value, *more: Value) -> Value:
    """A coordinate with more components."""
    lanes = np.broadcast_shapes(coord.shape[-1:], *(np.shape(component)[-1:] for component in more))
    parts = [np.broadcast_to(np.asarray(component).astype(coord.dtype), lanes) for component in (*coord, *more)]
    return np.stack(parts)


# Derivatives: differences within quads of 2×2 pixels, row by row and column by column (the "fine" ones)


def _difference(name: str, value: Value, axis: int) -> Value:
    shape = image_shape.get()
    if shape is None:
        raise RuntimeError(f"{name} needs neighbours: name the image's size, `with grid(height, width):`")
    (value,) = arrays((value,))
    if value.ndim == 0 or value.shape[-1] == 1 != shape[0] * shape[1]:
        return np.zeros_like(value)
    if value.shape[-1] != shape[0] * shape[1]:
        raise ValueError(f"{name}: {value.shape[-1]} lanes are not an image of {shape[0]}×{shape[1]}")
    image = np.moveaxis(value.reshape(*value.shape[:-1], *shape), axis, -1)
    count = image.shape[-1]
    if count == 1:
        return np.zeros_like(value)
    first = np.minimum(np.arange(count) // 2 * 2, count - 2)
    with np.errstate(all="ignore"):
        difference = image[..., first + 1] - image[..., first]
    return np.moveaxis(difference, -1, axis).reshape(value.shape)


def dFdx(x: Value) -> Value:
    """From left to right. At an odd width the last column takes its left neighbour."""
    return _difference("dFdx", x, -1)


def dFdy(x: Value) -> Value:
    """From bottom to top, as in OpenGL. At an odd height the last row takes the one below it."""
    return _difference("dFdy", x, -2)


def fwidth(x: Value) -> Value:
    return np.abs(_difference("fwidth", x, -1)) + np.abs(_difference("fwidth", x, -2))


dFdxFine = dFdxCoarse = dFdx
dFdyFine = dFdyCoarse = dFdy
fwidthFine = fwidthCoarse = fwidth
