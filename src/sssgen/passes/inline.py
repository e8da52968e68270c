"""Puts the body of small functions in the place of their calls.

Why: a polyfill of one expression reads better in place, and some targets cannot call every function.
Place: right after whatever brings such functions, and before `prune`, which drops those that nothing calls
any more.

Only functions that are one `return`, and write no module variable, are inlined. An argument takes its
parameter's place where the parameter is used at most once, or where the argument costs nothing (a literal, a
name, or components of one).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sssgen.ir.nodes import (
    Assign,
    Assume,
    Binary,
    Block,
    Call,
    Construct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    Global,
    If,
    Intrinsic,
    Literal,
    Local,
    Member,
    Module,
    Return,
    Select,
    Stmt,
    Swizzle,
    While,
)
from sssgen.ir.transform import rewrite
from sssgen.ir.walk import expressions, operands, subexpressions, with_operands
from sssgen.passes.divergence import Summary, implicit, summaries
from sssgen.passes.scopes import declared, fresh, substitute


class _Body(NamedTuple):
    """A function that can be inlined."""

    value: Expr
    params: tuple[str, ...]
    uses: dict[str, int]
    """How often each parameter is used."""
    sometimes: set[str]
    """The parameters used where it depends on a condition whether they are."""


def inline(module: Module, should_inline: Callable[[Function], bool], insist: bool = False) -> Module:
    """The module with the functions of one `return` that `should_inline` chooses put in place of their calls.

    With `insist`, arguments that cannot take their parameter's place are held in a variable before the
    statement; otherwise such a call stays. A call in a loop's own condition or step stays in any case where
    that is needed. The inlined functions themselves remain.
    """
    chosen = {
        function.key: function
        for function in module.functions
        if _expression_of(function) is not None and should_inline(function)
    }
    known = summaries(module) if chosen else {}
    chosen = {key: function for key, function in chosen.items() if not known[key].writes}
    if not chosen:
        return module
    inliner = _Inliner(chosen, known, insist)
    functions = tuple([inliner.function(function) for function in module.functions])
    return module._replace(functions=functions)


def _expression_of(function: Function) -> Expr | None:
    """The value of a function that is one `return` and has only `in` parameters."""
    body = function.body
    if body is None or len(body) != 1 or any(param.direction != "in" for param in function.params):
        return None
    return body[0].value if isinstance(body[0], Return) else None


def _is_cheap(arg: Expr) -> bool:
    """Whether an argument may be written several times: a literal, a name, or components of one."""
    while isinstance(arg, Swizzle | Member):
        arg = arg.value
    if isinstance(arg, Construct):
        return len(arg.args) == 1 and isinstance(arg.args[0], Literal)
    return isinstance(arg, Literal | Local | Global)


def _count(expr: Expr, body: _Body, certain: bool = True) -> None:
    """Counts the uses of the parameters in an expression, into `body`."""
    if isinstance(expr, Local):
        body.uses[expr.name] += 1
        if not certain:
            body.sometimes.add(expr.name)
        return
    for index, operand in enumerate(operands(expr)):
        guarded = isinstance(expr, Select) or (isinstance(expr, Binary) and expr.op in ("&&", "||"))
        _count(operand, body, certain and not (guarded and index > 0))


class _Inliner:
    def __init__(self, chosen: dict[str, Function], known: dict[str, Summary], insist: bool) -> None:
        self.chosen, self.known, self.insist = chosen, known, insist
        self.bodies: dict[str, _Body] = {}
        self.held: list[Stmt] | None = None
        """Where variables can go that hold arguments of the statement at hand."""
        self.taken: set[str] = set()

    def body(self, key: str) -> _Body:
        """A function's value with everything inlined in it."""
        found = self.bodies.get(key)
        if found is None:
            function = self.chosen[key]
            value = _expression_of(function)
            assert value is not None
            held, self.held = self.held, None
            names = tuple([param.name for param in function.params])
            found = self.bodies[key] = _Body(self.expression(value), names, dict.fromkeys(names, 0), set())
            self.held = held
            _count(found.value, found)
        return found

    # Statements

    def function(self, function: Function) -> Function:
        if function.body is None:
            return function
        self.taken = set(declared(function)) if self.insist else set()
        body = self.block(function.body)
        return function if body is function.body else function._replace(body=body)

    def block(self, block: Block) -> Block:
        out: list[Stmt] = []
        for stmt in block:
            held: list[Stmt] = []
            self.held = held if self.insist and not any(map(self.acts, expressions(stmt))) else None
            new = self.statement(stmt)
            out += [*held, new]
        same = len(out) == len(block) and all(one is other for one, other in zip(out, block, strict=True))
        return block if same else tuple(out)

    def statement(self, stmt: Stmt) -> Stmt:
        if isinstance(stmt, Declare):
            value = self.expression(stmt.value) if stmt.value is not None else None
            return stmt if value is stmt.value else Declare(stmt.name, stmt.type, value, stmt.span)
        if isinstance(stmt, Assign):
            target, value = self.expression(stmt.target), self.expression(stmt.value)
            same = target is stmt.target and value is stmt.value
            return stmt if same else Assign(target, stmt.op, value, stmt.span)
        if isinstance(stmt, If):
            condition = self.expression(stmt.condition)
            then, otherwise = self.block(stmt.then), self.block(stmt.otherwise)
            same = condition is stmt.condition and then is stmt.then and otherwise is stmt.otherwise
            return stmt if same else If(condition, then, otherwise, stmt.span)
        if isinstance(stmt, For):
            init = self.statement(stmt.init) if stmt.init is not None else None
            self.held = None
            test = self.expression(stmt.condition) if stmt.condition is not None else None
            step = self.statement(stmt.step) if stmt.step is not None else None
            new = For(init, test, step, self.block(stmt.body), stmt.span)
            return stmt if all(one is other for one, other in zip(new, stmt, strict=True)) else new
        if isinstance(stmt, While):
            self.held = None
            condition, body = self.expression(stmt.condition), self.block(stmt.body)
            same = condition is stmt.condition and body is stmt.body
            return stmt if same else While(condition, body, stmt.span)
        if isinstance(stmt, Return) and stmt.value is not None:
            value = self.expression(stmt.value)
            return stmt if value is stmt.value else Return(value, stmt.span)
        if isinstance(stmt, Assume):
            condition = self.expression(stmt.condition)
            return stmt if condition is stmt.condition else Assume(condition, stmt.span)
        if isinstance(stmt, Evaluate):
            # the call itself is made for its effects; one that is only a value has none
            args = tuple([self.expression(arg) for arg in operands(stmt.call)])
            same = all(one is other for one, other in zip(args, operands(stmt.call), strict=True))
            return stmt if same else Evaluate(with_operands(stmt.call, args), stmt.span)
        return stmt

    # Expressions

    def expression(self, expr: Expr) -> Expr:
        return rewrite(expr, self.change)

    def change(self, node: Expr) -> Expr:
        if type(node) is not Call or node.function not in self.chosen:
            return node
        body = self.body(node.function)
        values: dict[str, Expr] = {}
        holding: list[tuple[str, Expr]] = []
        for name, arg in zip(body.params, node.args, strict=True):
            if self.acts(arg):
                return node
            if _is_cheap(arg) or self.fits(arg, name, body):
                values[name] = arg
            elif self.held is None:
                return node
            else:
                holding.append((name, arg))
        for name, arg in holding:
            assert self.held is not None
            variable = fresh(name, self.taken)
            self.taken.add(variable)
            self.held.append(Declare(variable, arg.type, arg, arg.span))
            values[name] = Local(arg.type, variable, arg.span)
        value = substitute(body.value, values)
        # a call that had to stay in the function may be inlined here, where variables can hold its arguments
        return self.expression(value) if self.held is not None and self.calls(body.value) else value

    def fits(self, arg: Expr, name: str, body: _Body) -> bool:
        """Whether an argument is evaluated as before if it stands in its parameter's place."""
        if body.uses[name] != 1:
            return body.uses[name] == 0
        return name not in body.sometimes or not any(
            isinstance(part, Intrinsic) and part.name in implicit() for part in subexpressions(arg)
        )

    def calls(self, expr: Expr) -> bool:
        return any(type(part) is Call and part.function in self.chosen for part in subexpressions(expr))

    def acts(self, expr: Expr) -> bool:
        """Whether an expression does more than give its value."""
        return any(
            type(part) is Call and (part.function not in self.known or not self.known[part.function].pure)
            for part in subexpressions(expr)
        )
