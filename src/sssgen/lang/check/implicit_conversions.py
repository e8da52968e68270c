"""GLSL's implicit conversions (GLSL 4.60, section 4.1.10), which are constructors in the IR."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import FLOAT, Matrix, Scalar, Type, Vector, components, kind_of, vector_of

_ORDER = {"int": 0, "uint": 1, "float": 2}
"""Each kind converts to the later ones."""


def converts(source: Type, target: Type, whole: bool = True) -> bool:
    """Whether `source` converts implicitly to `target`. Without `whole`, only the scalar kind must convert."""
    source_rank, target_rank = _ORDER.get(kind_of(source)), _ORDER.get(kind_of(target))
    if source_rank is None or target_rank is None or source_rank > target_rank or isinstance(source, Matrix):
        return False
    return not whole or (not isinstance(target, Matrix) and components(source) == components(target))


def as_kind(value: ir.Expr, kind: str) -> ir.Expr:
    """A scalar or vector with its components converted to `kind`."""
    if kind_of(value.type) == kind or not isinstance(value.type, Scalar | Vector):
        return value
    if isinstance(value, ir.Literal):
        return literal_as(value, Scalar(kind))
    return ir.Construct(vector_of(kind, components(value.type)), (value,), value.span)


def literal_as(literal: ir.Literal, type_: Scalar) -> ir.Literal:
    """A literal converted: an int and a uint keep their bits, a float is truncated (it must fit)."""
    value = literal.value
    if type_ == FLOAT:
        return ir.Literal(type_, float(value), literal.span)
    if type_.kind == "bool":
        return ir.Literal(type_, bool(value), literal.span)
    whole = int(value)
    return ir.Literal(type_, whole & 0xFFFFFFFF if type_.kind == "uint" else wrapped(whole), literal.span)


def common_kind(left: ir.Expr, right: ir.Expr) -> tuple[ir.Expr, ir.Expr]:
    """Two operands, the one with the lower kind converted to the other's; unchanged if there is no conversion."""
    left_rank, right_rank = _ORDER.get(kind_of(left.type)), _ORDER.get(kind_of(right.type))
    if left_rank is None or right_rank is None or left_rank == right_rank:
        return left, right
    if left_rank < right_rank:
        return as_kind(left, kind_of(right.type)), right
    return left, as_kind(right, kind_of(left.type))


def wrapped(value: int) -> int:
    """An integer wrapped to the range of an int."""
    return (value + 2**31) % 2**32 - 2**31
