"""The layout of storage buffers: std430 and std140 (OpenGL 4.6, section 7.6.2.2), and what a target can have of them.

WGSL's own layout is that of std430. An HLSL buffer has elements of one type without padding, so there a block has one
member.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.nodes import Module, Variable
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, Vector, components
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects


class Extent(NamedTuple):
    """In bytes; `stride` is that between the elements of an array, or the columns of a matrix."""

    alignment: int
    size: int
    stride: int = 0


def extent(type_: Type, rule: str) -> Extent:
    """The place that a value takes; an array without a length that of one element."""
    least = 16 if rule == "std140" else 1
    if isinstance(type_, Scalar | Vector):
        count = components(type_)
        return Extent(4 * (4 if count == 3 else count), 4 * count)
    if isinstance(type_, Matrix):
        column = extent(Vector("float", type_.rows), rule)
        stride = _up(column.size, max(column.alignment, least))
        return Extent(max(column.alignment, least), stride * type_.columns, stride)
    if isinstance(type_, Array):
        element = extent(type_.element, rule)
        alignment = max(element.alignment, least)
        stride = _up(element.size, alignment)
        return Extent(alignment, stride * (type_.length or 1), stride)
    assert isinstance(type_, Struct)
    places = offsets(type_, rule)
    alignment = max([least, *[extent(field.type, rule).alignment for field in type_.fields]])
    last = extent(type_.fields[-1].type, rule)
    return Extent(alignment, _up(places[-1] + last.size, alignment))


def offsets(struct: Struct, rule: str) -> list[int]:
    """The byte offset of each member."""
    places: list[int] = []
    end = 0
    for field in struct.fields:
        place = extent(field.type, rule)
        places.append(_up(end, place.alignment))
        end = places[-1] + place.size
    return places


def _up(offset: int, alignment: int) -> int:
    return (offset + alignment - 1) // alignment * alignment


def has_buffers(module: Module) -> bool:
    """Whether a module has storage buffers."""
    return any(variable.storage == "buffer" for variable in module.variables)


def check_buffers(module: Module, capabilities: Capabilities) -> Module:
    """The same module. Raises Unsupported for a storage buffer that the target lacks or lays out otherwise."""
    for variable in module.variables:
        if variable.storage == "buffer" and not capabilities.storage_buffers:
            raise Unsupported(f"'{variable.name}' is a storage buffer, which this target lacks", variable.span)
        if variable.storage == "buffer" and not capabilities.std140_buffers:
            struct = variable.type
            assert isinstance(struct, Struct)
            if variable.layout == "std140" and _shape(struct, "std140") != _shape(struct, "std430"):
                message = f"the std140 layout of '{struct.name}' is not that of this target: write std430"
                raise Unsupported(message, variable.span)
            if not capabilities.buffer_blocks:
                _check_elements(struct, variable)
    return module


def read_buffers(module: Module) -> Module:
    """A vertex shader whose storage buffers are readonly. Raises Unsupported where it writes one."""
    written = set[str]().union(*[effect.writes for effect in effects(module).values()])
    variables = []
    for variable in module.variables:
        if variable.storage == "buffer" and variable.name in written:
            message = f"a vertex shader of this target cannot write the storage buffer '{variable.name}'"
            raise Unsupported(message, variable.span, hint="write it in a compute or fragment shader")
        variables.append(variable._replace(access="readonly") if variable.storage == "buffer" else variable)
    return module._replace(variables=tuple(variables))


def _shape(type_: Type, rule: str) -> list[tuple[int, int]]:
    """All sizes and strides in a type."""
    own = [extent(type_, rule)[1:]]
    if isinstance(type_, Struct):
        inner = [part for field in type_.fields for part in _shape(field.type, rule)]
        return [*own, *[(place, 0) for place in offsets(type_, rule)], *inner]
    return [*own, *_shape(type_.element, rule)] if isinstance(type_, Array) else own


def _check_elements(struct: Struct, variable: Variable) -> None:
    """A block of one member, whose elements have no padding."""
    (first, *others) = struct.fields
    if others:
        message = f"'{struct.name}' has several members, and a buffer of this target has elements of one type"
        raise Unsupported(f"{message}: split it into blocks of one member", variable.span)
    element = first.type.element if isinstance(first.type, Array) else first.type
    if _has_padding(element) or (
        isinstance(first.type, Array) and extent(first.type, "std430").stride != _tight(element)
    ):
        message = f"the elements of '{struct.name}' have padding, which this target's buffers have not"
        raise Unsupported(f"{message}: use vectors of two or four", variable.span)


def _has_padding(type_: Type) -> bool:
    if isinstance(type_, Struct):
        return extent(type_, "std430").size != _tight(type_) or any(_has_padding(field.type) for field in type_.fields)
    return isinstance(type_, Matrix) or (isinstance(type_, Array) and _has_padding(type_.element))


def _tight(type_: Type) -> int:
    return 4 * components(type_)
