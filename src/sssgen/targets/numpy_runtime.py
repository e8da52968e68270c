"""What Python printed from a shader calls: the builtins here, and from `numpy_values` the constructors and operators.

Each function of the intrinsic table has the builtin's own name (`not_` for `not`), and so hides Python's here. The
semantics are those of GLSL ES 3.00; where it leaves a result open, the function says what it gives.
"""

from __future__ import annotations

from math import pi

import numpy as np
import numpy.typing as npt

from .numpy_textures import Texture
from .numpy_values import *
from .numpy_values import Value, arrays, image_shape, silent, working

# 8.1 and 8.2 Trigonometry and exponentials: NumPy's own functions, outside their domain NaN or infinite

sin, cos, tan = silent(np.sin), silent(np.cos), silent(np.tan)
asin, acos = silent(np.arcsin), silent(np.arccos)
sinh, cosh, tanh = silent(np.sinh), silent(np.cosh), silent(np.tanh)
asinh, acosh, atanh = silent(np.arcsinh), silent(np.arccosh), silent(np.arctanh)
pow, exp, log, exp2, log2 = map(silent, (np.power, np.exp, np.log, np.exp2, np.log2))
sqrt = silent(np.sqrt)


@silent
def radians(x: Value) -> Value:
    return x * (pi / 180.0)


@silent
def degrees(x: Value) -> Value:
    return x * (180.0 / pi)


@silent
def atan(x: Value, y: Value = None) -> Value:
    return np.arctan(x) if y is None else np.arctan2(x, y)


@silent
def inversesqrt(x: Value) -> Value:
    return 1.0 / np.sqrt(x)


# 8.3 Common

abs, sign = silent(np.abs), silent(np.sign)
floor, ceil, trunc = silent(np.floor), silent(np.ceil), silent(np.trunc)
round = roundEven = silent(np.rint)
isnan, isinf = silent(np.isnan), silent(np.isinf)


@silent
def fract(x: Value) -> Value:
    return x - np.floor(x)


@silent
def mod(x: Value, y: Value) -> Value:
    return x - y * np.floor(x / y)


@silent
def fmod(x: Value, y: Value) -> Value:
    return x - y * np.trunc(x / y)


@silent
def min(x: Value, y: Value) -> Value:
    """x where one is NaN, by the specification's formula."""
    return np.where(y < x, y, x)


@silent
def max(x: Value, y: Value) -> Value:
    """x where one is NaN, by the specification's formula."""
    return np.where(x < y, y, x)


def clamp(x: Value, y: Value, z: Value) -> Value:
    """min(max(x, y), z) also for y > z; NaN stays NaN."""
    return min(max(x, y), z)


def saturate(x: Value) -> Value:
    return clamp(x, 0.0, 1.0)


@silent
def unpackNormal(texel: Value) -> Value:
    return texel[:3] * 2.0 - 1.0


@silent
def mix(x: Value, y: Value, a: Value) -> Value:
    return np.where(a, y, x) if a.dtype.kind == "b" else x * (1.0 - a) + y * a


@silent
def step(edge: Value, x: Value) -> Value:
    return (~(x < edge)).astype(x.dtype)


@silent
def smoothstep(x: Value, y: Value, z: Value) -> Value:
    """By the formula also for x >= y, where GLSL leaves it open; NaN where z = x = y."""
    t = clamp((z - x) / (y - x), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@silent
def floatBitsToInt(x: Value) -> Value:
    """Of x rounded to float32."""
    return x.astype(np.float32).view(np.int32)


@silent
def floatBitsToUint(x: Value) -> Value:
    """Of x rounded to float32."""
    return x.astype(np.float32).view(np.uint32)


@silent
def intBitsToFloat(x: Value) -> Value:
    return x.astype(np.int32).view(np.float32).astype(working())


@silent
def uintBitsToFloat(x: Value) -> Value:
    return x.astype(np.uint32).view(np.float32).astype(working())


# 8.4 Packing


def _pack(words: Value) -> Value:
    low, high = words.astype(np.int64).astype(np.uint32) & np.uint32(0xFFFF)
    return low | high << np.uint32(16)


def _unpack(x: Value, dtype: npt.DTypeLike) -> Value:
    x = np.asarray(x).astype(np.uint32)
    words = np.stack([x & np.uint32(0xFFFF), x >> np.uint32(16)]).astype(np.uint16)
    return words.reshape(2, -1).view(dtype)


@silent
def packSnorm2x16(x: Value) -> Value:
    return _pack(np.rint(np.clip(x.astype(np.float64), -1.0, 1.0) * 32767.0))


@silent
def packUnorm2x16(x: Value) -> Value:
    return _pack(np.rint(np.clip(x.astype(np.float64), 0.0, 1.0) * 65535.0))


@silent
def packHalf2x16(x: Value) -> Value:
    """Rounds to the nearest float16."""
    return _pack(x.astype(np.float16).view(np.uint16))


def unpackSnorm2x16(x: Value) -> Value:
    return np.maximum(_unpack(x, np.int16) / 32767.0, -1.0).astype(working())


def unpackUnorm2x16(x: Value) -> Value:
    return (_unpack(x, np.uint16) / 65535.0).astype(working())


def unpackHalf2x16(x: Value) -> Value:
    return _unpack(x, np.float16).astype(working())


# 8.5 Geometry


def _dot(x: Value, y: Value) -> Value:
    product = x * y
    return np.add.reduce(product, axis=0) if product.ndim > 1 else product


dot = silent(_dot)


@silent
def length(x: Value) -> Value:
    return np.sqrt(_dot(x, x))


@silent
def distance(x: Value, y: Value) -> Value:
    return np.sqrt(_dot(x - y, x - y))


def _cross(x: Value, y: Value) -> Value:
    return x[[1, 2, 0]] * y[[2, 0, 1]] - y[[1, 2, 0]] * x[[2, 0, 1]]


cross = silent(_cross)


@silent
def normalize(x: Value) -> Value:
    """NaN for the zero vector."""
    return x / np.sqrt(_dot(x, x))


@silent
def faceforward(x: Value, y: Value, z: Value) -> Value:
    return np.where(_dot(z, y) < 0.0, x, -x)


@silent
def reflect(x: Value, y: Value) -> Value:
    return x - 2.0 * _dot(y, x) * y


@silent
def refract(x: Value, y: Value, z: Value) -> Value:
    c = _dot(y, x)
    k = 1.0 - z * z * (1.0 - c * c)
    return np.where(k < 0.0, z.dtype.type(0), z * x - (z * c + np.sqrt(k)) * y)


# 8.6 Matrices

matrixCompMult = silent(np.multiply)


@silent
def outerProduct(x: Value, y: Value) -> Value:
    return x * y[:, None]


def transpose(x: Value) -> Value:
    return np.swapaxes(x, 0, 1)


@silent
def determinant(x: Value) -> Value:
    """By expansion along the first column."""
    return _dot(x[0], _cofactors(x)[0])


@silent
def inverse(x: Value) -> Value:
    """Infinite or NaN where the determinant is 0."""
    cofactors = _cofactors(x)
    return transpose(cofactors) * (1.0 / _dot(x[0], cofactors[0]))


def _cofactors(x: Value) -> Value:
    """The matrix of signed minors, laid out as x."""
    size = len(x)
    if size == 2:
        return np.stack([np.stack([x[1, 1], -x[1, 0]]), np.stack([-x[0, 1], x[0, 0]])])
    if size == 3:
        return np.stack([_cross(x[1], x[2]), _cross(x[2], x[0]), _cross(x[0], x[1])])
    minors = [[(-1) ** (i + j) * _minor(x, i, j) for j in range(size)] for i in range(size)]
    return np.stack([np.stack(column) for column in minors])


def _minor(x: Value, column: int, row: int) -> Value:
    rest = np.delete(np.delete(x, column, axis=0), row, axis=1)
    return _dot(rest[0], _cross(rest[1], rest[2]))


# 8.7 Vector relations

lessThan, lessThanEqual = silent(np.less), silent(np.less_equal)
greaterThan, greaterThanEqual = silent(np.greater), silent(np.greater_equal)
equal, notEqual, not_ = silent(np.equal), silent(np.not_equal), silent(np.logical_not)


def any(x: Value) -> Value:
    return np.logical_or.reduce(x, axis=0)


def all(x: Value) -> Value:
    return np.logical_and.reduce(x, axis=0)


# 8.8 Texture reads; see `Texture` for what they do


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


# 8.9 Derivatives: differences within quads of 2×2 pixels, row by row and column by column (the "fine" ones)


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
