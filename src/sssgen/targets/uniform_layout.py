"""The layout of a uniform block.

std140 (OpenGL 4.6, section 7.6.2.2) is the rule that every API can be made to follow: WGSL's own alignment gives the
same offsets for these types, and HLSL's packing does with explicit padding where it packs tighter. Metal's structs are
those of C with the vectors of Apple's header simd: three numbers take the place of four.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Array, Matrix, Sampler, Struct, Type, column_size, components, kind_of


class Member(NamedTuple):
    """A uniform in its block: byte offset and size, and how many 4-byte words of padding HLSL needs before it."""

    uniform: Uniform
    offset: int
    size: int
    padding: int


def place(uniforms: Sequence[Uniform], rule: str) -> tuple[list[Member], int]:
    """The members of a block in order, and its size in bytes. Textures are left out."""
    if rule == "simd":
        return _as_simd(uniforms)
    members: list[Member] = []
    end = 0
    for uniform in uniforms:
        if isinstance(uniform.type, Sampler):
            continue
        size = _size(uniform.type)
        packed = _hlsl_offset(end, uniform.type, size)
        offset = packed if rule == "hlsl" else _align(end, _alignment(uniform.type))
        padding = (offset - packed) // 4 if rule == "std140" else 0
        members.append(Member(uniform, offset, size, padding))
        end = offset + (size if rule == "hlsl" else _std140_size(uniform.type, size))
    return members, _align(end, 16)


def _as_simd(uniforms: Sequence[Uniform]) -> tuple[list[Member], int]:
    members: list[Member] = []
    end, largest = 0, 1
    for uniform in uniforms:
        if isinstance(uniform.type, Sampler):
            continue
        size, alignment = _simd_size(uniform.type)
        members.append(Member(uniform, _align(end, alignment), size, 0))
        end, largest = members[-1].offset + size, max(largest, alignment)
    return members, _align(end, largest)


def _simd_size(type_: Type) -> tuple[int, int]:
    """The size and the alignment."""
    if isinstance(type_, Array):
        size, alignment = _simd_size(type_.element)
        return size * type_.length, alignment
    count = column_size(type_)
    width = (1 if kind_of(type_) == "bool" else 4) * (4 if count == 3 else count)
    return (width * type_.columns if isinstance(type_, Matrix) else width), width


def _align(offset: int, alignment: int) -> int:
    return (offset + alignment - 1) // alignment * alignment


def _alignment(type_: Type) -> int:
    if isinstance(type_, Matrix | Array | Struct):
        return 16
    return {1: 4, 2: 8, 3: 16, 4: 16}[components(type_)]


def _size(type_: Type) -> int:
    """How many bytes hold values."""
    if isinstance(type_, Matrix):
        return 16 * (type_.columns - 1) + 4 * type_.rows
    if isinstance(type_, Array):
        stride = 16 * type_.element.columns if isinstance(type_.element, Matrix) else 16
        return stride * (type_.length - 1) + _size(type_.element)
    return 4 * components(type_)


def _std140_size(type_: Type, size: int) -> int:
    return _align(size, 16) if isinstance(type_, Matrix | Array) else size


def _hlsl_offset(end: int, type_: Type, size: int) -> int:
    """HLSL packs into 16-byte rows: a value does not cross a row's end; matrices and arrays start a row."""
    if isinstance(type_, Matrix | Array):
        return _align(end, 16)
    return _align(end, 16) if end % 16 + size > 16 else end


def padding(members: Sequence[Member]) -> int:
    """How many floats behind the last member make the size of the block a multiple of 16 bytes."""
    return -(members[-1].offset + members[-1].size) % 16 // 4 if members else 0
