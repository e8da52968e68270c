"""Where the uniforms of a program are in the uniform buffers of WebGL, which an engine fills by itself.

A target has one block of its own for all uniforms. So a buffer of the source is taken apart: each uniform states its
place there, in the layout std140 (OpenGL ES 3.0, section 2.12.6.4), which WebGL 2 has in place of all others.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sssgen.ir.nodes import Module, Uniform
from sssgen.ir.types import Array, Matrix, Struct, Type
from sssgen.passes.stage.storage_layout import extent, offsets
from sssgen.targets.reflection_record import SourcePlace

RULE = "std140"


class Member(NamedTuple):
    """A member of a block of the source, in bytes; the matrices in `type` have the columns that are stored."""

    offset: int
    type: Type


def block_members(module: Module) -> dict[tuple[str, str], Member]:
    """The members of all blocks, by the block's name and the uniform's: also those that no function reads."""
    members: dict[tuple[str, str], Member] = {}
    for block in dict.fromkeys(uniform.block for uniform in module.uniforms if uniform.block):
        own = [uniform for uniform in module.uniforms if uniform.block == block]
        types = [_transpose(uniform.type) if uniform.row_major else uniform.type for uniform in own]
        end = 0
        for uniform, type_ in zip(own, types, strict=True):
            place = extent(type_, RULE)
            offset = -(-end // place.alignment) * place.alignment
            members[block, uniform.source] = Member(offset, type_)
            end = offset + place.size
    return members


def place_in_block(uniform: Uniform, members: Mapping[tuple[str, str], Member]) -> SourcePlace:
    """The place of a uniform in its `block` of the source; nothing for one that is in none.

    `strides` are those of its arrays, the outermost first; a matrix has `matrix_stride` between its columns, or between
    its rows if it is `row_major`. All are in bytes.
    """
    if not uniform.block:
        return {}
    root = next(name for block, name in members if block == uniform.block and _is_in(uniform.source, name))
    offset, type_ = members[uniform.block, root]
    strides: list[int] = []
    steps = uniform.source[len(root) :].replace("[", ".[").split(".")[1:]
    for step in steps:
        if isinstance(type_, Struct):
            index = [field.name for field in type_.fields].index(step)
            offset += offsets(type_, RULE)[index]
            type_ = type_.fields[index].type
        else:
            assert isinstance(type_, Array)
            strides.append(extent(type_, RULE).stride)
            type_ = type_.element
    if isinstance(type_, Array):
        strides.append(extent(type_, RULE).stride)
        type_ = type_.element
    stride = extent(type_, RULE).stride if isinstance(type_, Matrix) else 0
    return {
        "block": {
            "name": uniform.block, "offset": offset, "strides": strides,
            "matrix_stride": stride, "row_major": uniform.row_major and stride > 0,
        }
    }  # fmt: skip


def _is_in(name: str, root: str) -> bool:
    return name.startswith(root) and name[len(root) : len(root) + 1] in ("", ".", "[")


def _transpose(type_: Type) -> Type:
    """The type with rows in place of columns: how matrices are stored that are stored by rows."""
    if isinstance(type_, Matrix):
        return type_._replace(columns=type_.rows, rows=type_.columns)
    if isinstance(type_, Array):
        return type_._replace(element=_transpose(type_.element))
    if isinstance(type_, Struct):
        fields = [field._replace(type=_transpose(field.type)) for field in type_.fields]
        return type_._replace(fields=tuple(fields))
    return type_
