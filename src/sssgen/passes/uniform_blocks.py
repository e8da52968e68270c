"""How uniforms are stored in a uniform block, and how they are read from there.

Why: every API stores a bool in another way. An array's elements take 16 bytes each, which WGSL requires and HLSL does
silently. WGSL packs a mat2 tighter than std140 does; and after HLSL's smaller matrices D3D places the next value in
the last row, where SPIR-V does not allow it. So a block holds an int instead of a bool, a vec4 for each smaller
element, and a vec4 for each column of such a matrix. Used by `legalise`, and by the printers for the declarations.
"""

from __future__ import annotations

from typing import TypeGuard

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, Array, Matrix, Scalar, Type, Vector, components, kind_of, vector_of
from sssgen.passes.capabilities import Capabilities


def block_type(type_: Type, capabilities: Capabilities) -> Type:
    """The type that stores `type_` in a uniform block."""
    if isinstance(type_, Scalar | Vector) and type_.kind == "bool" and not capabilities.bool_uniforms:
        return vector_of("int", components(type_))
    if _by_columns(type_, capabilities):
        return Array(Vector("float", 4), type_.columns)
    if isinstance(type_, Array):
        element = block_type(type_.element, capabilities)
        if isinstance(element, Array):
            return Array(element.element, element.length * type_.length)
        if components(element) < 4 and not capabilities.float_array_uniforms:
            element = Vector(kind_of(element), 4)
        return Array(element, type_.length)
    return type_


def _by_columns(type_: Type, capabilities: Capabilities) -> TypeGuard[Matrix]:
    return isinstance(type_, Matrix) and not _matrix_uniforms(type_.rows, capabilities)


def _matrix_uniforms(rows: int, capabilities: Capabilities) -> bool:
    """Whether a uniform block may hold a matrix with so many rows."""
    return {2: capabilities.mat2_uniforms, 3: capabilities.mat3_uniforms}.get(rows, True)


def read(value: ir.Global, capabilities: Capabilities) -> ir.Expr:
    """A whole uniform, read from its block."""
    type_, span = value.type, value.span
    stored = value._replace(type=block_type(type_, capabilities))
    if stored.type == type_:
        return value
    if isinstance(type_, Array):
        places = [ir.Literal(INT, number, span) for number in range(type_.length)]
        return ir.Construct(type_, tuple([_element(value, type_, place, capabilities) for place in places]), span)
    return _restore(type_, stored, None, span)


def element(index: ir.Index, capabilities: Capabilities) -> ir.Expr:
    """A uniform's element or column, read from its block; the same where it is stored unchanged."""
    value = index.value
    assert isinstance(value, ir.Global)
    stored = block_type(value.type, capabilities)
    if stored == value.type:
        return index
    if isinstance(value.type, Array):
        return _element(value, value.type, index.index, capabilities)
    if isinstance(stored, Array):
        return _row(value._replace(type=stored), index.index, components(index.type), index.span)
    return index._replace(value=read(value, capabilities))


def _element(value: ir.Global, type_: Array, place: ir.Expr, capabilities: Capabilities) -> ir.Expr:
    stored = value._replace(type=block_type(type_, capabilities))
    return _restore(type_.element, stored, place, value.span)


def _restore(type_: Type, stored: ir.Global, place: ir.Expr | None, span: ir.Span) -> ir.Expr:
    """A value of `type_` from its stored form."""
    if isinstance(type_, Matrix):
        count, rows = type_.columns, type_.rows
        columns = [_row(stored, _column(place, column, count, span), rows, span) for column in range(count)]
        return ir.Construct(type_, tuple(columns), span)
    value: ir.Expr = stored if place is None else _row(stored, place, components(type_), span)
    if kind_of(type_) == "bool" and isinstance(type_, Scalar):
        return ir.Binary(type_, "!=", value, ir.Literal(INT, 0, span), span)
    return ir.Construct(type_, (value,), span) if kind_of(type_) == "bool" else value


def _row(stored: ir.Global, place: ir.Expr, size: int, span: ir.Span) -> ir.Expr:
    """The first components of a row of an array of vec4."""
    assert isinstance(stored.type, Array)
    row = ir.Index(stored.type.element, stored, place, span)
    if size == components(row.type):
        return row
    return ir.Swizzle(vector_of(kind_of(row.type), size), row, "xyzw"[:size], span)


def _column(place: ir.Expr | None, column: int, count: int, span: ir.Span) -> ir.Expr:
    """The row in which one of `count` columns is stored: of the matrix at `place` in an array, or of the only one."""
    if place is None or isinstance(place, ir.Literal):
        first = count * int(place.value) if isinstance(place, ir.Literal) else 0
        return ir.Literal(INT, first + column, span)
    first_row = ir.Binary(place.type, "*", place, ir.Literal(place.type, count, span), span)
    if column == 0:
        return first_row
    return ir.Binary(place.type, "+", first_row, ir.Literal(place.type, column, span), span)
