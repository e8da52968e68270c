"""Walking IR: the one place that knows which fields of a node are its operands. For rewriting see `ir.transform`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import itemgetter
from typing import Any, TypeVar

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY

_Part = TypeVar("_Part", bound=ir.Expr)

_LEAVES = frozenset({ir.Literal, ir.Local, ir.Global})
_LEAF = itemgetter(slice(0, 0))
_OPERANDS: dict[type, Callable[[Any], tuple[ir.Expr, ...]]] = {
    ir.Literal: _LEAF,
    ir.Local: _LEAF,
    ir.Global: _LEAF,
    ir.Unary: itemgetter(slice(2, 3)),
    ir.Binary: itemgetter(slice(2, 4)),
    ir.Select: itemgetter(slice(1, 4)),
    ir.Call: itemgetter(2),
    ir.Intrinsic: itemgetter(2),
    ir.Construct: itemgetter(1),
    ir.Swizzle: itemgetter(slice(1, 2)),
    ir.Index: itemgetter(slice(1, 3)),
    ir.Member: itemgetter(slice(1, 2)),
}
"""Where the operands of each class are in its tuple: finding them is most of the work of a pass that changes little."""


def operands(expr: ir.Expr) -> tuple[ir.Expr, ...]:
    """The expressions directly inside `expr`."""
    return _OPERANDS[expr.__class__](expr)


def with_operands(expr: ir.Expr, new: tuple[ir.Expr, ...]) -> ir.Expr:
    """`expr` with other operands, in the order of `operands`."""
    if isinstance(expr, ir.Binary):
        return ir.Binary(expr.type, expr.op, new[0], new[1], expr.span)
    if isinstance(expr, ir.Intrinsic):
        return ir.Intrinsic(expr.type, expr.name, new, expr.span)
    if isinstance(expr, ir.Construct):
        return ir.Construct(expr.type, new, expr.span)
    if isinstance(expr, ir.Call):
        return ir.Call(expr.type, expr.function, new, expr.span)
    if isinstance(expr, ir.Swizzle):
        return ir.Swizzle(expr.type, new[0], expr.components, expr.span)
    if isinstance(expr, ir.Unary):
        return ir.Unary(expr.type, expr.op, new[0], expr.span)
    if isinstance(expr, ir.Select):
        return ir.Select(expr.type, new[0], new[1], new[2], expr.span)
    if isinstance(expr, ir.Index):
        return ir.Index(expr.type, new[0], new[1], expr.span)
    return ir.Member(expr.type, new[0], expr.field, expr.span) if isinstance(expr, ir.Member) else expr


_WITH_VALUE = (ir.Declare, ir.Return)
_WITH_CONDITION = (ir.If, ir.While, ir.Assume)
_WITH_BLOCKS = (ir.If, ir.For, ir.While)
_PARTS = (ir.Swizzle, ir.Index, ir.Member)
_VARIABLES = (ir.Local, ir.Global)


def expressions(stmt: ir.Stmt) -> tuple[ir.Expr, ...]:
    """The expressions of a statement itself (not those of inner statements)."""
    if type(stmt) is ir.Assign:
        return (stmt.target, stmt.value)
    if isinstance(stmt, _WITH_VALUE):
        return (stmt.value,) if stmt.value is not None else ()
    if isinstance(stmt, _WITH_CONDITION):
        return (stmt.condition,)
    if isinstance(stmt, ir.For):
        return (stmt.condition,) if stmt.condition is not None else ()
    if isinstance(stmt, ir.Evaluate):
        return (stmt.call,)
    if isinstance(stmt, ir.MemoryOperation):
        return (*stmt.args, stmt.result) if stmt.result is not None else stmt.args
    return ()


def written_places(stmt: ir.Stmt) -> tuple[ir.Expr, ...]:
    """The places that a statement itself writes; those that its calls write are not among them."""
    if type(stmt) is ir.Assign:
        return (stmt.target,)
    if isinstance(stmt, ir.MemoryOperation):
        places = stmt.args[: not MEMORY[stmt.name].reads_only]
        return (*places, stmt.result) if stmt.result is not None else places
    return ()


def inner_statements(stmt: ir.Stmt) -> tuple[ir.Stmt, ...]:
    """The statements directly inside a statement, a loop's header first."""
    if isinstance(stmt, ir.If):
        return stmt.then + stmt.otherwise
    if isinstance(stmt, ir.For):
        header = tuple(part for part in (stmt.init, stmt.step) if part is not None)
        return header + stmt.body
    if isinstance(stmt, ir.While):
        return stmt.body
    return ()


def statements(block: ir.Block) -> Iterator[ir.Stmt]:
    """Every statement of a block, inner ones too, in source order."""
    stack = list(reversed(block))
    while stack:
        stmt = stack.pop()
        yield stmt
        if isinstance(stmt, _WITH_BLOCKS):
            stack.extend(reversed(inner_statements(stmt)))


def subexpressions(expr: ir.Expr) -> Iterator[ir.Expr]:
    """`expr` and all its operands, recursively."""
    stack = [expr]
    while stack:
        node = stack.pop()
        yield node
        stack.extend(reversed(operands(node)))


def all_expressions(block: ir.Block) -> Iterator[ir.Expr]:
    """Every expression of a block, subexpressions too."""
    for stmt in statements(block):
        for expr in expressions(stmt):
            yield from subexpressions(expr)


def builtins_of(module: ir.Module) -> set[str]:
    """The names of the builtins that the functions of a module call."""
    return {part.name for function in module.functions for part in inner_parts(function.body or (), ir.Intrinsic)}


_KEPT = 4096
_calls: dict[int, tuple[ir.Block, tuple[ir.Call, ...]]] = {}
"""By the ids of blocks. The block is kept, so that no other one gets its id."""


def calls_of(block: ir.Block) -> tuple[ir.Call, ...]:
    """The calls in the expressions of a block, those of inner statements too, in the order of the text.

    The checker, several passes and the printer ask for those of a function: each block is searched once.
    """
    known = _calls.get(id(block))
    if known is None:
        if len(_calls) >= _KEPT:
            _calls.clear()
        known = _calls[id(block)] = block, tuple(inner_parts(block, ir.Call))
    return known[1]


def inner_parts(block: ir.Block, kind: type[_Part]) -> list[_Part]:
    """The expressions of one class in a block, those of inner statements too, in the order of the text."""
    parts: list[_Part] = []
    leaves = _LEAVES
    inside = _OPERANDS
    for stmt in statements(block):
        stack = list(expressions(stmt)[::-1])
        while stack:
            node = stack.pop()
            class_ = node.__class__
            if class_ is kind:
                parts.append(node)  # type: ignore[arg-type]  # narrowed by its exact class
            if class_ not in leaves:
                stack += inside[class_](node)[::-1]
    return parts


def callees(function: ir.Function) -> list[str]:
    """The keys of the functions that `function` calls, each once, in the order of first call."""
    return list(dict.fromkeys([call.function for call in calls_of(function.body or ())]))


def root(target: ir.Expr) -> ir.Local | None:
    """The local variable that an assignment to `target` changes; None if it is another variable."""
    variable = written_root(target)
    return variable if isinstance(variable, ir.Local) else None


def written_root(target: ir.Expr) -> ir.Local | ir.Global | None:
    """The variable that an assignment to `target` changes, local or global."""
    while isinstance(target, _PARTS):
        target = target.value
    return target if isinstance(target, _VARIABLES) else None
