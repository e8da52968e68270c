"""How uniforms stand in a uniform block, and how they are read from there.

Why: no two APIs fill a bool alike; an array's elements take 16 bytes each, which WGSL demands and HLSL does without
saying so; and WGSL packs a mat2 tighter than std140 does. So in a block an int stands for a bool, a vec4 for each
smaller element, and two vec4 for a mat2. Used by `legalise`, and by the printers for the declarations.
"""

from __future__ import annotations

from collections.abc import Callable

from ..ir import nodes as ir
from ..ir.types import INT, Array, Matrix, Scalar, Type, Vector, components, kind_of, vector_of

Can = Callable[[str], bool]


def block_type(type_: Type, can: Can) -> Type:
    """The type that stands for `type_` in a uniform block."""
    if isinstance(type_, Scalar | Vector) and type_.kind == "bool" and not can("bool_uniforms"):
        return vector_of("int", components(type_))
    if type_ == Matrix(2) and not can("mat2_uniforms"):
        return Array(Vector("float", 4), 2)
    if isinstance(type_, Array):
        element = block_type(type_.element, can)
        if isinstance(element, Array):
            return Array(element.element, element.length * type_.length)
        if components(element) < 4 and not can("float_array_uniforms"):
            element = Vector(kind_of(element), 4)
        return Array(element, type_.length)
    return type_


def read(value: ir.Global, can: Can) -> ir.Expr:
    """A whole uniform, read from its block."""
    type_, span = value.type, value.span
    stored = value._replace(type=block_type(type_, can))
    if stored.type == type_:
        return value
    if isinstance(type_, Array):
        places = [ir.Literal(INT, number, span) for number in range(type_.length)]
        return ir.Construct(type_, tuple([_element(value, type_, place, can) for place in places]), span)
    return _restored(type_, stored, None, span)


def element(index: ir.Index, can: Can) -> ir.Expr:
    """An element of an array uniform, read from its block; the same where it stands there as it is."""
    value = index.value
    if not isinstance(value, ir.Global) or not isinstance(value.type, Array):
        return index
    if block_type(value.type, can) == value.type:
        return index
    return _element(value, value.type, index.index, can)


def _element(value: ir.Global, type_: Array, place: ir.Expr, can: Can) -> ir.Expr:
    stored = value._replace(type=block_type(type_, can))
    return _restored(type_.element, stored, place, value.span)


def _restored(type_: Type, stored: ir.Global, place: ir.Expr | None, span: ir.Span) -> ir.Expr:
    """A value of `type_` from what stands for it."""
    if type_ == Matrix(2):
        columns = [_row(stored, _plus(place, column, span), 2, span) for column in range(2)]
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


def _plus(place: ir.Expr | None, column: int, span: ir.Span) -> ir.Expr:
    """Where a column of the matrix at `place` stands, two rows to a matrix."""
    kind = place.type if place is not None else INT
    if place is None or isinstance(place, ir.Literal):
        return ir.Literal(kind, column + (2 * int(place.value) if isinstance(place, ir.Literal) else 0), span)
    twice = ir.Binary(kind, "*", place, ir.Literal(kind, 2, span), span)
    return twice if column == 0 else ir.Binary(kind, "+", twice, ir.Literal(kind, column, span), span)
