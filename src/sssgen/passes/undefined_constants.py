"""Finds constants without a finite value: 1.0 / 0.0, sqrt(-1.0), normalize(vec3(0.0)), 3e38 * 10.0, 1 << 32.

Why: WGSL refuses a module that holds one, also where it results from module constants, and every other target silently
gives inf, NaN or an undefined value; so they are an error here, with the place in the source. Place: after `fold`,
which leaves exactly these constant expressions unchanged.

Where the author's text is kept, they get a value instead, with a note: the largest float for infinity, the operand for
a division of integers by 0, as of WGSL's variables, and 0 where the result is not a number.
"""

from __future__ import annotations

from math import copysign, inf, isfinite, isnan
from typing import NamedTuple

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir import nodes as ir
from sssgen.ir.constant_arithmetic import Number, Numbers
from sssgen.ir.constant_evaluation import Value, combine
from sssgen.ir.constant_expressions import constant_numbers, literal
from sssgen.ir.rules import FLOAT_MAX
from sssgen.ir.transform import Transformer
from sssgen.ir.types import Matrix, components, kind_of, with_article
from sssgen.ir.walk import expressions, operands, statements, subexpressions


class Undefined(NamedTuple):
    """One constant expression without a value."""

    message: str
    span: ir.Span


def undefined_constants(module: ir.Module) -> list[Undefined]:
    """The constant expressions of a folded module that have no finite value, each once."""
    return _undefined(_Checker(), module)


def _undefined(checker: _Checker, module: ir.Module) -> list[Undefined]:
    for constant in module.constants:
        checker.constants[constant.name] = checker.value(constant.value)
    for variable in module.variables:
        if variable.value is not None:
            checker.value(variable.value)
    for function in module.functions:
        for stmt in statements(function.body or ()):
            for expr in expressions(stmt):
                checker.value(expr)
            if isinstance(stmt, ir.Assign) and stmt.op:
                checked = ir.Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span)
                checker.binary(checked, None, checker.value(stmt.value))
    return list(checker.undefined.values())


def settled_constants(module: ir.Module) -> tuple[ir.Module, list[Undefined]]:
    """The module with values for these expressions, and what it has them for."""
    checker = _Checker(settles=True)
    undefined = _undefined(checker, module)
    if not checker.settled:
        return module, []
    settler = _Settler(checker.settled)
    constants = [each._replace(value=settler.expression(each.value)) for each in module.constants]
    variables = [
        each._replace(value=settler.expression(each.value)) if each.value is not None else each
        for each in module.variables
    ]
    functions = tuple(map(settler.function, module.functions))
    return module._replace(constants=tuple(constants), variables=tuple(variables), functions=functions), undefined


class _Settler(Transformer):
    """Puts values in the places of expressions."""

    def __init__(self, settled: dict[int, tuple[ir.Expr, ir.Expr]]) -> None:
        super().__init__()
        self.settled = settled

    def expression(self, expr: ir.Expr) -> ir.Expr:
        return self.settled[id(expr)][1] if id(expr) in self.settled else super().expression(expr)


class _Checker:
    """Computes the constant parts of expressions, and records those without a value.

    `settles`: they get one, and what is computed from them goes on with it.
    """

    def __init__(self, settles: bool = False) -> None:
        self.settles = settles
        self.constants: dict[str, Value | None] = {}
        self.undefined: dict[ir.Span, Undefined] = {}
        self.settled: dict[int, tuple[ir.Expr, ir.Expr]] = {}
        """The id of an expression → itself, which keeps the id taken, and its value."""

    def value(self, expr: ir.Expr) -> Value | None:
        """The value of a constant; None for anything else."""
        kind = type(expr)
        if kind is ir.Literal:
            return constant_numbers(expr)
        if kind is ir.Local:
            return None
        if isinstance(expr, ir.Global):
            return self.constants.get(expr.name)
        if isinstance(expr, ir.Binary):
            return self.binary(expr, self.value(expr.left), self.value(expr.right))
        parts = [self.value(operand) for operand in operands(expr)]
        constants = [part for part in parts if part is not None]
        if len(constants) < len(parts):
            return None
        if isinstance(expr, ir.Intrinsic):
            return self.builtin(expr, constants)
        value = combine(expr, constants) if constants else None
        if value is None and isinstance(expr, ir.Construct) and kind_of(expr.type) in ("int", "uint"):
            numbers = [_clipped(float(number), kind_of(expr.type)) for part in constants for number in part]
            count = components(expr.type)
            return self.wrong(
                f"this constant does not fit in {with_article(kind_of(expr.type))}", expr, (numbers * count)[:count]
            )
        return value

    def binary(self, expr: ir.Binary, left: Value | None, right: Value | None) -> Value | None:
        if right is None:
            return None
        op, kind = expr.op, kind_of(expr.right.type)
        if op in ("/", "%") and kind != "float" and 0 in right:
            right = self.wrong(
                f"'{op}' by the constant 0 is undefined", expr.right, [each or 1 for each in right], expr
            )
        if op in ("<<", ">>") and not all(0 <= count < 32 for count in right or ()):
            message = "a shift by as many bits as there are, or more, is undefined"
            right = self.wrong(message, expr.right, [int(count) & 31 for count in right or ()], expr)
        if right is None:
            return None
        if left is None:
            return None
        result = combine(expr, (left, right))
        if result is not None or Matrix in (type(expr.left.type), type(expr.right.type)):
            return result
        if op == "/" and kind == "float" and 0.0 in right:
            message = f"a constant divided by 0 is {'infinite' if all(left) else 'not a number'}"
            return self.wrong(message, expr, _finite(op, left, right))
        if kind == "float" and not all(map(_is_float, _exactly(op, left, right))):
            return self.wrong("this constant is too large for a float", expr, _finite(op, left, right))
        return None

    def builtin(self, expr: ir.Intrinsic, args: list[Value]) -> Value | None:
        types = [arg.type for arg in expr.args]
        if args and arithmetic.outside(expr.name, args, types, expr.type):
            kind = kind_of(expr.type)
            numbers = arithmetic.unchecked(expr.name, args, types, expr.type)
            message = arithmetic.reason(expr.name, args, kind)
            return self.wrong(message, expr, [_clipped(number, kind) for number in numbers])
        return arithmetic.builtin(expr.name, args, types, expr.type)

    def wrong(self, message: str, expr: ir.Expr, numbers: list[Number], whole: ir.Expr | None = None) -> Value | None:
        """Records an expression without a value, or the operand of a `whole` one; gives the `numbers` that settle it,
        or None."""
        if not any(id(part) in self.settled for part in subexpressions(expr)):
            span = (whole or expr).span
            self.undefined.setdefault(span, Undefined(message, span))
        if not self.settles:
            return None
        value = tuple(numbers)
        self.settled[id(expr)] = expr, literal(expr.type, value, expr.span)
        return value


def _clipped(number: Number, kind: str) -> Number:
    """A number of a kind that is near one which none has: 0 for what is not a number."""
    if kind == "bool":
        return False
    lowest, highest = {"float": (-FLOAT_MAX, FLOAT_MAX), "uint": (0, 2**32 - 1)}.get(kind, (-(2**31), 2**31 - 1))
    clipped = 0 if isnan(number) else min(max(number, lowest), highest)
    return float(clipped) if kind == "float" else int(clipped)


def _finite(op: str, left: Numbers, right: Numbers) -> list[Number]:
    """The floats nearest to `left op right`."""
    size = max(len(left), len(right))
    pairs = zip(left * (size // len(left)), right * (size // len(right)), strict=True)
    return [
        _clipped(copysign(x * inf, copysign(1.0, x) * copysign(1.0, y)) if x else 0.0, "float")
        if op == "/" and y == 0.0
        else _clipped(_exactly(op, (x,), (y,))[0], "float")
        for x, y in pairs
    ]


def _exactly(op: str, left: Numbers, right: Numbers) -> list[float]:
    """A sum, difference or product of floats in float64."""
    size = max(len(left), len(right))
    pairs = zip(left * (size // len(left)), right * (size // len(right)), strict=True)
    return [x + y if op == "+" else x - y if op == "-" else x * y if op == "*" else x / y for x, y in pairs]


def _is_float(value: float) -> bool:
    return isfinite(value) and abs(value) <= FLOAT_MAX
