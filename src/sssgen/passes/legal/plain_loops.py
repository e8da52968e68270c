"""Loops that count or test a plain value, for languages that evaluate a loop's head only once.

Any other `for` becomes a `while`; a condition that calls, chooses or reads a texture moves into the body, as
`if (!c) break`. Place: after `legalise`, which makes conditions of other expressions.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.loops import at_every_end
from sssgen.ir.nodes import (
    Assign,
    Binary,
    Block,
    Break,
    Call,
    Declare,
    Expr,
    For,
    If,
    Intrinsic,
    Literal,
    Local,
    Module,
    Select,
    Stmt,
    Unary,
    While,
)
from sssgen.ir.transform import Transformer
from sssgen.ir.types import BOOL, Scalar
from sssgen.ir.walk import subexpressions
from sssgen.passes.scopes import separate


def plain_loops(module: Module) -> Module:
    """The module with plain loops alone."""
    functions = [(function, _Loops().function(function)) for function in module.functions]
    return module._replace(functions=tuple([new if new is old else separate(new) for old, new in functions]))


class _Loops(Transformer):
    def for_loop(self, stmt: For) -> Stmt | None:
        body = self.inner(stmt.body)
        if counts(stmt):
            return stmt._replace(body=body)
        if stmt.init is not None:
            self.out.append(stmt.init)
        steps = [stmt.step] if stmt.step is not None else []
        condition = stmt.condition or Literal(BOOL, True, stmt.span)
        return self.loop(While(condition, at_every_end(body, steps), stmt.span))

    def while_loop(self, stmt: While) -> Stmt | None:
        return self.loop(stmt._replace(body=self.inner(stmt.body)))

    def loop(self, loop: While) -> While:
        if _is_plain(loop.condition):
            return loop
        condition = loop.condition
        stop = If(Unary(BOOL, "!", condition, condition.span), (Break(loop.span),), (), condition.span)
        body: Block = (stop, *loop.body)
        return While(Literal(BOOL, True, condition.span), body, loop.span)


def counts(loop: For) -> bool:
    """Whether a loop adds a number to a variable of its own after each round, while a comparison with it holds."""
    init, condition, step = loop.init, loop.condition, loop.step
    if not isinstance(init, Declare) or init.value is None or not isinstance(init.type, Scalar):
        return False
    if not isinstance(condition, Binary) or not isinstance(step, Assign):
        return False
    left, target = condition.left, step.target
    return (
        condition.op in ("<", "<=", ">", ">=")
        and isinstance(left, Local)
        and left.name == init.name
        and isinstance(target, Local)
        and target.name == init.name
        and step.op in ("+", "-")
        and isinstance(step.value, Literal)
        and _is_plain(condition.right)
    )


def _is_plain(expr: Expr) -> bool:
    """Whether it is computed wherever its text stands."""
    return not any(
        isinstance(part, Call | Select) or (isinstance(part, Intrinsic) and BUILTINS[part.name].kind == "fetch")
        for part in subexpressions(expr)
    )
