"""Finds constants without a finite value: 1.0 / 0.0, sqrt(-1.0), normalize(vec3(0.0)), 3e38 * 10.0, 1 << 32.

Why: WGSL refuses a module that holds one, also where it results from module constants, and every other target silently
gives inf, NaN or an undefined value; so they are an error in a material, with the place in the source. In an author's
text they are valid, and `late_constants` has the device compute them. Place: after `fold`, which leaves exactly these
constant expressions unchanged.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir import nodes as ir
from sssgen.ir.constant_arithmetic import Numbers
from sssgen.ir.constant_evaluation import Value, combine
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import FLOAT_MAX
from sssgen.ir.types import Matrix, kind_of, with_article
from sssgen.ir.walk import expressions, operands, statements


class Undefined(NamedTuple):
    """One constant expression without a value."""

    message: str
    span: ir.Span


def undefined_constants(module: ir.Module) -> list[Undefined]:
    """The constant expressions of a folded module that have no finite value, each once."""
    return list(ConstantChecker(module).undefined.values())


class ConstantChecker:
    """Computes the constant parts of a module's expressions, and records those without a value.

    With `partly`, also calls of which some arguments are constants outside of the domain, whatever the others are.
    """

    def __init__(self, module: ir.Module, partly: bool = False) -> None:
        self.partly = partly
        self.constants: dict[str, Value | None] = {}
        self.undefined: dict[ir.Span, Undefined] = {}
        for constant in module.constants:
            self.constants[constant.name] = self.value(constant.value)
        for variable in module.variables:
            if variable.value is not None:
                self.value(variable.value)
        for function in module.functions:
            for stmt in statements(function.body or ()):
                for expr in expressions(stmt):
                    self.value(expr)
                if isinstance(stmt, ir.Assign) and stmt.op:
                    checked = ir.Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span)
                    self.binary(checked, None, self.value(stmt.value))

    def value(self, expr: ir.Expr) -> Value | None:
        """The value of a constant; None for anything else."""
        if type(expr) is ir.Local:
            return None
        if type(expr) is ir.Literal:
            return constant_numbers(expr)
        if isinstance(expr, ir.Binary):
            return self.binary(expr, self.value(expr.left), self.value(expr.right))
        if isinstance(expr, ir.Global):
            return self.constants.get(expr.name)
        parts = [self.value(operand) for operand in operands(expr)]
        if None in parts:
            if self.partly and isinstance(expr, ir.Intrinsic) and _is_outside(expr.name, parts):
                return self.wrong(f"{expr.name} has no value: it needs {BUILTINS[expr.name].domain}", expr)
            return None
        constants = [part for part in parts if part is not None]
        if isinstance(expr, ir.Intrinsic):
            return self.builtin(expr, constants)
        value = combine(expr, constants) if constants else None
        if value is None and isinstance(expr, ir.Construct) and kind_of(expr.type) in ("int", "uint"):
            return self.wrong(f"this constant does not fit in {with_article(kind_of(expr.type))}", expr)
        return value

    def binary(self, expr: ir.Binary, left: Value | None, right: Value | None) -> Value | None:
        if right is None:
            return None
        op, kind = expr.op, kind_of(expr.right.type)
        if op in ("/", "%") and kind != "float" and 0 in right:
            return self.wrong(f"'{op}' by the constant 0 is undefined", expr)
        if op in ("<<", ">>") and not all(0 <= count < 32 for count in right):
            return self.wrong("a shift by as many bits as there are, or more, is undefined", expr)
        if left is None:
            return None
        result = combine(expr, (left, right))
        if result is not None or Matrix in (type(expr.left.type), type(expr.right.type)):
            return result
        if op == "/" and kind == "float" and 0.0 in right:
            return self.wrong("a constant divided by 0 is not a number", expr)
        if kind == "float" and not all(map(_is_float, _exactly(op, left, right))):
            return self.wrong("this constant is too large for a float", expr)
        return None

    def builtin(self, expr: ir.Intrinsic, args: list[Value]) -> Value | None:
        types = [arg.type for arg in expr.args]
        if args and arithmetic.outside(expr.name, args, types, expr.type):
            return self.wrong(arithmetic.reason(expr.name, args, kind_of(expr.type)), expr)
        return arithmetic.builtin(expr.name, args, types, expr.type)

    def wrong(self, message: str, expr: ir.Expr) -> Value | None:
        self.undefined.setdefault(expr.span, Undefined(message, expr.span))
        return None


def _is_outside(name: str, args: Sequence[Value | None]) -> bool:
    """Whether the constants among the arguments that compilers check are outside of the domain in a component."""
    row = BUILTINS[name]
    if row.defined is None:
        return False
    numbers = [part for index in row.checked if (part := args[index]) is not None]
    if not numbers or len(numbers) < len(row.checked):
        return False
    for component in zip(*numbers, strict=False):  # a scalar is checked with the first component
        values = dict(zip(row.checked, component, strict=True))
        if not row.defined(None, *[values.get(index, 0.0) for index in range(len(args))]):
            return True
    return False


def _exactly(op: str, left: Numbers, right: Numbers) -> list[float]:
    """A sum, difference or product of floats in float64."""
    size = max(len(left), len(right))
    pairs = zip(left * (size // len(left)), right * (size // len(right)), strict=True)
    return [x + y if op == "+" else x - y if op == "-" else x * y if op == "*" else x / y for x, y in pairs]


def _is_float(value: float) -> bool:
    return isfinite(value) and abs(value) <= FLOAT_MAX
