"""The effects of statements, and whether an expression depends on them: for keeping the order of evaluation."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sssgen.ir import nodes as ir
from sssgen.ir.walk import all_expressions, statements, subexpressions, written_places, written_root

OutArguments = Callable[[ir.Call], Iterable[ir.Expr]]
"""Gives the arguments that a call writes to."""


def root_name(target: ir.Expr) -> str:
    """The name of the variable that an assignment to `target` changes."""
    while isinstance(target, ir.Swizzle | ir.Index | ir.Member):
        target = target.value
    return target.name if isinstance(target, ir.Local | ir.Global) else "value"


def writes_of(stmts: Iterable[ir.Stmt], out_arguments: OutArguments) -> tuple[set[str], bool]:
    """The variables that statements write, and whether they call functions, which may write more."""
    block = tuple(stmts)
    written = {root_name(place) for stmt in statements(block) for place in written_places(stmt)}
    calls = False
    for expr in all_expressions(block):
        if isinstance(expr, ir.Call):
            calls = True
            written |= {place.name for place in map(written_root, out_arguments(expr)) if place is not None}
    return written, calls


def depends(expr: ir.Expr, written: set[str], calls: bool) -> bool:
    """Whether an expression's value, or what its own calls do, depends on statements with these effects."""
    for part in subexpressions(expr):
        if isinstance(part, ir.Call):
            return True
        if isinstance(part, ir.Local | ir.Global) and (part.name in written or (calls and isinstance(part, ir.Global))):
            return not hasattr(part.type, "dim")  # samplers never change
    return False
