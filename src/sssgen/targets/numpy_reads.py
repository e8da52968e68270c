"""The builtins that look at textures or neighbours, for Python printed from a shader."""

from __future__ import annotations

import numpy as np

from .numpy_textures import Texture
from .numpy_values import Value, arrays, image_shape, working

__all__ = [
    "dFdx",
    "dFdxCoarse",
    "dFdxFine",
    "dFdy",
    "dFdyCoarse",
    "dFdyFine",
    "fwidth",
    "fwidthCoarse",
    "fwidthFine",
    "texelFetch",
    "texture",
    "textureGrad",
    "textureLod",
    "textureSize",
]

# Texture reads; see `Texture` for what they do


def _level(level: Value) -> int:
    """The level of all lanes: that of the first."""
    return int(np.ravel(level)[0])


def textureSize(texture: Texture, level: Value) -> Value:
    """Of one level for all lanes."""
    return np.array(texture.size(_level(level)), np.int32)[:, None]


def texture(texture: Texture, coord: Value, bias: Value = 0.0) -> Value:
    """With mipmaps it needs a `grid`, from whose derivatives the level comes."""
    if len(texture.levels) == 1:
        return texture.sample(coord)
    return texture.sample(coord, texture.level(coord, dFdx(coord), dFdy(coord)) + bias)


def textureLod(texture: Texture, coord: Value, level: Value) -> Value:
    return texture.sample(coord, level)


def textureGrad(texture: Texture, coord: Value, dx: Value, dy: Value) -> Value:
    return texture.sample(coord, texture.level(coord, dx, dy))


def texelFetch(texture: Texture, place: Value, level: Value) -> Value:
    """Of one level for all lanes; 0 outside of it. In the working precision."""
    return texture.fetch(place, _level(level)).astype(working())


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
