"""Walking and rewriting IR: the one place that knows which fields of a node are its children.

Rewriting keeps a node's identity when nothing below it changed, so that an idle pass costs no memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias, cast

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

RewriteExpr: TypeAlias = Callable[[Expr], Expr]
RewriteStmt: TypeAlias = Callable[[Stmt], "Block | None"]


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
    if isinstance(expr, Call | Intrinsic | Construct):
        return expr._replace(args=new)
    if isinstance(expr, Binary):
        return expr._replace(left=new[0], right=new[1])
    if isinstance(expr, Swizzle | Member):
        return expr._replace(value=new[0])
    if isinstance(expr, Unary):
        return expr._replace(operand=new[0])
    if isinstance(expr, Select):
        return expr._replace(condition=new[0], yes=new[1], no=new[2])
    if isinstance(expr, Index):
        return expr._replace(value=new[0], index=new[1])
    return expr


def rewrite(expr: Expr, change: RewriteExpr) -> Expr:
    """Rebuilds `expr` bottom-up, passing every node through `change`."""
    old = operands(expr)
    if old:
        new = tuple([rewrite(operand, change) for operand in old])
        for before, after in zip(old, new, strict=True):
            if before is not after:
                expr = with_operands(expr, new)
                break
    return change(expr)


def rewrite_stmt(stmt: Stmt, change: RewriteExpr, restate: RewriteStmt | None = None) -> Block:
    """Rewrites a statement's expressions, then its inner blocks, then the statement itself.

    `restate` may return a block to put in the statement's place, or None to keep it.
    """
    new = stmt
    if isinstance(stmt, Declare):
        if stmt.value is not None:
            value = rewrite(stmt.value, change)
            new = stmt if value is stmt.value else stmt._replace(value=value)
    elif isinstance(stmt, Assign):
        target, value = rewrite(stmt.target, change), rewrite(stmt.value, change)
        if target is not stmt.target or value is not stmt.value:
            new = stmt._replace(target=target, value=value)
    elif isinstance(stmt, If):
        condition = rewrite(stmt.condition, change)
        then = rewrite_block(stmt.then, change, restate)
        otherwise = rewrite_block(stmt.otherwise, change, restate)
        if condition is not stmt.condition or then is not stmt.then or otherwise is not stmt.otherwise:
            new = If(condition, then, otherwise, stmt.span)
    elif isinstance(stmt, For):
        init = _only(rewrite_stmt(stmt.init, change)) if stmt.init is not None else None
        test = rewrite(stmt.condition, change) if stmt.condition is not None else None
        step = _only(rewrite_stmt(stmt.step, change)) if stmt.step is not None else None
        body = rewrite_block(stmt.body, change, restate)
        if init is not stmt.init or test is not stmt.condition or step is not stmt.step or body is not stmt.body:
            new = For(init, test, step, body, stmt.span)
    elif isinstance(stmt, While):
        condition, body = rewrite(stmt.condition, change), rewrite_block(stmt.body, change, restate)
        if condition is not stmt.condition or body is not stmt.body:
            new = While(condition, body, stmt.span)
    elif isinstance(stmt, Return):
        if stmt.value is not None:
            value = rewrite(stmt.value, change)
            new = stmt if value is stmt.value else stmt._replace(value=value)
    elif isinstance(stmt, Evaluate):
        call = rewrite(stmt.call, change)
        new = stmt if call is stmt.call else stmt._replace(call=call)
    elif isinstance(stmt, Assume):
        condition = rewrite(stmt.condition, change)
        new = stmt if condition is stmt.condition else Assume(condition, stmt.span)
    if restate is not None:
        replacement = restate(new)
        if replacement is not None:
            return replacement
    return (new,)


def rewrite_block(block: Block, change: RewriteExpr, restate: RewriteStmt | None = None) -> Block:
    """Rewrites every statement of a block; the same block when nothing changed."""
    result: list[Stmt] = []
    changed = False
    for stmt in block:
        new = rewrite_stmt(stmt, change, restate)
        changed = changed or len(new) != 1 or new[0] is not stmt
        result.extend(new)
    return tuple(result) if changed else block


def rewrite_function(function: Function, change: RewriteExpr, restate: RewriteStmt | None = None) -> Function:
    """Rewrites a function's body."""
    if function.body is None:
        return function
    body = rewrite_block(function.body, change, restate)
    return function if body is function.body else function._replace(body=body)


def rewrite_module(module: Module, change: RewriteExpr, restate: RewriteStmt | None = None) -> Module:
    """Rewrites the body of every function (not the values of constants)."""
    functions = tuple([rewrite_function(function, change, restate) for function in module.functions])
    return module._replace(functions=functions)


def _only(block: Block) -> Stmt:
    (stmt,) = block
    return stmt


def expressions(stmt: Stmt) -> tuple[Expr, ...]:
    """The expressions that stand directly in a statement (not those of inner statements)."""
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
    """`expr` and everything inside it."""
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
    found: set[str] = set()
    for function in module.functions:
        for stmt in statements(function.body or ()):
            stack = list(expressions(stmt))
            while stack:
                node = stack.pop()
                kind = type(node)
                if kind is Local or kind is Literal or kind is Global:
                    continue
                if isinstance(node, Intrinsic):
                    found.add(node.name)
                stack += operands(node)
    return found


def calls_of(stmt: Stmt) -> list[Call]:
    """The calls that stand in a statement's own expressions, in the order of the text."""
    found: list[Call] = []
    stack = list(reversed(expressions(stmt)))
    while stack:
        node = stack.pop()
        kind = type(node)
        if kind is Local or kind is Literal or kind is Global:
            continue
        if isinstance(node, Call):
            found.append(node)
        stack += operands(node)[::-1]
    return found


def callees(function: Function) -> list[str]:
    """The keys of the functions that `function` calls, each once, in the order of first call."""
    found: dict[str, None] = {}
    for stmt in statements(function.body or ()):
        for call in calls_of(stmt):
            found[call.function] = None
    return list(found)


def root(target: Expr) -> Local | None:
    """The function's own variable that an assignment to `target` changes, or None where it is none of these."""
    found = written_root(target)
    return found if isinstance(found, Local) else None


def written_root(target: Expr) -> Local | Global | None:
    """The variable that an assignment to `target` changes, the function's own or the module's."""
    while isinstance(target, Swizzle | Index | Member):
        target = target.value
    return target if isinstance(target, Local | Global) else None
