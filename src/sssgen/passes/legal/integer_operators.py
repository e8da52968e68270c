"""Gives integer operators the same result in every language: that of WGSL, which defines it for all operands.

Why: in GLSL and HLSL a division by 0 is undefined, so is a remainder of a negative number (glslang makes a floored
one of it) and a shift by 32 bits or more. Here x / 0 is x, x % 0 is 0, `%` has the sign of x, and only the low five
bits of a shift's amount count. Operands that are evidently safe (constants, counters of loops) stay unchanged. Used by
`legalise`.
"""

from __future__ import annotations

from collections.abc import Container

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, Scalar, Type, Vector, components, kind_of, vector_of
from sssgen.passes.legal.part_stores import Keep


def counts_up(loop: ir.For) -> str:
    """The name of a loop's counter if it begins at a constant that is not negative and grows; else ''."""
    init, step = loop.init, loop.step
    if not isinstance(init, ir.Declare) or not isinstance(init.value, ir.Literal) or init.value.value < 0:
        return ""
    grows = (
        isinstance(step, ir.Assign) and step.op == "+" and isinstance(step.value, ir.Literal) and step.value.value > 0
    )
    return init.name if grows else ""


def with_result(binary: ir.Binary, keep: Keep, counters: Container[str]) -> ir.Expr:
    """An integer division, remainder or shift that has a result for all operands."""
    op, left, right, span = binary.op, binary.left, binary.right, binary.span
    kind = kind_of(right.type)
    if op in ("<<", ">>"):
        return binary if _is_small(right) else binary._replace(right=_and_31(right, kind, span))
    if not _has_no_zero(right):
        right = keep(right, "divisor")
        right = ir.Binary(right.type, "+", right, _is_zero(right, span), span)
    if op == "/" or kind == "uint" or (_is_natural(left, counters) and _has_no_zero(right)):
        return binary._replace(right=right)
    left, right = keep(left, "dividend"), keep(right, "divisor")
    quotient = ir.Binary(binary.type, "/", left, right, span)
    return ir.Binary(binary.type, "-", left, ir.Binary(binary.type, "*", quotient, right, span), span)


def _literals(expr: ir.Expr) -> list[float] | None:
    """The numbers of a literal, or of a vector of literals."""
    if isinstance(expr, ir.Literal):
        return [expr.value]
    if isinstance(expr, ir.Construct) and all(isinstance(arg, ir.Literal) for arg in expr.args):
        return [arg.value for arg in expr.args if isinstance(arg, ir.Literal)]
    return None


def _has_no_zero(expr: ir.Expr) -> bool:
    numbers = _literals(expr)
    return numbers is not None and all(number > 0 for number in numbers)


def _is_small(amount: ir.Expr) -> bool:
    """Whether a shift's amount is less than 32 for sure."""
    if isinstance(amount, ir.Binary) and amount.op == "&":
        amount = amount.right
    numbers = _literals(amount)
    return numbers is not None and all(0 <= number < 32 for number in numbers)


def _is_natural(expr: ir.Expr, counters: Container[str]) -> bool:
    """Whether an int is not negative for sure."""
    if isinstance(expr, ir.Local):
        return expr.name in counters
    if isinstance(expr, ir.Binary):
        parts = [_is_natural(part, counters) for part in (expr.left, expr.right)]
        return any(parts) if expr.op == "&" else all(parts) and expr.op in ("/", "%", ">>", "|", "^")
    numbers = _literals(expr)
    return numbers is not None and all(number >= 0 for number in numbers)


def _and_31(amount: ir.Expr, kind: str, span: ir.Span) -> ir.Expr:
    return ir.Binary(amount.type, "&", amount, ir.Literal(Scalar(kind), 31, span), span)


def _is_zero(divisor: ir.Expr, span: ir.Span) -> ir.Expr:
    """1 where the divisor is 0, else 0."""
    type_ = divisor.type
    scalar = Scalar(kind_of(type_))
    if isinstance(type_, Vector):
        zeros = ir.Construct(type_, (ir.Literal(scalar, 0, span),), span)
        comparison: ir.Expr = ir.Intrinsic(_bools(type_), "equal", (divisor, zeros), span)
    else:
        comparison = ir.Binary(BOOL, "==", divisor, ir.Literal(scalar, 0, span), span)
    return ir.Construct(type_, (comparison,), span)


def _bools(type_: Type) -> Type:
    return vector_of("bool", components(type_))
