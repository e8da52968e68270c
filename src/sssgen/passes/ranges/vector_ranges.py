"""Ranges of vectors: components, their value numbers, and a bound on the Euclidean length."""

from __future__ import annotations

import math
from typing import NamedTuple

from sssgen.ir.contracts import Contract
from sssgen.ir.intervals import ANY, INF, Range, absolute, square


class Value(NamedTuple):
    """What is known of a value: of each scalar in it (a struct's fields and a matrix's columns one after another)."""

    parts: tuple[Range, ...]
    numbers: tuple[int, ...]
    length: Range = ANY
    """Of a vector of floats; what its components say counts besides."""
    texel: Contract | None = None
    """Of a texture: what its texels may be."""


def length_of(parts: tuple[Range, ...]) -> Range:
    """The length that the components allow."""
    if len(parts) == 1:
        return absolute(parts[0])
    low = math.sqrt(sum(part.gap * part.gap for part in parts))
    size = max(part.size for part in parts)
    if size == INF:
        return Range(low, INF)
    return Range(low, size * math.sqrt(sum((part.size / size) ** 2 for part in parts)) if size else 0.0)


def dot(x: Value, y: Value) -> Range:
    """By components, and by the lengths (Cauchy and Schwarz)."""
    if x.numbers == y.numbers:
        return square(x.length)
    total = Range(0.0, 0.0)
    for a, b in zip(x.parts, y.parts, strict=True):
        total = total + a * b
    most = x.length.high * y.length.high if x.length.high and y.length.high else 0.0
    return total.met(Range(-most, most)) if most < INF else total


def cross(x: Value, y: Value) -> tuple[list[Range], Range]:
    """Components, and the length."""
    a, b = x.parts, y.parts
    most = x.length.high * y.length.high if x.length.high and y.length.high else 0.0
    parts = [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    if most < INF:
        parts = [part.met(Range(-most, most)) for part in parts]
    return parts, Range(0.0, most)


def total_length(x: Range, y: Range) -> Range:
    """The length of a sum of vectors, by the triangle's inequality."""
    least = max(x.low - y.high, y.low - x.high, 0.0)
    return Range(least if least < INF else 0.0, x.high + y.high)
