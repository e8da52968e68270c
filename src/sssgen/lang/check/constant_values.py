"""The values of constant expressions: array lengths, indices, case labels, locations (GLSL 4.60, section 4.3.3).

A constant is a literal, a const variable with a constant value, or an operator, constructor, builtin, element, member
or swizzle of constants.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.constant_evaluation import Value, evaluate
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import INT, UINT
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.context import CheckContext
from sssgen.lang.syntax import tree as s


def constant_int(context: CheckContext, expression: s.Expression) -> int | None:
    """The value of a constant integer expression, or None."""
    return integer(context, context.check_expression(expression).expr)


def integer(context: CheckContext, expr: ir.Expr) -> int | None:
    """The value of a checked constant integer expression, or None."""
    value = constant_value(context, expr) if expr.type in (INT, UINT) else None
    return None if value is None else int(value[0])


def constant_value(context: CheckContext, expr: ir.Expr) -> Value | None:
    """The value of a checked constant expression; None where it is not constant, or not defined."""

    def named(name: ir.Local | ir.Global) -> Value | None:
        if isinstance(name, ir.Local):
            return context.function.scopes.visible[name.name].value
        return context.globals[name.name].value

    return evaluate(expr, named)


def is_constant(context: CheckContext, expr: ir.Expr) -> bool:
    """Whether an expression is known before the shader runs, also where its value is not computed here."""
    return all(_is_constant(context, part) for part in subexpressions(expr))


def _is_constant(context: CheckContext, part: ir.Expr) -> bool:
    if isinstance(part, ir.Intrinsic):
        return not BUILTINS[part.name].reads_neighbours_or_textures
    if isinstance(part, ir.Local):
        return context.function.scopes.visible[part.name].constant
    if isinstance(part, ir.Global):
        return context.globals[part.name].constant
    return not isinstance(part, ir.Call)


def integer_value(text: str) -> int | None:
    """The value of an integer literal; None for an invalid octal literal. Absurdly long literals are truncated."""
    digits = text.rstrip("uU")[:40]
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if len(digits) > 1 and digits[0] == "0":
        return int(digits, 8) if set(digits) <= set("01234567") else None
    return int(digits)
