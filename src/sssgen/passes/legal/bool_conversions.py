"""Constructors of bools, for languages in which a number that is converted to bool is not 0 or 1: `x != 0`.

Used by `legalise`.
"""

from __future__ import annotations

from collections.abc import Callable

from sssgen.ir.constant_expressions import literal
from sssgen.ir.nodes import Binary, Construct, Expr, Intrinsic
from sssgen.ir.types import BOOL, Scalar, Vector, kind_of

LegalBuiltin = Callable[[Intrinsic], Expr]
"""Gives a call of a builtin as the target has it."""


def by_comparisons(construct: Construct, legal: LegalBuiltin) -> Expr:
    """A constructor of bools without conversions of numbers."""
    args = tuple([_compare_with_zero(arg, legal) for arg in construct.args])
    if len(args) == 1 and args[0].type == construct.type:
        return args[0]
    return construct._replace(args=args)


def _compare_with_zero(value: Expr, legal: LegalBuiltin) -> Expr:
    """The bools of numbers; bools themselves."""
    type_, span = value.type, value.span
    if kind_of(type_) == "bool" or not isinstance(type_, Scalar | Vector):
        return value
    zero = literal(type_, (0.0 if type_.kind == "float" else 0,), span)
    if isinstance(type_, Scalar):
        return Binary(BOOL, "!=", value, zero, span)
    return legal(Intrinsic(Vector("bool", type_.size), "notEqual", (value, zero), span))
