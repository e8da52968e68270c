"""Statements that main() executes before each of its ends: they copy what stages pass on."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.rules import returns
from sssgen.ir.transform import rewrite_function


def copies_last(main: ir.Function, copies: ir.Block) -> ir.Function:
    """The entry with these statements before each return, and at its end."""

    def restate(stmt: ir.Stmt) -> ir.Block | None:
        return (*copies, stmt) if isinstance(stmt, ir.Return) else None

    changed = rewrite_function(main, lambda node: node, restate)
    body = changed.body or ()
    return changed._replace(body=body if returns(body) else (*body, *copies))
