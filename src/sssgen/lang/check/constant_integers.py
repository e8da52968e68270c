"""Constant integer expressions: array lengths, indices, case labels, locations."""

from __future__ import annotations

import operator
from collections.abc import Callable

from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.implicit_conversions import wrapped
from sssgen.lang.syntax import tree as s

_OPERATORS: dict[str, Callable[[int, int], int]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "<<": operator.lshift, ">>": operator.rshift,
    "&": operator.and_, "|": operator.or_, "^": operator.xor, "/": lambda x, y: abs(x) // y * (1 if x >= 0 else -1),
    "%": lambda x, y: abs(x) % y * (1 if x >= 0 else -1),
}  # fmt: skip
"""The operators of constant integers; a divisor is positive, a shift at most 64."""


def constant_int(context: CheckContext, expression: s.Expression) -> int | None:
    """The value of a constant integer expression, or None."""
    if isinstance(expression, s.Number) and not expression.is_float:
        return integer_value(expression.text)
    if isinstance(expression, s.Name):
        local = context.function.scopes.find(expression.text)
        if local is not None:
            return local.value
        global_ = context.globals.get(expression.text)
        return global_.value if global_ is not None else None
    if isinstance(expression, s.Prefix) and expression.op in "-+":
        value = constant_int(context, expression.operand)
        return -value if value is not None and expression.op == "-" else value
    if isinstance(expression, s.Infix) and expression.op in _OPERATORS:
        left, right = constant_int(context, expression.left), constant_int(context, expression.right)
        if left is None or right is None or (expression.op in "/%<<>>" and not 0 < right < 2**31):
            return None
        return wrapped(_OPERATORS[expression.op](left, min(right, 64) if expression.op in ("<<", ">>") else right))
    if isinstance(expression, s.CallOf) and isinstance(expression.callee, s.TypeName):
        converts = expression.callee.name in ("int", "uint") and len(expression.args) == 1
        return constant_int(context, expression.args[0]) if converts else None
    return None


def integer_value(text: str) -> int | None:
    """The value of an integer literal; None for an invalid octal literal. Absurdly long literals are truncated."""
    digits = text.rstrip("uU")[:40]
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if len(digits) > 1 and digits[0] == "0":
        return int(digits, 8) if set(digits) <= set("01234567") else None
    return int(digits)
