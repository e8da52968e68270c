"""Operators as a target has them: equality of whole values, bits of mixed operands, matrices. Used by `legalise`."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.rules import element_type
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    Array,
    Matrix,
    Scalar,
    Struct,
    Vector,
    components,
    kind_of,
    vector_of,
)
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.legal.matrix_columns import by_columns
from sssgen.passes.legal.part_stores import Keep

_EVERYWHERE = frozenset(("+", "-", "*", "<", ">", "<=", ">=", "&&", "||"))
"""The operators that mean the same in every language, except on matrices."""


def is_integer_division(binary: ir.Binary) -> bool:
    """Whether it is an operator of integers that GLSL leaves undefined for some operands."""
    return binary.op in ("/", "%", "<<", ">>") and kind_of(binary.left.type) != "float"


def legal_operator(binary: ir.Binary, capabilities: Capabilities, keep: Keep) -> ir.Expr:
    """An operator with legal operands, as the target can express it; no integer division."""
    left, right, op, span = binary.left, binary.right, binary.op, binary.span
    if op in _EVERYWHERE and type(left.type) is not Matrix and type(right.type) is not Matrix:
        return binary
    if op == "^^":
        return ir.Binary(BOOL, "!=", left, right, span)
    if op in ("==", "!=") and binary.type == BOOL and not isinstance(left.type, Scalar):
        return _equality(binary, capabilities, keep) if not capabilities.whole_equality else binary
    if op in ("<<", ">>", "&", "|", "^") and not capabilities.mixed_bits:
        size = max(components(left.type), components(right.type))
        right = _amount(right, size) if op in ("<<", ">>") else widen(right, size)
        return binary._replace(left=widen(left, size), right=right)
    if not capabilities.matrix_scalar_arithmetic:
        if isinstance(left.type, Matrix) and isinstance(right.type, Scalar) and op == "/":
            inverse = ir.Binary(FLOAT, "/", ir.Literal(FLOAT, 1.0, span), right, span)
            return ir.Binary(left.type, "*", left, inverse, span)
        if isinstance(binary.type, Matrix) and op in "+-/" and (left.type != right.type or op == "/"):
            return by_columns(binary, keep)
    return binary


def _equality(binary: ir.Binary, capabilities: Capabilities, keep: Keep) -> ir.Expr:
    """`a == b` on vectors, matrices, arrays and structs as one bool."""
    left, right, span = binary.left, binary.right, binary.span
    type_ = left.type
    if isinstance(type_, Vector):
        parts = ir.Binary(Vector("bool", type_.size), binary.op, left, right, span)
        return ir.Intrinsic(BOOL, "all" if binary.op == "==" else "any", (parts,), span)
    left, right = (keep(side, "compared") for side in (left, right))
    pairs: list[tuple[ir.Expr, ir.Expr]]
    if isinstance(type_, Struct):
        pairs = [
            (ir.Member(field.type, left, field.name, span), ir.Member(field.type, right, field.name, span))
            for field in type_.fields
        ]
    elif isinstance(type_, Matrix | Array):
        elements = element_type(type_)
        assert elements is not None
        inner, count = elements
        places = [ir.Literal(INT, index, span) for index in range(count)]
        pairs = [(ir.Index(inner, left, place, span), ir.Index(inner, right, place, span)) for place in places]
    else:
        return binary
    result: ir.Expr | None = None
    for first, second in pairs:
        equal = legal_operator(ir.Binary(BOOL, binary.op, first, second, span), capabilities, keep)
        connective = "&&" if binary.op == "==" else "||"
        result = equal if result is None else ir.Binary(BOOL, connective, result, equal, span)
    assert result is not None
    return result


def _amount(amount: ir.Expr, size: int) -> ir.Expr:
    """The amount of a shift, as a uint or a vector of them."""
    if isinstance(amount, ir.Literal):
        amount = ir.Literal(UINT, amount.value, amount.span)
    elif kind_of(amount.type) == "int":
        amount = ir.Construct(vector_of("uint", components(amount.type)), (amount,), amount.span)
    return widen(amount, size)


def widen(value: ir.Expr, size: int) -> ir.Expr:
    """A scalar as a vector of this size, if that is more than one."""
    if components(value.type) == size:
        return value
    return ir.Construct(Vector(kind_of(value.type), size), (value,), value.span)
