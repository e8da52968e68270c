"""Replaces constant integers that a compiler with wider integers would compute differently by their values.

Why: integers of GLSL wrap at 32 bits, but the literals of WGSL and of HLSL (DXC) are of types with 64 bits, so that
`(2147483647 + 1) / 2` is positive there, and WGSL refuses `x & (1 << 31)`, `uint(~0)` and `3u << 31`. Only the smallest
part that differs is replaced, so that the author's text stays otherwise. So is the division of the lowest int by -1,
at which Mesa's compiler of GLSL dies. Used by `legalise`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir.constant_evaluation import Value, combine, evaluate
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.nodes import Binary, Construct, Expr, Global, Intrinsic, Literal, Local, Unary
from sssgen.ir.types import kind_of
from sssgen.ir.walk import operands

_INTEGERS = ("int", "uint")


class ConstantIntegers:
    """The values of constant expressions. Those of ints and uints are noted from the leaves up, each once."""

    def __init__(self) -> None:
        self.constants: dict[str, Value] = {}
        """By the names of module constants."""
        self.noted: dict[int, tuple[Expr, Value]] = {}
        """By the ids of nodes. The node is kept, so that no other one gets its id."""

    def note(self, expr: Expr, value: Value) -> None:
        self.noted[id(expr)] = expr, value

    def value(self, expr: Expr) -> Value | None:
        """The value of a constant; None for anything else."""
        kind = type(expr)
        if kind is Local:
            return None
        if kind is Literal:
            return constant_numbers(expr)
        if isinstance(expr, Global):
            return self.constants.get(expr.name)
        known = self.noted.get(id(expr))
        if known is not None or kind_of(expr.type) in _INTEGERS:
            return known[1] if known is not None else None
        parts = self.parts(expr)
        return combine(expr, parts) if parts else None

    def parts(self, expr: Expr) -> list[Value]:
        """The values of the operands; empty where one is not constant."""
        parts = []
        for operand in operands(expr):
            part = self.value(operand)
            if part is None:
                return []
            parts.append(part)
        return parts


def overflowing_division(expr: Expr, constants: Mapping[str, Expr]) -> Value | None:
    """The value of a constant division of ints with a quotient of 32 bits and a sign more; None for anything else.

    `constants` are the values of the module's constants.
    """
    if not isinstance(expr, Binary) or expr.op not in ("/", "%") or kind_of(expr.type) != "int":
        return None

    def named(name: Local | Global) -> Value | None:
        return evaluate(constants[name.name], named) if name.name in constants and isinstance(name, Global) else None

    right = evaluate(expr.right, named)
    left = evaluate(expr.left, named) if right is not None and -1 in right else None
    if left is None or right is None or -0x80000000 not in left:
        return None
    return combine(expr, (left, right))


def is_wider(expr: Expr, parts: Sequence[Value], numbers: Value) -> bool:
    """Whether an integer expression of constants has another value, or none, where integers are wider.

    uints have 32 bits everywhere; WGSL refuses a shift that loses bits of one, and the conversion of a negative number.
    """
    kind = kind_of(expr.type)
    if isinstance(expr, Binary) and expr.op == "%" and kind == "int" and -1 in parts[1]:
        return -0x80000000 in parts[0]  # the quotient overflows
    if isinstance(expr, Binary) and (kind == "int" or expr.op == "<<"):
        exact = arithmetic.unbounded(expr.op, parts[0], parts[1])
    elif isinstance(expr, Unary) and expr.op == "-" and kind == "int":
        exact = [-number for number in parts[0]]
    elif isinstance(expr, Construct) and kind == "uint":
        return any(number < 0 for part in parts for number in part)
    else:
        return isinstance(expr, Intrinsic) and kind == "int" and -0x80000000 in numbers
    return exact is None or tuple(exact) != numbers
