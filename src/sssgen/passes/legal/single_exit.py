"""Functions that return once, at their end, for languages in which `return` cannot be elsewhere.

Why: in a language that is embedded in another one, the host's `return` ends the host's function. A result goes into a
variable. What follows an `if` that returns moves into its other branch; what follows a loop, or an `if` that returns in
some cases only, is executed if a flag is not set. Place: after `legalise`, which makes returns of choices.
"""

from __future__ import annotations

from sssgen.ir.nodes import (
    Assign,
    Block,
    Break,
    Declare,
    For,
    Function,
    If,
    Literal,
    Local,
    Module,
    Return,
    Span,
    Stmt,
    Unary,
    While,
)
from sssgen.ir.types import BOOL, VOID
from sssgen.ir.walk import all_expressions, inner_statements, statements
from sssgen.passes.scopes import declared, fresh, separate


def single_exits(module: Module) -> Module:
    """The module with functions that return at their ends alone."""
    return module._replace(functions=tuple([_single_exit(function) for function in module.functions]))


def _single_exit(function: Function) -> Function:
    body = function.body or ()
    if not any(isinstance(stmt, Return) for stmt in statements(body[:-1])) and not _leaves(body[-1:]):
        return function
    return _Exits(function).run()


def _leaves(block: Block) -> bool:
    """Whether an inner statement returns."""
    return any(isinstance(inner, Return) for stmt in block for inner in statements(tuple(inner_statements(stmt))))


class _Exits:
    """Rewrites one function that returns early."""

    def __init__(self, function: Function) -> None:
        self.function, names = function, set(declared(function))
        self.result = Local(function.result, fresh("result", names), function.span)
        self.flag = Local(BOOL, fresh("returned", names), function.span)

    def run(self) -> Function:
        function, span = self.function, self.function.span
        body = self.block(function.body or (), True)
        reads_flag = any(isinstance(part, Local) and part.name == self.flag.name for part in all_expressions(body))
        begin: list[Stmt] = []
        end: list[Stmt] = []
        if function.result != VOID:
            begin.append(Declare(self.result.name, function.result, None, span))
            end.append(Return(self.result, span))
        if reads_flag:
            begin.append(Declare(self.flag.name, BOOL, Literal(BOOL, False, span), span))
        else:
            body = self.without_flag(body)
        return separate(function._replace(body=(*begin, *body, *end)))

    def block(self, block: Block, is_last: bool) -> Block:
        """A block outside of loops; `is_last`: nothing is executed after it, so that nothing reads the flag."""
        result: list[Stmt] = []
        for index, stmt in enumerate(block):
            rest = block[index + 1 :]
            if isinstance(stmt, Return):
                return (*result, *self.exit(stmt)[: -1 if is_last else None])
            if isinstance(stmt, If) and _leaves((stmt,)):
                if _always(stmt.then):
                    then, otherwise = self.block(stmt.then, is_last), self.block((*stmt.otherwise, *rest), is_last)
                    return (*result, stmt._replace(then=then, otherwise=otherwise))
                if _always(stmt.otherwise):
                    then, otherwise = self.block((*stmt.then, *rest), is_last), self.block(stmt.otherwise, is_last)
                    return (*result, stmt._replace(then=then, otherwise=otherwise))
                alone = is_last and not rest
                stmt = stmt._replace(then=self.block(stmt.then, alone), otherwise=self.block(stmt.otherwise, alone))
                return (*result, stmt, *self.unless_returned(rest, stmt.span, is_last))
            if isinstance(stmt, For | While) and _leaves((stmt,)):
                stmt = stmt._replace(body=self.in_loop(stmt.body))
                return (*result, stmt, *self.unless_returned(rest, stmt.span, is_last))
            result.append(stmt)
        return tuple(result)

    def unless_returned(self, rest: Block, span: Span, is_last: bool) -> Block:
        block = self.block(rest, is_last)
        return (If(Unary(BOOL, "!", self.flag, span), block, (), span),) if block else ()

    def in_loop(self, block: Block) -> Block:
        """A block of a loop: there `break` leaves what follows."""
        result: list[Stmt] = []
        for stmt in block:
            if isinstance(stmt, Return):
                return (*result, *self.exit(stmt), Break(stmt.span))
            leaves = _leaves((stmt,))
            if isinstance(stmt, If) and leaves:
                stmt = stmt._replace(then=self.in_loop(stmt.then), otherwise=self.in_loop(stmt.otherwise))
            result.append(stmt)
            if isinstance(stmt, For | While) and leaves:
                result[-1] = stmt._replace(body=self.in_loop(stmt.body))
                result.append(If(self.flag, (Break(stmt.span),), (), stmt.span))
        return tuple(result)

    def exit(self, stmt: Return) -> Block:
        mark = Assign(self.flag, "", Literal(BOOL, True, stmt.span), stmt.span)
        return (mark,) if stmt.value is None else (Assign(self.result, "", stmt.value, stmt.span), mark)

    def without_flag(self, block: Block) -> Block:
        """A block without the assignments to the flag, which nothing reads."""
        result: list[Stmt] = []
        for stmt in block:
            if isinstance(stmt, If):
                then, otherwise = self.without_flag(stmt.then), self.without_flag(stmt.otherwise)
                result.append(stmt._replace(then=then, otherwise=otherwise))
            elif isinstance(stmt, For | While):
                result.append(stmt._replace(body=self.without_flag(stmt.body)))
            elif not (isinstance(stmt, Assign) and stmt.target == self.flag):
                result.append(stmt)
        return tuple(result)


def _always(block: Block) -> bool:
    """Whether a block returns in any case."""
    return any(
        isinstance(stmt, Return) or (isinstance(stmt, If) and _always(stmt.then) and _always(stmt.otherwise))
        for stmt in block
    )
