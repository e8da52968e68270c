"""The conversions that GLSL makes by itself (GLSL 4.60, section 4.1.10), which are constructors in the IR."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import FLOAT, Matrix, Scalar, Type, Vector, components, kind_of, vector_of

_ORDER = {"int": 0, "uint": 1, "float": 2}
"""Each kind becomes a later one."""


def converts(given: Type, wanted: Type, whole: bool = True) -> bool:
    """Whether a value of one type becomes another by itself. Without `whole`, only its kind must fit."""
    one, other = _ORDER.get(kind_of(given)), _ORDER.get(kind_of(wanted))
    if one is None or other is None or one > other or isinstance(given, Matrix):
        return False
    return not whole or (not isinstance(wanted, Matrix) and components(given) == components(wanted))


def as_kind(value: ir.Expr, kind: str) -> ir.Expr:
    """A scalar or vector with its components converted to `kind`."""
    if kind_of(value.type) == kind or not isinstance(value.type, Scalar | Vector):
        return value
    if isinstance(value, ir.Literal):
        return literal_as(value, Scalar(kind))
    return ir.Construct(vector_of(kind, components(value.type)), (value,), value.span)


def literal_as(literal: ir.Literal, type_: Scalar) -> ir.Literal:
    """A literal converted: an int and a uint keep their bits, a float is cut towards zero (it must fit)."""
    value = literal.value
    if type_ == FLOAT:
        return ir.Literal(type_, float(value), literal.span)
    if type_.kind == "bool":
        return ir.Literal(type_, bool(value), literal.span)
    whole = int(value)
    return ir.Literal(type_, whole & 0xFFFFFFFF if type_.kind == "uint" else wrapped(whole), literal.span)


def common_kind(one: ir.Expr, other: ir.Expr) -> tuple[ir.Expr, ir.Expr]:
    """Two operands, the one of the lesser kind brought to the other's; as they are where nothing is converted."""
    left, right = _ORDER.get(kind_of(one.type)), _ORDER.get(kind_of(other.type))
    if left is None or right is None or left == right:
        return one, other
    if left < right:
        return as_kind(one, kind_of(other.type)), other
    return one, as_kind(other, kind_of(one.type))


def wrapped(value: int) -> int:
    """An integer brought into the range of an int, as its 32 bits read."""
    return (value + 2**31) % 2**32 - 2**31
