"""The layout of storage buffers: std430 and std140 (OpenGL 4.6, section 7.6.2.2), and what a target can have of them.

WGSL's own layout is that of std430. An HLSL buffer has elements of one type without padding: others are bytes there.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from itertools import count
from typing import NamedTuple, TypeVar

from sssgen.ir.nodes import (
    Assign,
    Expr,
    Global,
    Index,
    Member,
    MemoryOperation,
    Module,
    Stmt,
    Swizzle,
    Variable,
)
from sssgen.ir.types import INT, Array, Matrix, Scalar, Struct, Type, Vector, components, spell
from sssgen.ir.walk import (
    calls_of,
    expressions,
    operands,
    statements,
    subexpressions,
    written_places,
    written_root,
)
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.scopes import outs_of
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects

T = TypeVar("T", bound=Hashable)


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


def with_free_bindings(bindings: Sequence[tuple[T, int]]) -> dict[T, int]:
    """A binding for each name: its own, or the next one that no other has where it is -1."""
    chosen = {name: binding for name, binding in bindings if binding >= 0}
    for name, _ in bindings:
        if name not in chosen:
            chosen[name] = next(number for number in count() if number not in chosen.values())
    return chosen


def has_buffers(module: Module) -> bool:
    """Whether a module has storage buffers or images."""
    return any(variable.storage in ("buffer", "image") for variable in module.variables)


def byte_buffers(module: Module, capabilities: Capabilities) -> list[Variable]:
    """The storage buffers that a target has as bytes, as their layout is not that of elements without padding."""
    buffers = [variable for variable in module.variables if variable.storage == "buffer"]
    return [buffer for buffer in buffers if not capabilities.buffer_blocks and not _has_plain_elements(buffer)]


def check_buffers(module: Module, capabilities: Capabilities) -> Module:
    """The same module. Raises Unsupported for a storage buffer that the target lacks, lays out otherwise, or copies."""
    for variable in module.variables:
        if variable.storage != "buffer":
            continue
        if not capabilities.storage_buffers:
            raise Unsupported(f"'{variable.name}' is a storage buffer, which this target lacks", variable.span)
        fixed = capabilities.buffer_blocks and not capabilities.std140_buffers
        if fixed and _shape(variable.type, variable.layout) != _shape(variable.type, "std430"):
            message = f"the std140 layout of '{spell(variable.type)}' is not that of this target: write std430"
            raise Unsupported(message, variable.span)
    names = {buffer.name for buffer in byte_buffers(module, capabilities)}
    if names:
        for function in module.functions:
            for stmt in statements(function.body or ()):
                _check_bytes(stmt, names)
    return module


def _check_bytes(stmt: Stmt, names: set[str]) -> None:
    """Raises Unsupported for what buffers of bytes cannot do."""
    compares = isinstance(stmt, MemoryOperation) and stmt.name in ("atomicMin", "atomicMax")
    if isinstance(stmt, MemoryOperation) and compares and stmt.args[0].type == INT and _is_in(stmt.args[0], names):
        message = "a buffer of several members compares as uint here, not as int"
        raise Unsupported(message, stmt.span, hint="declare a buffer that has this number alone")
    whole = [] if isinstance(stmt, MemoryOperation) else [*expressions(stmt)]
    for expr in [part for each in (*whole, *written_places(stmt)) for part in subexpressions(each)]:
        inner = [part for part in operands(expr) if isinstance(part.type, Array) and _is_in(part, names)]
        if inner and not isinstance(expr, Index | Member):
            whole += inner
    for expr in whole:
        if isinstance(expr.type, Array) and _is_in(expr, names):
            message = "an array in a buffer of several members is not copied as a whole here"
            raise Unsupported(message, stmt.span, hint="copy its elements in a loop")


def _is_in(expr: Expr, names: set[str]) -> bool:
    base = written_root(expr)
    return isinstance(base, Global) and base.name in names


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


def with_read_access(module: Module) -> Module:
    """The module without `writeonly` at buffers that it reads, as atomics and out arguments do, too."""
    outs = outs_of(module.functions)
    places: list[Expr] = []
    for function in module.functions:
        body = function.body or ()
        places += [stmt.args[0] for stmt in statements(body) if isinstance(stmt, MemoryOperation) and stmt.args]
        places += [call.args[index] for call in calls_of(body) for index in outs.get(call.function, ())]
        places += [part for stmt in statements(body) for expr in _read(stmt) for part in subexpressions(expr)]
    names = {root.name for root in map(written_root, places) if isinstance(root, Global)}
    variables = [
        variable._replace(access="")
        if variable.storage == "buffer" and variable.access == "writeonly" and variable.name in names
        else variable
        for variable in module.variables
    ]
    return module._replace(variables=tuple(variables))


def _read(stmt: Stmt) -> Iterator[Expr]:
    """The expressions of a statement whose values it reads; of the place that an assignment writes only the indices."""
    if not isinstance(stmt, Assign) or stmt.op:
        yield from expressions(stmt)
        return
    yield stmt.value
    place = stmt.target
    while isinstance(place, Index | Member | Swizzle):
        if isinstance(place, Index):
            yield place.index
        place = place.value


def _shape(type_: Type, rule: str) -> list[tuple[int, int]]:
    """All sizes and strides in a type."""
    own = [extent(type_, rule)[1:]]
    if isinstance(type_, Struct):
        inner = [part for field in type_.fields for part in _shape(field.type, rule)]
        return [*own, *[(place, 0) for place in offsets(type_, rule)], *inner]
    return [*own, *_shape(type_.element, rule)] if isinstance(type_, Array) else own


def _has_plain_elements(variable: Variable) -> bool:
    """Whether a block has one member, whose elements are no arrays and have no padding."""
    struct = variable.type
    assert isinstance(struct, Struct)
    (first, *others) = struct.fields
    element = first.type.element if isinstance(first.type, Array) else first.type
    is_array = isinstance(first.type, Array)
    stride = extent(first.type, variable.layout).stride
    is_plain = not isinstance(element, Array) and not _has_padding(element)
    return not others and is_plain and (not is_array or stride == _tight(element))


def _has_padding(type_: Type) -> bool:
    if isinstance(type_, Struct):
        return extent(type_, "std430").size != _tight(type_) or any(_has_padding(field.type) for field in type_.fields)
    return isinstance(type_, Matrix) or (isinstance(type_, Array) and _has_padding(type_.element))


def _tight(type_: Type) -> int:
    return 4 * components(type_)
