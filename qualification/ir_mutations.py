"""Single changes of a function, as a wrong pass or printer, or an edit by hand, could make them.

Each keeps the types: another operator or comparison, swapped operands, arms or branches, another constant, a dropped
statement, minus sign or conversion, another component or index, a shift or division of the other signedness, other
bounds of a clamp, another builtin.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from sssgen.ir.nodes import (
    Assign,
    Binary,
    Block,
    Break,
    Call,
    Construct,
    Continue,
    Expr,
    Function,
    Global,
    If,
    Index,
    Intrinsic,
    Literal,
    Local,
    Select,
    Stmt,
    Swizzle,
    Unary,
)
from sssgen.ir.rules import element_type
from sssgen.ir.transform import rewrite_function
from sssgen.ir.types import INT, UINT, Matrix, components, kind_of, vector_of
from sssgen.ir.walk import all_expressions, statements

_ARITHMETIC = {"+": ("-", "*"), "-": ("+",), "*": ("+", "/"), "/": ("*",), "%": ("/",)}
_BITS = {"&": ("|", "^"), "|": ("&", "^"), "^": ("&", "|"), "<<": (">>",), ">>": ("<<",)}
_COMPARISONS = {
    "<": ("<=", ">", ">="), "<=": ("<", ">="), ">": (">=", "<", "<="), ">=": (">", "<="), "==": ("!=",), "!=": ("==",),
}  # fmt: skip
_LOGIC = {"&&": ("||",), "||": ("&&",), "^^": ("||",)}
_BUILTINS = {
    "min": ("max",), "max": ("min",), "sin": ("cos",), "cos": ("sin",), "floor": ("ceil", "trunc", "roundEven"),
    "ceil": ("floor",), "fract": ("floor",), "trunc": ("floor",), "exp": ("exp2",), "exp2": ("exp",), "log": ("log2",),
    "log2": ("log",), "sqrt": ("inversesqrt",), "inversesqrt": ("sqrt",), "any": ("all",), "all": ("any",),
    "lessThan": ("lessThanEqual", "greaterThan"), "lessThanEqual": ("lessThan",), "greaterThan": ("greaterThanEqual",),
    "greaterThanEqual": ("greaterThan", "lessThan"), "equal": ("notEqual",), "notEqual": ("equal",),
    "findLSB": ("findMSB",), "findMSB": ("findLSB",), "mod": ("fmod",),
}  # fmt: skip
_UNWRAPPED = frozenset({"abs", "fract", "floor", "normalize", "sign", "transpose", "trunc", "ceil", "round"})


class Mutation(NamedTuple):
    """A change of one node."""

    change: str
    line: int
    node: Expr | Stmt
    replacement: Expr | Block


def mutations(function: Function) -> list[Mutation]:
    """All changes of a function's body."""
    body = function.body or ()
    mutations: list[Mutation] = []
    seen: set[int] = set()
    for expr in all_expressions(body):
        if id(expr) not in seen:
            seen.add(id(expr))
            mutations += [Mutation(change, expr.span.line, expr, new) for change, new in _changed(expr)]
    for stmt in statements(body):
        mutations += [Mutation(change, stmt.span.line, stmt, new) for change, new in _restated(stmt)]
    return mutations


def mutated(function: Function, mutation: Mutation) -> Function:
    """The function with one change."""

    def change(expr: Expr) -> Expr:
        return mutation.replacement if expr is mutation.node else expr  # type: ignore[return-value]  # of the node's kind

    def restate(stmt: Stmt) -> Block | None:
        return mutation.replacement if stmt is mutation.node else None  # type: ignore[return-value]  # of the node's kind

    return rewrite_function(function, change, restate)


def _changed(expr: Expr) -> Iterator[tuple[str, Expr]]:
    if isinstance(expr, Literal):
        yield from _constants(expr)
    elif isinstance(expr, Binary):
        yield from _operators(expr)
    elif isinstance(expr, Unary):
        yield f"dropped {expr.op}", expr.operand
    elif isinstance(expr, Select):
        yield "swapped arms", expr._replace(yes=expr.no, no=expr.yes)
    elif isinstance(expr, Swizzle):
        yield from _components(expr)
    elif isinstance(expr, Index) and isinstance(expr.index, Literal):
        elements = element_type(expr.value.type)
        other = (int(expr.index.value) + 1) % (elements[1] if elements is not None else 1)
        yield "wrong index", expr._replace(index=expr.index._replace(value=other))
    elif isinstance(expr, Intrinsic):
        for name in _BUILTINS.get(expr.name, ()):
            yield f"{expr.name} → {name}", expr._replace(name=name)
        if expr.name in _UNWRAPPED and expr.args[0].type == expr.type:
            yield f"dropped {expr.name}", expr.args[0]
        if expr.name == "clamp":
            yield "dropped lower bound", expr._replace(name="min", args=(expr.args[0], expr.args[2]))
            yield "dropped upper bound", expr._replace(name="max", args=(expr.args[0], expr.args[1]))
        yield from _swapped(expr)
    elif isinstance(expr, Call):
        yield from _swapped(expr)
    elif isinstance(expr, Construct):
        yield from _conversions(expr)


def _constants(literal: Literal) -> Iterator[tuple[str, Expr]]:
    value = literal.value
    if isinstance(value, bool):
        yield "other bool", literal._replace(value=not value)
        return
    others: list[float | int] = [value + 1, value - 1, value * 2, -value]
    if kind_of(literal.type) == "float":
        others += [value * 0.5, value * 1.001]
    elif literal.type == UINT:
        others = [int(other) & 0xFFFFFFFF for other in others]
    else:
        others = [other for other in others if -(2**31) <= other < 2**31]
    for other in dict.fromkeys(others):
        if other != value:
            yield f"{value} → {other}", literal._replace(value=other)


def _operators(expr: Binary) -> Iterator[tuple[str, Expr]]:
    op, left, right = expr.op, expr.left, expr.right
    matrices = isinstance(left.type, Matrix), isinstance(right.type, Matrix)
    if matrices[0] == matrices[1]:
        for table in (_ARITHMETIC, _BITS, _COMPARISONS, _LOGIC):
            for other in table.get(op, ()):
                if not matrices[0] or (other in "+-" and left.type == right.type):
                    yield f"{op} → {other}", expr._replace(op=other)
    if op in ("-", "/", "%", "<<", ">>", "<", "<=") and left.type == right.type:
        yield f"swapped operands of {op}", expr._replace(left=right, right=left)
    if op in (">>", "/", "<") and kind_of(left.type) in ("int", "uint"):
        kind = "uint" if kind_of(left.type) == "int" else "int"
        other_left = _as(kind, left)
        other_right = _as(kind, right) if op != ">>" else right
        if op == "<":
            yield "other signedness of <", expr._replace(left=other_left, right=other_right)
        else:
            result = Binary(vector_of(kind, components(expr.type)), op, other_left, other_right, expr.span)
            yield f"other signedness of {op}", _as(kind_of(left.type), result)
    if op == ">>" and isinstance(right, Literal) and kind_of(left.type) == "int" and 0 < right.value < 31:
        yield ">> → /", Binary(expr.type, "/", left, _like(left, 1 << int(right.value)), expr.span)


def _as(kind: str, expr: Expr) -> Expr:
    return Construct(vector_of(kind, components(expr.type)), (expr,), expr.span)


def _like(expr: Expr, value: int) -> Expr:
    literal = Literal(INT, value, expr.span)
    return literal if expr.type == INT else Construct(expr.type, (literal,), expr.span)


def _components(expr: Swizzle) -> Iterator[tuple[str, Expr]]:
    names = "xyzw"[: components(expr.value.type)]
    for position, name in enumerate(expr.components):
        other = names[(names.index(name) + 1) % len(names)]
        changed = f"{expr.components[:position]}{other}{expr.components[position + 1 :]}"
        if changed != expr.components:
            yield f".{expr.components} → .{changed}", expr._replace(components=changed)
    if expr.components[::-1] != expr.components:
        yield f".{expr.components} reversed", expr._replace(components=expr.components[::-1])


def _swapped(expr: Intrinsic | Call) -> Iterator[tuple[str, Expr]]:
    args = expr.args
    for index in range(len(args) - 1):
        places = [isinstance(arg, Local | Global) for arg in args[index : index + 2]]  # an out argument stays one
        if args[index].type == args[index + 1].type and places[0] == places[1]:
            new = (*args[:index], args[index + 1], args[index], *args[index + 2 :])
            yield f"swapped arguments {index + 1} and {index + 2}", expr._replace(args=new)


def _conversions(expr: Construct) -> Iterator[tuple[str, Expr]]:
    args = expr.args
    if len(args) == 1 and kind_of(expr.type) and kind_of(expr.type) != kind_of(args[0].type):
        inner = args[0]
        if isinstance(inner, Construct) and len(inner.args) == 1 and inner.args[0].type == expr.type:
            yield "missing conversion", inner.args[0]
        if kind_of(inner.type) == "float" and kind_of(expr.type) in ("int", "uint"):
            for name in ("floor", "roundEven"):
                yield (
                    f"{name} before a conversion",
                    expr._replace(args=(Intrinsic(inner.type, name, (inner,), expr.span),)),
                )
    for index in range(len(args) - 1):
        if args[index].type == args[index + 1].type:
            new = (*args[:index], args[index + 1], args[index], *args[index + 2 :])
            yield f"swapped parts {index + 1} and {index + 2}", expr._replace(args=new)


def _restated(stmt: Stmt) -> Iterator[tuple[str, Block]]:
    if isinstance(stmt, Assign):
        yield "dropped statement", ()
        for op in {"+": ("-", ""), "-": ("+",), "*": ("/",), "/": ("*",), "^": ("|",), "|": ("&",), "&": ("|",)}.get(
            stmt.op, ()
        ):
            plain = not isinstance(stmt.target.type, Matrix) and not isinstance(stmt.value.type, Matrix)
            if plain and (op or stmt.target.type == stmt.value.type):
                yield f"{stmt.op}= → {op}=", (stmt._replace(op=op),)
    elif isinstance(stmt, Break | Continue):
        yield "dropped statement", ()
    elif isinstance(stmt, If):
        yield "swapped branches", (stmt._replace(then=stmt.otherwise, otherwise=stmt.then),)
        yield "always the first branch", stmt.then
        yield "always the second branch", stmt.otherwise
