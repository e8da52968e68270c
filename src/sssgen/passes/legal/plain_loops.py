"""Loops that count or test a plain value, for languages that evaluate a loop's head only once.

Any other `for` becomes a `while`; a condition that calls, chooses or reads a texture moves into the body, as
`if (!c) break`. Place: after `legalise`, which makes conditions of other expressions.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.loops import at_every_end, break_unless
from sssgen.ir.transform import Transformer
from sssgen.ir.types import BOOL, Scalar
from sssgen.ir.walk import subexpressions
from sssgen.passes.scopes import separate


def plain_loops(module: ir.Module) -> ir.Module:
    """The module with plain loops alone."""
    functions = [(function, _Loops().function(function)) for function in module.functions]
    return module._replace(functions=tuple([new if new is old else separate(new) for old, new in functions]))


class _Loops(Transformer):
    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        body = self.inner(stmt.body)
        if counts(stmt):
            return stmt._replace(body=body)
        if stmt.init is not None:
            self.out.append(stmt.init)
        steps = [stmt.step] if stmt.step is not None else []
        condition = stmt.condition or ir.Literal(BOOL, True, stmt.span)
        return self.loop(ir.While(condition, at_every_end(body, steps), stmt.span))

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        return self.loop(stmt._replace(body=self.inner(stmt.body)))

    def loop(self, loop: ir.While) -> ir.While:
        if _is_plain(loop.condition):
            return loop
        body = (break_unless(loop.condition), *loop.body)
        return ir.While(ir.Literal(BOOL, True, loop.condition.span), body, loop.span)


def counts(loop: ir.For) -> bool:
    """Whether a loop adds a number to a variable of its own after each round, while a comparison with it holds."""
    init, condition, step = loop.init, loop.condition, loop.step
    if not isinstance(init, ir.Declare) or init.value is None or not isinstance(init.type, Scalar):
        return False
    if not isinstance(condition, ir.Binary) or not isinstance(step, ir.Assign):
        return False
    left, target = condition.left, step.target
    return (
        condition.op in ("<", "<=", ">", ">=")
        and isinstance(left, ir.Local)
        and left.name == init.name
        and isinstance(target, ir.Local)
        and target.name == init.name
        and step.op in ("+", "-")
        and isinstance(step.value, ir.Literal)
        and _is_plain(condition.right)
    )


def _is_plain(expr: ir.Expr) -> bool:
    """Whether it is computed wherever its text stands."""
    return not any(
        isinstance(part, ir.Call | ir.Select)
        or (isinstance(part, ir.Intrinsic) and BUILTINS[part.name].kind == "fetch")
        for part in subexpressions(expr)
    )
