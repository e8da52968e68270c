"""Finds constants that are no number: 1.0 / 0.0, sqrt(-1.0), normalize(vec3(0.0)).

Why: WGSL refuses a module that holds one, and every other target quietly gives inf or NaN; so they are an error here,
with the place in the source. Place: after `fold`, which leaves exactly these constant expressions as they are written.
"""

from __future__ import annotations

from typing import NamedTuple

from ..ir.nodes import Binary, Expr, Intrinsic, Module, Span
from ..ir.types import kind_of
from ..ir.walk import all_expressions
from .arithmetic import Numbers, outside
from .fold import constant_numbers


class Undefined(NamedTuple):
    """One constant expression without a value."""

    message: str
    span: Span


def undefined_constants(module: Module) -> list[Undefined]:
    """The constant expressions of a folded module that have no finite value, each once."""
    found: dict[Span, Undefined] = {}
    for function in module.functions:
        for expr in all_expressions(function.body or ()):
            message = _wrong(expr)
            if message:
                found.setdefault(expr.span, Undefined(message, expr.span))
    return list(found.values())


def _wrong(expr: Expr) -> str:
    if type(expr) is Binary and expr.op in "/%":
        divisor = constant_numbers(expr.right)
        if divisor is not None and 0 in divisor and kind_of(expr.right.type) in ("int", "uint"):
            return f"'{expr.op}' by the constant 0 is undefined"
        if divisor is not None and 0 in divisor and constant_numbers(expr.left) is not None:
            return "a constant divided by 0 is not a number"
    if type(expr) is Intrinsic:
        args: list[Numbers] = []
        for arg in expr.args:
            numbers = constant_numbers(arg)
            if numbers is None:
                return ""
            args.append(numbers)
        if args and outside(expr.name, args):
            return f"{expr.name} of these constants is not a finite number"
    return ""
