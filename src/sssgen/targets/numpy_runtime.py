"""The functions that Python printed from a shader calls: builtins here, constructors and operators in `numpy_values`.

Each function of the intrinsic table has the builtin's own name (`not_` for `not`), and so hides Python's here; those of
bits are in `numpy_bits`, texture reads and derivatives in `numpy_reads`. The semantics are those of GLSL; where it
leaves a result undefined, the docstring states it.
"""

from __future__ import annotations

from math import pi

import numpy as np

from sssgen.targets.runtime.numpy_bits import *
from sssgen.targets.runtime.numpy_reads import *
from sssgen.targets.runtime.numpy_textures import Texture as Texture
from sssgen.targets.runtime.numpy_values import *
from sssgen.targets.runtime.numpy_values import Value, silent

# 8.1 and 8.2 Trigonometry and exponentials: NumPy's own functions, NaN or infinity outside of their domain

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


def _min(x: Value, y: Value) -> Value:
    """x where one is NaN, by the specification's formula."""
    return np.where(y < x, y, x)


def _max(x: Value, y: Value) -> Value:
    """x where one is NaN, by the specification's formula."""
    return np.where(x < y, y, x)


min, max = silent(_min), silent(_max)


@silent
def clamp(x: Value, y: Value, z: Value) -> Value:
    """min(max(x, y), z) also for y > z; NaN stays NaN."""
    return _min(_max(x, y), z)


def saturate(x: Value) -> Value:
    return clamp(x, 0.0, 1.0)


@silent
def unpackNormal(texel: Value) -> Value:
    return texel[:3] * 2.0 - 1.0


@silent
def fma(x: Value, y: Value, z: Value) -> Value:
    """Rounded twice."""
    return x * y + z


@silent
def ldexp(x: Value, exponent: Value) -> Value:
    return np.ldexp(x, exponent.astype(np.int32))


@silent
def mix(x: Value, y: Value, a: Value) -> Value:
    return np.where(a, y, x) if a.dtype.kind == "b" else x * (1.0 - a) + y * a


@silent
def step(edge: Value, x: Value) -> Value:
    return (~(x < edge)).astype(x.dtype)


@silent
def smoothstep(x: Value, y: Value, z: Value) -> Value:
    """By the formula also for x >= y, where GLSL leaves the result undefined; NaN where z = x = y."""
    t = clamp((z - x) / (y - x), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


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
    """Infinity or NaN where the determinant is 0."""
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
