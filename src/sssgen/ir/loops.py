"""Bodies of loops, and how they leave them."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL


def break_unless(condition: ir.Expr) -> ir.If:
    """Leaves the loop where a condition does not hold."""
    span = condition.span
    return ir.If(ir.Unary(BOOL, "!", condition, span), (ir.Break(span),), (), span)


def at_every_end(body: ir.Block, added: Sequence[ir.Stmt]) -> ir.Block:
    """A loop's body with statements at its end and before each `continue`."""
    body = _before_continues(body, added)
    is_left = bool(body) and isinstance(body[-1], ir.Break | ir.Continue | ir.Return | ir.Discard)
    return body if is_left else (*body, *added)


def _before_continues(body: ir.Block, added: Sequence[ir.Stmt]) -> ir.Block:
    """A loop's body with statements before each `continue` of the loop; if they end with `break`, instead of it."""
    result: list[ir.Stmt] = []
    for stmt in body:
        if isinstance(stmt, ir.Continue):  # what follows is not executed
            return (*result, *added) if added and isinstance(added[-1], ir.Break) else (*result, *added, stmt)
        if isinstance(stmt, ir.If):
            then, otherwise = _before_continues(stmt.then, added), _before_continues(stmt.otherwise, added)
            stmt = stmt._replace(then=then, otherwise=otherwise)
        result.append(stmt)
    return tuple(result)
