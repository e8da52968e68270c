"""Prints expressions as Python on NumPy arrays: the first half of the NumPy printer."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, UINT, Array, Matrix, Scalar, Struct, Vector, components, kind_of, unnested
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.numpy_numbers import Numbers, nonzero
from sssgen.targets.printers.printer import POSTFIX, PRIMARY, UNARY, Printer

_OPERATORS = {"||": "|", "^^": "^", "&&": "&"}
PYTHON_PRECEDENCE = {
    "==": 5, "!=": 5, "<": 5, ">": 5, "<=": 5, ">=": 5, "|": 6, "^": 7, "&": 8, "<<": 9, ">>": 9,
    "+": 10, "-": 10, "*": 11, "/": 11,
}  # fmt: skip
_BITS = ("&", "|", "^", "<<", ">>")
_NAMES = {"not": "not_", "any_lane": "any"}


class NumpyExpressions(Printer):
    """Prints the expressions of one module; `numbers` knows which literals need an explicit type."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.numbers = Numbers(module)

    def literal(self, literal: ir.Literal) -> str:
        """The shortest text that reads back to the same float64."""
        return repr(literal.value)

    def typed(self, *exprs: ir.Expr) -> list[str]:
        """Texts of operands: of uints that are all plain numbers, one has an explicit type."""
        texts = [self.expr(expr) for expr in exprs]
        plain = [index for index, expr in enumerate(exprs) if kind_of(expr.type) == "uint" and self.numbers.plain(expr)]
        if plain and not any(kind_of(expr.type) == "uint" and not self.numbers.plain(expr) for expr in exprs):
            texts[plain[0]] = f"to_uint({texts[plain[0]]})"
        return texts

    def expr(self, expr: ir.Expr, least: int = 0) -> str:
        text, binding = self.bound(expr)
        return text if binding >= least else f"({text})"

    def swizzle(self, swizzle: ir.Swizzle) -> tuple[str, int]:
        if len(swizzle.components) == 1:
            return f"{self.expr(swizzle.value, POSTFIX)}[{'xyzw'.index(swizzle.components)}]", POSTFIX
        return f'swizzle({self.expr(swizzle.value)}, "{swizzle.components}")', PRIMARY

    def select(self, select: ir.Select) -> tuple[str, int]:
        return f"select({self.expr(select.condition)}, {', '.join(self.typed(select.yes, select.no))})", PRIMARY

    def index(self, index: ir.Index) -> tuple[str, int]:
        length = index.value.type.length if isinstance(index.value.type, Array) else components(index.value.type)
        inside = isinstance(index.index, ir.Literal) and 0 <= index.index.value < length
        if inside and not isinstance(unnested(index.type)[0], Struct):
            return super().index(index)
        return f"index({self.expr(index.value)}, {self.expr(index.index)})", PRIMARY

    def unary(self, unary: ir.Unary) -> tuple[str, int]:
        operand = unary.operand
        if unary.op == "!" and isinstance(operand, ir.Intrinsic) and operand.name == "any_lane":
            return f"not {self.expr(operand)}", 4
        if unary.op == "!":
            return f"not_({self.expr(operand)})", PRIMARY
        plain = self.numbers.plain(operand)
        text = self.typed(operand)[0] if plain and unary.type == UINT else self.expr(operand, UNARY)
        if plain and unary.type == INT and unary.op == "-" and self.numbers.may_wrap(unary):
            return f"to_int(-{text})", PRIMARY
        return f"{unary.op}{text}", UNARY

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        op, left, right = binary.op, binary.left, binary.right
        kind, plain = kind_of(left.type), self.numbers.plain(left) and self.numbers.plain(right)
        function = self.operator_function(binary, plain)
        if function:
            # the value and the count may have different types: neither determines the other's
            texts = [*self.typed(left), *self.typed(right)] if op in ("<<", ">>") else self.typed(left, right)
            text = f"{function}({', '.join(texts)})"
            return (f"not_({text})" if op == "!=" else text), PRIMARY
        op = _OPERATORS.get(op, op)
        level = PYTHON_PRECEDENCE[op]
        first, second = (
            self.operand(side, binary.op, level + extra) for side, extra in ((left, level == 5), (right, 1))
        )
        if second[0] == "-" and op in ("+", "-"):
            second = f"({second})"
        if kind == "uint" and plain:
            first = f"to_uint({self.expr(left)})"
        text = f"{first} {op} {second}"
        if kind == "int" and plain and op in ("+", "-", "*") and self.numbers.may_wrap(binary):
            return f"to_int({text})", PRIMARY
        return text, level

    def operand(self, expr: ir.Expr, op: str, least: int) -> str:
        """An operand; always in parentheses around bitwise operators, whose precedence differs from GLSL's."""
        mixed = isinstance(expr, ir.Binary) and expr.op != op and (op in _BITS or expr.op in _BITS)
        return self.expr(expr, UNARY if mixed else least)

    def operator_function(self, binary: ir.Binary, plain: bool) -> str:
        """The runtime's function for an operator that differs from Python's own; else ''."""
        op, left, right = binary.op, binary.left, binary.right
        if op in ("==", "!="):
            return "" if isinstance(left.type, Scalar) else "equals"
        if op == "*" and isinstance(left.type, Matrix) and not isinstance(right.type, Scalar):
            return "mat_mul" if isinstance(right.type, Matrix) else "mat_vec"
        if op == "*" and isinstance(left.type, Vector) and isinstance(right.type, Matrix):
            return "vec_mat"
        if op == "/" and kind_of(left.type) == "float":
            return "divide" if plain and not nonzero(right) else ""
        if op in ("<<", ">>"):
            safe = isinstance(right, ir.Literal) and 0 <= right.value < 32 and not self.numbers.plain(left)
            return "" if safe else {"<<": "shift_left", ">>": "shift_right"}[op]
        return {"/": "int_divide", "%": "int_remainder"}.get(op, "")

    def arguments(self, args: tuple[ir.Expr, ...]) -> str:
        texts = self.typed(*args)
        if len(args) > 2 and texts[0] == self.typed(*args[:2])[0]:
            return ", ".join(texts)
        return ", ".join([*self.typed(*args[:2]), *texts[2:]])  # clamp computes with the first two alone

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        return f"{_NAMES.get(call.name, call.name)}({self.arguments(call.args)})", PRIMARY

    def call(self, call: ir.Call) -> str:
        function = self.by_key[call.function]
        passed = [arg for arg, param in zip(call.args, function.params, strict=True) if param.direction != "out"]
        return f"{function.name}({', '.join([self.typed(arg)[0] for arg in passed])})"

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        type_, args = construct.type, construct.args
        if isinstance(type_, Struct):
            texts = [self.typed(arg)[0] for arg in args]
            fields = [f"{field.name}={text}" for field, text in zip(type_.fields, texts, strict=True)]
            return f"Record({', '.join(fields)})", PRIMARY
        if isinstance(type_, Array):
            texts = self.typed(*args) if kind_of(type_.element) != "uint" else [self.typed(arg)[0] for arg in args]
            repeated = len(texts) > 4 and len(set(texts)) == 1
            return (
                f"array(*[{texts[0]}] * {len(texts)})" if repeated else f"array({', '.join(texts)})",
                PRIMARY,
            )
        kind, size = kind_of(type_), type_.columns if isinstance(type_, Matrix) else components(type_)
        if len(args) > 1:
            parts = self.converted(kind, *args)
            return (f"mat({size}, {parts})" if isinstance(type_, Matrix) else f"vec({parts})"), PRIMARY
        part = self.converted(kind, *args)
        if isinstance(type_, Matrix):
            rows = f", {type_.rows}" if type_.rows != size else ""
            return f"{'resize' if isinstance(args[0].type, Matrix) else 'diagonal'}({size}, {part}{rows})", PRIMARY
        if isinstance(args[0].type, Scalar):
            return (f"splat({size}, {part})" if isinstance(type_, Vector) else part), PRIMARY
        if components(args[0].type) == size:
            return part, PRIMARY
        if size == 1:
            converts = part != self.expr(args[0])  # by a call, which needs no parentheses
            return f"{part if converts else self.expr(args[0], POSTFIX)}[0]", POSTFIX
        return f'swizzle({part}, "{"xyzw"[:size]}")', PRIMARY

    def converted(self, kind: str, *args: ir.Expr) -> str:
        """The arguments of a constructor, each converted to its kind."""
        texts = self.typed(*args)
        conversions = [kind_of(arg.type) != kind for arg in args]
        return ", ".join(
            f"to_{kind}({text})" if converts else text for text, converts in zip(texts, conversions, strict=True)
        )
