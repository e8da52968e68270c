"""Ends that a target needs: of discarded invocations, and of loops without an exit.

Why: a discarded invocation goes on as a helper in WGSL, HLSL and Metal, so that `for (;;) { … discard; }` would never
end, and a function has to return behind a discard. Tint refuses a loop that nothing leaves. Used by `legalise`.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import zero
from sssgen.ir.rules import returns
from sssgen.ir.types import BOOL, VOID, Type
from sssgen.passes.capabilities import Capabilities


def with_ends(block: ir.Block, result: Type, in_loop: bool, can: Capabilities) -> ir.Block:
    """A block of a function with this result, with the ends that the target needs; the same block if it needs none."""
    if not any(_lacks_end(stmt, in_loop, can) for stmt in block):
        return block
    ended: list[ir.Stmt] = []
    for stmt in block:
        ended.append(stmt)
        if _lacks_end(stmt, in_loop, can):
            if isinstance(stmt, ir.For):
                ended[-1] = stmt._replace(condition=ir.Literal(BOOL, True, stmt.span))
            ended.append(_return(result, stmt.span))
    return tuple(ended)


def with_return(function: ir.Function) -> ir.Function:
    """A function that returns also where its last statement is a discard."""
    body = function.body or ()
    if function.result == VOID or not returns(body) or returns(body, discard_ends=False):
        return function
    return function._replace(body=(*body, _return(function.result, body[-1].span)))


def _return(result: Type, span: ir.Span) -> ir.Return:
    return ir.Return(None if result == VOID else zero(result, span), span)


def _lacks_end(stmt: ir.Stmt, in_loop: bool, can: Capabilities) -> bool:
    if isinstance(stmt, ir.Discard):
        return in_loop and not can.discard_ends
    return (
        isinstance(stmt, ir.For)
        and stmt.condition is None
        and not can.endless_loops
        and not _is_left(stmt.body, can, False)
    )


def _is_left(block: ir.Block, can: Capabilities, inner: bool) -> bool:
    """Whether a statement leaves the loop around a block; `inner`: there is another loop between them."""
    for stmt in block:
        if isinstance(stmt, ir.Return) or (isinstance(stmt, ir.Discard) and not can.discard_ends):
            return True
        if isinstance(stmt, ir.Break) and not inner:
            return True
        if isinstance(stmt, ir.If):
            if _is_left(stmt.then, can, inner) or _is_left(stmt.otherwise, can, inner):
                return True
        elif isinstance(stmt, ir.For | ir.While) and _is_left(stmt.body, can, True):
            return True
    return False
