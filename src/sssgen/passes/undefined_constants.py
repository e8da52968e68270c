"""Finds constants without a finite value: 1.0 / 0.0, sqrt(-1.0), normalize(vec3(0.0)), 3e38 * 10.0, 1 << 32.

Why: WGSL refuses a module that holds one, also where it results from module constants, and every other target silently
gives inf, NaN or an undefined value; so they are an error here, with the place in the source. Place: after `fold`,
which leaves exactly these constant expressions unchanged.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir.constant_arithmetic import Numbers
from sssgen.ir.nodes import (
    Assign,
    Binary,
    Construct,
    Expr,
    Global,
    Intrinsic,
    Literal,
    Local,
    Module,
    Span,
    Swizzle,
    Unary,
)
from sssgen.ir.rules import FLOAT_MAX
from sssgen.ir.types import Scalar, Vector, kind_of
from sssgen.ir.walk import expressions, operands, statements
from sssgen.passes.constant_expressions import constant_numbers


class Undefined(NamedTuple):
    """One constant expression without a value."""

    message: str
    span: Span


def undefined_constants(module: Module) -> list[Undefined]:
    """The constant expressions of a folded module that have no finite value, each once."""
    checker = _Checker()
    for constant in module.constants:
        checker.constants[constant.name] = checker.numbers(constant.value)
    for variable in module.variables:
        if variable.value is not None:
            checker.numbers(variable.value)
    for function in module.functions:
        for stmt in statements(function.body or ()):
            for expr in expressions(stmt):
                checker.numbers(expr)
            if isinstance(stmt, Assign) and stmt.op:
                checked = Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span)
                checker.binary(checked, None, checker.numbers(stmt.value))
    return list(checker.found.values())


class _Checker:
    """Computes the constant parts of expressions, and records those without a value."""

    def __init__(self) -> None:
        self.constants: dict[str, Numbers | None] = {}
        self.found: dict[Span, Undefined] = {}

    def numbers(self, expr: Expr) -> Numbers | None:
        """The components of a constant scalar or vector; None for anything else."""
        kind = type(expr)
        if kind is Literal:
            return constant_numbers(expr)
        if kind is Local:
            return None
        if isinstance(expr, Global):
            return self.constants.get(expr.name)
        if isinstance(expr, Binary):
            return self.binary(expr, self.numbers(expr.left), self.numbers(expr.right))
        parts = [self.numbers(operand) for operand in operands(expr)]
        constants = [part for part in parts if part is not None]
        if len(constants) < len(parts):
            return None
        if isinstance(expr, Intrinsic):
            return self.builtin(expr, constants)
        if isinstance(expr, Construct):
            return _constructed(expr, constants)
        if isinstance(expr, Unary):
            return arithmetic.unary(expr.op, constants[0], kind_of(expr.type))
        if isinstance(expr, Swizzle):
            return tuple([constants[0]["xyzw".index(letter)] for letter in expr.components])
        return None

    def binary(self, expr: Binary, left: Numbers | None, right: Numbers | None) -> Numbers | None:
        if right is None:
            return None
        op, kind = expr.op, kind_of(expr.right.type)
        if op in ("/", "%") and kind != "float" and 0 in right:
            return self.wrong(f"'{op}' by the constant 0 is undefined", expr)
        if op in ("<<", ">>") and not all(0 <= count < 32 for count in right):
            return self.wrong("a shift by as many bits as there are, or more, is undefined", expr)
        if left is None:
            return None
        result = arithmetic.binary(op, left, right, kind)
        if result is not None:
            return result
        if op == "/" and kind == "float" and 0.0 in right:
            return self.wrong("a constant divided by 0 is not a number", expr)
        if kind == "float" and not all(map(_is_float, _exactly(op, left, right))):
            return self.wrong("this constant is too large for a float", expr)
        if op == "/" and kind == "int":
            return self.wrong("this constant is too large for an int", expr)
        return None

    def builtin(self, expr: Intrinsic, args: list[Numbers]) -> Numbers | None:
        if args and arithmetic.outside(expr.name, args):
            expected = "a finite number" if kind_of(expr.type) == "float" else "defined"
            return self.wrong(f"{expr.name} of these constants is not {expected}", expr)
        return arithmetic.builtin(expr.name, args, [arg.type for arg in expr.args], expr.type)

    def wrong(self, message: str, expr: Expr) -> Numbers | None:
        self.found.setdefault(expr.span, Undefined(message, expr.span))
        return None


def _constructed(expr: Construct, args: list[Numbers]) -> Numbers | None:
    if not isinstance(expr.type, Scalar | Vector):
        return None
    flat = [arithmetic.converted(value, expr.type.kind) for arg in args for value in arg]
    values = tuple([value for value in flat if value is not None])
    if len(values) < len(flat):
        return None
    size = expr.type.size if isinstance(expr.type, Vector) else 1
    return values * size if len(values) == 1 else values[:size]


def _exactly(op: str, left: Numbers, right: Numbers) -> list[float]:
    """A sum, difference or product of floats in float64."""
    size = max(len(left), len(right))
    pairs = zip(left * (size // len(left)), right * (size // len(right)), strict=True)
    return [x + y if op == "+" else x - y if op == "-" else x * y if op == "*" else x / y for x, y in pairs]


def _is_float(value: float) -> bool:
    return isfinite(value) and abs(value) <= FLOAT_MAX
