"""Choices, `c ? a : b` and the builtins that choose by bools: which of them a target has. Used by `legalise`."""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Call, Construct, Expr, Global, Intrinsic, Select
from sssgen.ir.types import Array, Struct, Vector
from sssgen.ir.walk import operands, subexpressions
from sssgen.passes.capabilities import Capabilities

_CHOICES = (Select, Intrinsic)


def is_expression(select: Select, capabilities: Capabilities) -> bool:
    """Whether the target has an expression for this choice, which evaluates one arm."""
    return capabilities.ternary and (capabilities.struct_choices or not isinstance(select.type, Struct | Array))


def calls_or_samples(select: Select) -> bool:
    """Whether an arm costs so much that it should not be evaluated in vain."""
    return any(_is_costly(part) for arm in (select.yes, select.no) for part in subexpressions(arm))


def _is_costly(expr: Expr) -> bool:
    return isinstance(expr, Call) or (isinstance(expr, Intrinsic) and BUILTINS[expr.name].kind == "fetch")


def chooses_nested(expr: Expr) -> bool:
    """Whether an expression chooses between vectors made of vectors, as a constant at file scope may be."""
    if not isinstance(expr.type, Vector) or not isinstance(expr, _CHOICES):
        return False
    if isinstance(expr, Intrinsic) and not BUILTINS[expr.name].is_choice([arg.type for arg in expr.args]):
        return False
    return any(
        isinstance(part, Global)
        or (isinstance(part, Construct) and any(isinstance(arg.type, Vector) for arg in part.args))
        for operand in operands(expr)
        for part in subexpressions(operand)
    )
