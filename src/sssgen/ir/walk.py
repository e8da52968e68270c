"""Walking IR: the one place that knows which fields of a node are its operands. For rewriting see `ir.transform`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import itemgetter
from typing import Any, TypeVar

from sssgen.ir.nodes import (
    Assign,
    Assume,
    Binary,
    Block,
    Call,
    Construct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    Global,
    If,
    Index,
    Intrinsic,
    Literal,
    Local,
    Member,
    MemoryOperation,
    Module,
    Return,
    Select,
    Stmt,
    Swizzle,
    Unary,
    While,
)

_Part = TypeVar("_Part", bound=Call | Intrinsic)

_LEAVES = frozenset({Literal, Local, Global})
_LEAF = itemgetter(slice(0, 0))
_OPERANDS: dict[type, Callable[[Any], tuple[Expr, ...]]] = {
    Literal: _LEAF,
    Local: _LEAF,
    Global: _LEAF,
    Unary: itemgetter(slice(2, 3)),
    Binary: itemgetter(slice(2, 4)),
    Select: itemgetter(slice(1, 4)),
    Call: itemgetter(2),
    Intrinsic: itemgetter(2),
    Construct: itemgetter(1),
    Swizzle: itemgetter(slice(1, 2)),
    Index: itemgetter(slice(1, 3)),
    Member: itemgetter(slice(1, 2)),
}
"""Where the operands of each class are in its tuple: finding them is most of the work of a pass that changes little."""


def operands(expr: Expr) -> tuple[Expr, ...]:
    """The expressions directly inside `expr`."""
    return _OPERANDS[expr.__class__](expr)


def with_operands(expr: Expr, new: tuple[Expr, ...]) -> Expr:
    """`expr` with other operands, in the order of `operands`."""
    if isinstance(expr, Binary):
        return Binary(expr.type, expr.op, new[0], new[1], expr.span)
    if isinstance(expr, Intrinsic):
        return Intrinsic(expr.type, expr.name, new, expr.span)
    if isinstance(expr, Construct):
        return Construct(expr.type, new, expr.span)
    if isinstance(expr, Call):
        return Call(expr.type, expr.function, new, expr.span)
    if isinstance(expr, Swizzle):
        return Swizzle(expr.type, new[0], expr.components, expr.span)
    if isinstance(expr, Unary):
        return Unary(expr.type, expr.op, new[0], expr.span)
    if isinstance(expr, Select):
        return Select(expr.type, new[0], new[1], new[2], expr.span)
    if isinstance(expr, Index):
        return Index(expr.type, new[0], new[1], expr.span)
    return Member(expr.type, new[0], expr.field, expr.span) if isinstance(expr, Member) else expr


def expressions(stmt: Stmt) -> tuple[Expr, ...]:
    """The expressions of a statement itself (not those of inner statements)."""
    if type(stmt) is Assign:
        return (stmt.target, stmt.value)
    if isinstance(stmt, Declare | Return):
        return (stmt.value,) if stmt.value is not None else ()
    if isinstance(stmt, If | While | Assume):
        return (stmt.condition,)
    if isinstance(stmt, For):
        return (stmt.condition,) if stmt.condition is not None else ()
    if isinstance(stmt, Evaluate):
        return (stmt.call,)
    if isinstance(stmt, MemoryOperation):
        return (*stmt.args, stmt.result) if stmt.result is not None else stmt.args
    return ()


def written_places(stmt: Stmt) -> tuple[Expr, ...]:
    """The places that a statement itself writes; those that its calls write are not among them."""
    if type(stmt) is Assign:
        return (stmt.target,)
    if isinstance(stmt, MemoryOperation):
        return (*stmt.args[:1], stmt.result) if stmt.result is not None else stmt.args[:1]
    return ()


def inner_statements(stmt: Stmt) -> tuple[Stmt, ...]:
    """The statements directly inside a statement, a loop's header first."""
    if isinstance(stmt, If):
        return stmt.then + stmt.otherwise
    if isinstance(stmt, For):
        header = tuple(part for part in (stmt.init, stmt.step) if part is not None)
        return header + stmt.body
    if isinstance(stmt, While):
        return stmt.body
    return ()


def statements(block: Block) -> Iterator[Stmt]:
    """Every statement of a block, inner ones too, in source order."""
    stack = list(reversed(block))
    while stack:
        stmt = stack.pop()
        yield stmt
        if isinstance(stmt, (If, For, While)):
            stack.extend(reversed(inner_statements(stmt)))


def subexpressions(expr: Expr) -> Iterator[Expr]:
    """`expr` and all its operands, recursively."""
    stack = [expr]
    while stack:
        node = stack.pop()
        yield node
        stack.extend(reversed(operands(node)))


def all_expressions(block: Block) -> Iterator[Expr]:
    """Every expression of a block, subexpressions too."""
    for stmt in statements(block):
        for expr in expressions(stmt):
            yield from subexpressions(expr)


def builtins_of(module: Module) -> set[str]:
    """The names of the builtins that the functions of a module call."""
    return {part.name for function in module.functions for part in inner_parts(function.body or (), Intrinsic)}


def calls_of(block: Block) -> list[Call]:
    """The calls in the expressions of a block, those of inner statements too, in the order of the text."""
    return inner_parts(block, Call)


def inner_parts(block: Block, kind: type[_Part]) -> list[_Part]:
    """The expressions of one class in a block, those of inner statements too, in the order of the text."""
    parts: list[_Part] = []
    leaves = _LEAVES
    inside = _OPERANDS
    for stmt in statements(block):
        stack: list[Expr] = [*expressions(stmt)[::-1]]
        while stack:
            node = stack.pop()
            class_ = node.__class__
            if class_ in leaves:
                continue
            if class_ is kind:
                parts.append(node)  # type: ignore[arg-type]  # narrowed by its exact class
            stack += inside[class_](node)[::-1]
    return parts


def callees(function: Function) -> list[str]:
    """The keys of the functions that `function` calls, each once, in the order of first call."""
    return list(dict.fromkeys([call.function for call in calls_of(function.body or ())]))


def root(target: Expr) -> Local | None:
    """The local variable that an assignment to `target` changes; None if it is another variable."""
    variable = written_root(target)
    return variable if isinstance(variable, Local) else None


def written_root(target: Expr) -> Local | Global | None:
    """The variable that an assignment to `target` changes, local or global."""
    while isinstance(target, Swizzle | Index | Member):
        target = target.value
    return target if isinstance(target, Local | Global) else None
