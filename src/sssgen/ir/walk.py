"""Walking IR: the one place that knows which fields of a node are its operands. For rewriting see `ir.transform`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import cast

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
    Module,
    Return,
    Select,
    Stmt,
    Swizzle,
    Unary,
    While,
)


def operands(expr: Expr) -> tuple[Expr, ...]:
    """The expressions directly inside `expr`."""
    kind = type(expr)
    if kind is Literal or kind is Local or kind is Global:
        return ()
    if kind is Call or kind is Intrinsic or kind is Construct:
        return expr.args  # type: ignore[union-attr]  # the three classes with args
    if kind is Binary:
        return (expr.left, expr.right)  # type: ignore[union-attr]  # it is a Binary
    if kind is Swizzle or kind is Member:
        return (expr.value,)  # type: ignore[union-attr, return-value]  # one of the two
    if isinstance(expr, Unary):
        return (expr.operand,)
    if isinstance(expr, Select):
        return (expr.condition, expr.yes, expr.no)
    index = cast(Index, expr)
    return (index.value, index.index)


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
    names: set[str] = set()
    for function in module.functions:
        for stmt in statements(function.body or ()):
            stack = list(expressions(stmt))
            while stack:
                node = stack.pop()
                kind = type(node)
                if kind is Local or kind is Literal or kind is Global:
                    continue
                if isinstance(node, Intrinsic):
                    names.add(node.name)
                stack += operands(node)
    return names


def calls_of(stmt: Stmt) -> list[Call]:
    """The calls in a statement's own expressions, in the order of the text."""
    calls: list[Call] = []
    stack = list(reversed(expressions(stmt)))
    while stack:
        node = stack.pop()
        kind = type(node)
        if kind is Local or kind is Literal or kind is Global:
            continue
        if isinstance(node, Call):
            calls.append(node)
        stack += operands(node)[::-1]
    return calls


def callees(function: Function) -> list[str]:
    """The keys of the functions that `function` calls, each once, in the order of first call."""
    keys: dict[str, None] = {}
    for stmt in statements(function.body or ()):
        for call in calls_of(stmt):
            keys[call.function] = None
    return list(keys)


def root(target: Expr) -> Local | None:
    """The local variable that an assignment to `target` changes; None if it is another variable."""
    variable = written_root(target)
    return variable if isinstance(variable, Local) else None


def written_root(target: Expr) -> Local | Global | None:
    """The variable that an assignment to `target` changes, local or global."""
    while isinstance(target, Swizzle | Index | Member):
        target = target.value
    return target if isinstance(target, Local | Global) else None
