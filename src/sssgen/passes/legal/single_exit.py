"""Functions that return once, at their end, for languages in which `return` cannot be elsewhere.

Why: in a language that is embedded in another one, the host's `return` ends the host's function. A result goes into a
variable. What follows an `if` that returns moves into its other branch; what follows a loop, or an `if` that returns in
some cases only, is executed if a flag is not set. Place: after `legalise`, which makes returns of choices.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite_block
from sssgen.ir.types import BOOL, VOID
from sssgen.ir.walk import all_expressions, inner_statements, statements
from sssgen.passes.scopes import declared, fresh, separate


def single_exits(module: ir.Module) -> ir.Module:
    """The module with functions that return at their ends alone."""
    return module._replace(functions=tuple([_single_exit(function) for function in module.functions]))


def _single_exit(function: ir.Function) -> ir.Function:
    body = function.body or ()
    if not any(isinstance(stmt, ir.Return) for stmt in statements(body[:-1])) and not _leaves(body[-1:]):
        return function
    return _Exits(function).run()


def _leaves(block: ir.Block) -> bool:
    """Whether an inner statement returns."""
    return any(isinstance(inner, ir.Return) for stmt in block for inner in statements(tuple(inner_statements(stmt))))


class _Exits:
    """Rewrites one function that returns early."""

    def __init__(self, function: ir.Function) -> None:
        self.function, names = function, set(declared(function))
        self.result = ir.Local(function.result, fresh("result", names), function.span)
        self.flag = ir.Local(BOOL, fresh("returned", names), function.span)

    def run(self) -> ir.Function:
        function, span = self.function, self.function.span
        body = self.block(function.body or (), True)
        reads_flag = any(isinstance(part, ir.Local) and part.name == self.flag.name for part in all_expressions(body))
        begin: list[ir.Stmt] = []
        end: list[ir.Stmt] = []
        if function.result != VOID:
            begin.append(ir.Declare(self.result.name, function.result, None, span))
            end.append(ir.Return(self.result, span))
        if reads_flag:
            begin.append(ir.Declare(self.flag.name, BOOL, ir.Literal(BOOL, False, span), span))
        else:
            body = self.without_flag(body)
        return separate(function._replace(body=(*begin, *body, *end)))

    def block(self, block: ir.Block, is_last: bool) -> ir.Block:
        """A block outside of loops; `is_last`: nothing is executed after it, so that nothing reads the flag."""
        result: list[ir.Stmt] = []
        for index, stmt in enumerate(block):
            rest = block[index + 1 :]
            if isinstance(stmt, ir.Return):
                return (*result, *self.exit(stmt)[: -1 if is_last else None])
            if isinstance(stmt, ir.If) and _leaves((stmt,)):
                if _always(stmt.then):
                    then, otherwise = self.block(stmt.then, is_last), self.block((*stmt.otherwise, *rest), is_last)
                    return (*result, stmt._replace(then=then, otherwise=otherwise))
                if _always(stmt.otherwise):
                    then, otherwise = self.block((*stmt.then, *rest), is_last), self.block(stmt.otherwise, is_last)
                    return (*result, stmt._replace(then=then, otherwise=otherwise))
                alone = is_last and not rest
                stmt = stmt._replace(then=self.block(stmt.then, alone), otherwise=self.block(stmt.otherwise, alone))
                return (*result, stmt, *self.unless_returned(rest, stmt.span, is_last))
            if isinstance(stmt, ir.For | ir.While) and _leaves((stmt,)):
                stmt = stmt._replace(body=self.in_loop(stmt.body))
                return (*result, stmt, *self.unless_returned(rest, stmt.span, is_last))
            result.append(stmt)
        return tuple(result)

    def unless_returned(self, rest: ir.Block, span: ir.Span, is_last: bool) -> ir.Block:
        block = self.block(rest, is_last)
        return (ir.If(ir.Unary(BOOL, "!", self.flag, span), block, (), span),) if block else ()

    def in_loop(self, block: ir.Block) -> ir.Block:
        """A block of a loop: there `break` leaves what follows."""
        result: list[ir.Stmt] = []
        for stmt in block:
            if isinstance(stmt, ir.Return):
                return (*result, *self.exit(stmt), ir.Break(stmt.span))
            leaves = _leaves((stmt,))
            if isinstance(stmt, ir.If) and leaves:
                stmt = stmt._replace(then=self.in_loop(stmt.then), otherwise=self.in_loop(stmt.otherwise))
            result.append(stmt)
            if isinstance(stmt, ir.For | ir.While) and leaves:
                result[-1] = stmt._replace(body=self.in_loop(stmt.body))
                result.append(ir.If(self.flag, (ir.Break(stmt.span),), (), stmt.span))
        return tuple(result)

    def exit(self, stmt: ir.Return) -> ir.Block:
        mark = ir.Assign(self.flag, "", ir.Literal(BOOL, True, stmt.span), stmt.span)
        return (mark,) if stmt.value is None else (ir.Assign(self.result, "", stmt.value, stmt.span), mark)

    def without_flag(self, block: ir.Block) -> ir.Block:
        """A block without the assignments to the flag, which nothing reads."""

        def restate(stmt: ir.Stmt) -> ir.Block | None:
            return () if isinstance(stmt, ir.Assign) and stmt.target == self.flag else None

        return rewrite_block(block, lambda expr: expr, restate)


def _always(block: ir.Block) -> bool:
    """Whether a block returns in any case."""
    return any(
        isinstance(stmt, ir.Return) or (isinstance(stmt, ir.If) and _always(stmt.then) and _always(stmt.otherwise))
        for stmt in block
    )
