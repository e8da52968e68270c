"""The variables that statements read and write, in functions whose calls are lifted."""

from __future__ import annotations

from collections.abc import Iterable

from sssgen.ir.nodes import Assign, Block, Call, Declare, Expr, Local, Stmt
from sssgen.ir.walk import all_expressions, expressions, root, statements, subexpressions
from sssgen.passes.lift_calls import Functions, out_arguments


def is_local(expr: Expr, name: str) -> bool:
    return isinstance(expr, Local) and expr.name == name


def mentions(expr: Expr, name: str) -> bool:
    return any(is_local(part, name) for part in subexpressions(expr))


def own_reads(stmt: Stmt, functions: Functions | None = None) -> Iterable[str]:
    """The variables that a statement's own expressions read, each as often as it is read.

    With `functions`, what a call only writes does not count as read.
    """
    names = []
    for expr in expressions(stmt):
        parts = list(subexpressions(expr))
        if isinstance(stmt, Assign) and expr is stmt.target and not stmt.op and isinstance(expr, Local):
            continue
        if functions is not None and isinstance(expr, Call):
            params = functions[expr.function].params
            read = [arg for arg, param in zip(expr.args, params, strict=True) if param.direction != "out"]
            parts = [part for arg in read for part in subexpressions(arg)]
        names += [part.name for part in parts if isinstance(part, Local)]
    return names


def reads_of(block: Block, functions: Functions | None = None) -> list[str]:
    """The variables that statements, and all inside them, read; see `own_reads`."""
    return [name for stmt in statements(block) for name in own_reads(stmt, functions)]


def writes_of(block: Block, functions: Functions) -> set[str]:
    """The variables that statements, and all inside them, change, not by declaring them."""
    return {name for stmt in statements(block) for name in own_writes(stmt, functions)}


def set_in(stmt: Stmt, functions: Functions) -> set[str]:
    """The variables that a statement, and all inside it, change or declare.

    Sibling blocks may declare variables of one name each; without control flow they are one block.
    """
    declared = {inner.name for inner in statements((stmt,)) if isinstance(inner, Declare)}
    return writes_of((stmt,), functions) | declared


def own_writes(stmt: Stmt, functions: Functions) -> list[str]:
    """The variables that a statement itself changes, not by declaring them."""
    names = [name for expr in expressions(stmt) for name in out_arguments(expr, functions)]
    target = root(stmt.target) if isinstance(stmt, Assign) else None
    return names if target is None else [*names, target.name]


def written_outside(stmt: Stmt, functions: Functions) -> set[str]:
    """The variables that a statement changes but does not itself declare."""
    own = {inner.name for inner in statements((stmt,)) if isinstance(inner, Declare)}
    return writes_of((stmt,), functions) - own


def may_change(block: Block, name: str) -> bool:
    """Whether a block may change a variable: it assigns to it, or passes it to a function."""
    for stmt in statements(block):
        if isinstance(stmt, Assign) and (place := root(stmt.target)) is not None and place.name == name:
            return True
    calls = (expr for expr in all_expressions(block) if isinstance(expr, Call))
    return any((place := root(arg)) is not None and place.name == name for call in calls for arg in call.args)
