"""The builtins that work on bits, for Python printed from a shader: bits of floats, packing, integers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from sssgen.targets.runtime.numpy_values import Value, silent, to_int, to_uint, working

# Bits of floats


@silent
def floatBitsToInt(x: Value) -> Value:
    """The bits of x rounded to float32."""
    return x.astype(np.float32).view(np.int32)


@silent
def floatBitsToUint(x: Value) -> Value:
    """The bits of x rounded to float32."""
    return x.astype(np.float32).view(np.uint32)


@silent
def intBitsToFloat(x: Value) -> Value:
    return x.astype(np.int32).view(np.float32).astype(working())


@silent
def uintBitsToFloat(x: Value) -> Value:
    return x.astype(np.uint32).view(np.float32).astype(working())


# Packing; the first component goes into the low bits


def _shifts(size: int) -> Value:
    """The offsets of the parts of a uint, each of `size` bits."""
    return (size * np.arange(32 // size)).astype(np.uint32)


def _pack(parts: Value) -> Value:
    """A uint of the components' low bits: 16 bits each if there are two, 8 bits if there are four."""
    size = 32 // len(parts)
    low = parts.astype(np.int64).astype(np.uint32) & np.uint32((1 << size) - 1)
    shifts = _shifts(size).reshape(-1, *(1,) * (low.ndim - 1))
    return np.bitwise_or.reduce(low << shifts, axis=0)


def _unpack(x: Value, dtype: npt.DTypeLike) -> Value:
    """The components, (2, n) or (4, n), of this type."""
    size = 8 * np.dtype(dtype).itemsize
    parts = (np.asarray(x).astype(np.uint32).reshape(1, -1) >> _shifts(size)[:, None]) & np.uint32((1 << size) - 1)
    return parts.astype(f"u{size // 8}").view(dtype)


def _signed(x: Value, most: float) -> Value:
    return _pack(np.rint(np.clip(x.astype(np.float64), -1.0, 1.0) * most))


def _unsigned(x: Value, most: float) -> Value:
    return _pack(np.rint(np.clip(x.astype(np.float64), 0.0, 1.0) * most))


@silent
def packSnorm2x16(x: Value) -> Value:
    return _signed(x, 32767.0)


@silent
def packUnorm2x16(x: Value) -> Value:
    return _unsigned(x, 65535.0)


@silent
def packSnorm4x8(x: Value) -> Value:
    return _signed(x, 127.0)


@silent
def packUnorm4x8(x: Value) -> Value:
    return _unsigned(x, 255.0)


@silent
def packHalf2x16(x: Value) -> Value:
    """Rounds to the nearest float16."""
    return _pack(x.astype(np.float16).view(np.uint16))


def unpackSnorm2x16(x: Value) -> Value:
    return np.maximum(_unpack(x, np.int16) / 32767.0, -1.0).astype(working())


def unpackUnorm2x16(x: Value) -> Value:
    return (_unpack(x, np.uint16) / 65535.0).astype(working())


def unpackSnorm4x8(x: Value) -> Value:
    return np.maximum(_unpack(x, np.int8) / 127.0, -1.0).astype(working())


def unpackUnorm4x8(x: Value) -> Value:
    return (_unpack(x, np.uint8) / 255.0).astype(working())


def unpackHalf2x16(x: Value) -> Value:
    return _unpack(x, np.float16).astype(working())


# 8.8 of GLSL 4.60: integers


@silent
def bitCount(x: Value) -> Value:
    bits = to_uint(x)
    bits = bits - (bits >> 1 & 0x55555555)
    bits = (bits & 0x33333333) + (bits >> 2 & 0x33333333)
    bits = bits + (bits >> 4) & 0x0F0F0F0F
    return to_int(bits % np.uint32(255))


@silent
def findLSB(x: Value) -> Value:
    bits = to_uint(x)
    return np.where(bits == 0, np.int32(-1), bitCount(~bits & (bits - np.uint32(1))))


@silent
def findMSB(x: Value) -> Value:
    """For a negative int, the highest bit that is 0."""
    bits = to_uint(x ^ (x >> 31) if x.dtype.kind == "i" else x)
    for step in (1, 2, 4, 8, 16):
        bits = bits | bits >> step
    return bitCount(bits) - np.int32(1)


@silent
def bitfieldReverse(x: Value) -> Value:
    bits = to_uint(x)
    for step, mask in ((1, 0x55555555), (2, 0x33333333), (4, 0x0F0F0F0F), (8, 0x00FF00FF), (16, 0x0000FFFF)):
        bits = bits >> step & mask | (bits & mask) << step
    return bits.astype(x.dtype)


@silent
def bitfieldExtract(x: Value, offset: Value, bits: Value) -> Value:
    """Undefined outside of 0 to 32."""
    offset, bits = _places(offset, bits)
    field = x.astype(np.int64) >> offset & (1 << bits) - 1
    if x.dtype.kind == "i":
        field = field - ((field >> np.maximum(bits - 1, 0) & 1) << bits)
    return field.astype(x.dtype)


@silent
def bitfieldInsert(x: Value, inserted: Value, offset: Value, bits: Value) -> Value:
    """Undefined outside of 0 to 32."""
    offset, bits = _places(offset, bits)
    mask = (1 << bits) - 1 << offset
    return (x.astype(np.int64) & ~mask | inserted.astype(np.int64) << offset & mask).astype(x.dtype)


def _places(*values: Value) -> list[Value]:
    return [np.clip(value.astype(np.int64), 0, 32) for value in values]
