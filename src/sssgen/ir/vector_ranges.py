"""Ranges of whole values: vectors with a bound on their Euclidean length, matrices, textures.

The first part is arithmetic. The second part has the ranges of builtins that are not componentwise, for the rows of
the intrinsic table: each takes the format and the values of the arguments, and returns the ranges of the result's
components (the caller takes as many as the result has) and of its length, with the rounding errors of the formula.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from sssgen.ir.formats import Format
from sssgen.ir.intervals import ANY, INF, UNIT, Range, absolute, hull, square, widened


class Contract(NamedTuple):
    """What an input may be: lowest and highest component, and greatest length of a vector (infinite: unknown)."""

    low: float
    high: float
    length: float = INF
    finite: bool = True
    """False for texels of a texture that holds data: a float format may hold NaN and infinity."""
    shortest: float = 0.0
    """The least length of a vector, or size of a number. `shortest` and `length` of a matrix are its stretch."""
    channels: tuple[Range, ...] = ()
    """The range of each channel of a texture, where they differ."""


LENGTH = 1.001
"""The greatest length of a direction. Interpolated normals are shorter than 1, missing ones 0."""


class Value(NamedTuple):
    """What is known of a value: of each scalar in it (a struct's fields and a matrix's columns one after another)."""

    parts: tuple[Range, ...]
    numbers: tuple[int, ...]
    length: Range = ANY
    """The length of a vector of floats; it holds in addition to what the components imply."""
    texel: Contract | None = None
    """The possible texels of a texture."""
    stretch: Range = ANY
    """How much longer a matrix makes a vector (of a 4×4 matrix: its first three rows and columns)."""
    head: Range = ANY
    """The length of the first three components of a vector of four."""


Result = tuple[list[Range], Range]
"""The ranges of a result's components and of its length (ANY: no more than the components imply)."""


def length_of(parts: Sequence[Range]) -> Range:
    """The length that the components allow."""
    if len(parts) == 1:
        return absolute(parts[0])
    low = math.sqrt(sum([part.gap * part.gap for part in parts]))
    sizes = [part.size for part in parts]
    largest = max(sizes)
    if largest == INF:
        return Range(low, INF)
    high = largest * math.sqrt(sum([(size / largest) ** 2 for size in sizes])) if largest else 0.0
    return Range(min(low, high), high)


def exact_dot(x: Value, y: Value) -> Range:
    """The unrounded dot product: from the components, and from the lengths (Cauchy-Schwarz)."""
    if x.numbers == y.numbers:
        return square(x.length)
    total = Range(0.0, 0.0)
    for a, b in zip(x.parts, y.parts, strict=True):
        total = total + a * b
    most = _length_product(x, y)
    return total.met(Range(-most, most)) if most < INF else total


def total_length(x: Range, y: Range) -> Range:
    """The length of a sum of vectors, by the triangle inequality."""
    least = max(x.low - y.high, y.low - x.high, 0.0)
    return Range(least if least < INF else 0.0, x.high + y.high)


def _length_product(x: Value, y: Value) -> float:
    return x.length.high * y.length.high if x.length.high and y.length.high else 0.0


def _terms(x: Value, y: Value) -> float:
    """The greatest size of a sum of some of the terms of a dot product, in any order."""
    products = [a.size * b.size if a.size and b.size else 0.0 for a, b in zip(x.parts, y.parts, strict=True)]
    return min(sum(products), _length_product(x, y))


def _overflow(format: Format, *sizes: float) -> bool:
    """Whether an intermediate result of one of these sizes may overflow, though the sum that follows may not."""
    return not max(sizes) * (1.0 + 2.0 * _slack(format)) <= format.largest


# Builtins


def all_within(low: float, high: float) -> Callable[..., Result]:
    """The range function of a builtin whose components always lie in one interval."""
    parts = [Range(low, high)] * 4
    return lambda F, *arguments: (parts, ANY)


def any_numbers(F: Format, *arguments: Value) -> Result:
    """The range of a builtin about whose result nothing is known."""
    return [ANY] * 16, ANY


def _slack(format: Format) -> float:
    """The error of a sum of up to four products, relative to the size of its terms."""
    return 8.0 * format.epsilon


def length(format: Format, x: Value) -> Result:
    return _rounded_length(format, x.length)


def distance(format: Format, x: Value, y: Value) -> Result:
    difference = tuple([a - b for a, b in zip(x.parts, y.parts, strict=True)])
    # each component of the difference rounds
    error = _slack(format) * (x.length.high + y.length.high)
    exact = length_of(difference).met(total_length(x.length, y.length))
    result = widened(exact, 0.0, error if error < INF else 0.0)
    return _rounded_length(format, Range(max(result.low, 0.0), result.high))


def _rounded_length(format: Format, length: Range) -> Result:
    # the squares in it may overflow, or be too small
    low = length.low if length.low > format.tiny**0.5 else 0.0
    high = INF if _overflow(format, length.high * length.high) else length.high
    return [widened(Range(low, high), _slack(format))], ANY


def dot(format: Format, x: Value, y: Value) -> Result:
    total, slack = exact_dot(x, y), _slack(format)
    if x.numbers == y.numbers:
        return [widened(total, slack)], ANY
    products = [a * b for a, b in zip(x.parts, y.parts, strict=True)]
    if all(part.low >= 0.0 for part in products) or len(products) == 1:
        return [widened(total, slack)], ANY
    size = _terms(x, y)
    return [ANY if _overflow(format, size) else widened(total, 0.0, slack * size + format.tiny)], ANY


def cross(format: Format, x: Value, y: Value) -> Result:
    a, b = x.parts, y.parts
    most = _length_product(x, y)
    parts = [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    length = Range(0.0, most)
    if _overflow(format, *[a[i].size * b[j].size for i in range(3) for j in range(3) if i != j]):
        return [ANY] * 3, ANY
    error = _slack(format) * most + format.tiny
    parts = [widened(part.met(Range(-most, most)), 0.0, error) for part in parts]
    return parts, widened(length, _slack(format), format.tiny)


def normalize(format: Format, x: Value) -> Result:
    slack = 2.0 * _slack(format)
    # beyond these limits the result is that of the guard, which may be shorter
    sure = x.length.low > format.square**0.5 and not _overflow(format, x.length.high * x.length.high)
    least = x.length.low if sure else 0.0
    parts = []
    for part in x.parts:
        low = max(part.low / least, -1.0) if least > 0.0 else -1.0
        high = min(part.high / least, 1.0) if least > 0.0 else 1.0
        low, high = (low if part.low < 0.0 else 0.0), (high if part.high > 0.0 else 0.0)
        parts.append(widened(Range(low, high), slack))
    return parts, Range(1.0 - slack if sure else 0.0, 1.0 + slack)


def faceforward(format: Format, x: Value, y: Value, z: Value) -> Result:
    return [part.joined(-part) for part in x.parts], x.length


def reflect(format: Format, x: Value, y: Value) -> Result:
    factor = exact_dot(y, x) * 2.0
    parts = [a - factor * b for a, b in zip(x.parts, y.parts, strict=True)]
    slack = 2.0 * _slack(format)
    terms = x.length.high * (1.0 + 2.0 * y.length.high * y.length.high)
    if _overflow(format, terms, 2.0 * _length_product(x, y)):
        return [ANY for _ in parts], ANY
    most = x.length.high if y.length.high <= 1.0 + slack else terms
    error = slack * terms + format.tiny
    return [widened(part.met(hull(-most, most)), 0.0, error) for part in parts], hull(0.0, most + 2.0 * error)


def refract(format: Format, x: Value, y: Value, z: Value) -> Result:
    eta = absolute(z.parts[0]).high
    cosine = absolute(exact_dot(y, x)).high
    terms = [_terms(x, y), cosine * cosine, eta * eta, eta * eta * (1.0 + cosine * cosine)]
    if _overflow(format, *terms):  # the square of the cosine, though times a small eta, as well
        return [ANY for _ in x.parts], ANY
    root = math.sqrt(1.0 + eta * eta * cosine * cosine)
    most = eta * x.length.high + (eta * cosine + root) * y.length.high
    if eta <= 1.0 and x.length.high <= LENGTH and y.length.high <= LENGTH:
        most = min(most, 2.3)
    most *= 1.0 + 4.0 * _slack(format)
    return [hull(-most, most) for _ in x.parts], hull(0.0, most * 2.0)


def outer_product(format: Format, x: Value, y: Value) -> Result:
    return [a * b for b in y.parts for a in x.parts], ANY


def transpose(format: Format, x: Value) -> Result:
    size = math.isqrt(len(x.parts))
    if size * size != len(x.parts):  # the number of its columns is not known here
        low, high = min(part.low for part in x.parts), max(part.high for part in x.parts)
        return [hull(low, high)] * len(x.parts), ANY
    return [x.parts[column * size + row] for row in range(size) for column in range(size)], ANY


def determinant(format: Format, x: Value) -> Result:
    size = math.isqrt(len(x.parts))
    largest = max(part.size for part in x.parts)
    most = math.factorial(size) * largest**size if largest < 1e60 else INF
    return [widened(hull(-most, most), 4.0 * _slack(format))], ANY


def inverse(format: Format, x: Value) -> Result:
    """Behind its guard: the cofactors, divided by a determinant that is not nearer to 0 than a guarded divisor."""
    size = math.isqrt(len(x.parts))
    largest = min(max(part.size for part in x.parts), 1e60)
    most = math.factorial(size - 1) * largest ** (size - 1)
    if _overflow(format, most / format.divisor, most * size * largest):
        return [ANY] * size**2, ANY
    return [widened(hull(-most, most) * (1.0 / format.divisor), 4.0 * _slack(format))] * size**2, ANY


def normal_of_texel(format: Format, x: Value) -> Result:
    return [part * 2.0 - 1.0 for part in x.parts[:3]], ANY


def texels(format: Format, x: Value, *coordinates: Value) -> Result:
    if x.texel is not None and x.texel.channels:
        return list(x.texel.channels), ANY
    texel = UNIT if x.texel is None else hull(x.texel.low, x.texel.high)
    return [texel] * 4, ANY
