"""What `predicate` is made of: masks, and the tidying of the code that they leave behind."""

from __future__ import annotations

import re
from collections.abc import Iterable, Set
from typing import NamedTuple

from sssgen.ir.nodes import (
    Assign,
    Binary,
    Block,
    Call,
    Construct,
    Declare,
    Expr,
    For,
    Function,
    If,
    Literal,
    Local,
    Return,
    Select,
    Span,
    Stmt,
    Unary,
    While,
)
from sssgen.ir.transform import rewrite, rewrite_block
from sssgen.ir.types import BOOL, Array, Matrix, Scalar, Struct, Type, Vector
from sssgen.ir.walk import expressions, root, statements, subexpressions
from sssgen.passes.lift_calls import Functions, out_arguments
from sssgen.passes.scopes import fresh

_NUMBER = re.compile(r"_\d+$")


class Mask(NamedTuple):
    """The lanes where a bool variable is true, or where it is false."""

    name: str
    inverted: bool = False

    def expr(self, span: Span) -> Expr:
        local = Local(BOOL, self.name, span)
        return Unary(BOOL, "!", local, span) if self.inverted else local

    def also(self, condition: Expr) -> Expr:
        """The lanes of the mask in which a condition holds."""
        return Binary(BOOL, "&&", self.expr(condition.span), condition, condition.span)

    def choose(self, inside: Expr, outside: Expr, span: Span) -> Expr:
        """One value in the lanes of the mask, another outside."""
        if self.inverted:
            inside, outside = outside, inside
        return Select(inside.type, Local(BOOL, self.name, span), inside, outside, span)


def negated(condition: Expr) -> tuple[Expr, bool]:
    """A condition without its outer `!`, and whether these leave it negated."""
    inverted = False
    while isinstance(condition, Unary):
        condition, inverted = condition.operand, not inverted
    return condition, inverted


def zero(type_: Type, span: Span) -> Expr:
    """A value for lanes of which it does not matter."""
    if isinstance(type_, Scalar):
        start: float | int | bool = {"float": 0.0, "bool": False}.get(type_.kind, 0)
        return Literal(type_, start, span)
    if isinstance(type_, Vector | Matrix):
        return Construct(type_, (zero(Scalar(type_.kind), span),), span)
    if isinstance(type_, Array):
        return Construct(type_, (zero(type_.element, span),) * type_.length, span)
    assert isinstance(type_, Struct)
    return Construct(type_, tuple([zero(field.type, span) for field in type_.fields]), span)


# Tidying


class _Uses(NamedTuple):
    """What tidying needs to know of a function's variables."""

    made: Set[str]
    single: Set[str]
    """Of those made the ones that are set once and read at most once."""
    reads: dict[str, int]
    functions: Functions


def tidy(body: Block, made: Set[str], functions: Functions) -> Block:
    """Joins the two arms' assignments where it can, and drops or inlines what was made and is used once."""
    body = _join_arms(body, functions)
    while True:
        reads: dict[str, int] = {}
        written: set[str] = set()
        for stmt in statements(body):
            for name in _own_reads(stmt):
                reads[name] = reads.get(name, 0) + 1
            written.update(_own_writes(stmt, functions))
        single = {name for name in made - written if reads.get(name, 0) <= 1}
        new = _inline(body, _Uses(made, single, reads, functions))
        if new is body:
            return body
        body = new


def _inline(block: Block, uses: _Uses) -> Block:
    """One step: drops or moves the first declaration that can be."""
    for index, stmt in enumerate(block):
        if isinstance(stmt, Declare) and stmt.name in uses.single:
            new = _inline_declaration(block, index, stmt, uses)
            if new is not block:
                return new
        elif isinstance(stmt, If):
            then, otherwise = _inline(stmt.then, uses), _inline(stmt.otherwise, uses)
            if then is not stmt.then or otherwise is not stmt.otherwise:
                return (*block[:index], stmt._replace(then=then, otherwise=otherwise), *block[index + 1 :])
        elif isinstance(stmt, For | While):
            body = _inline(stmt.body, uses)
            if body is not stmt.body:
                return (*block[:index], stmt._replace(body=body), *block[index + 1 :])
        elif isinstance(stmt, Return) and isinstance(stmt.value, Local) and index:
            before = block[index - 1]
            if isinstance(before, Assign) and stmt.value.name in uses.made and _is(before.target, stmt.value.name):
                return (*block[: index - 1], Return(before.value, stmt.span), *block[index + 1 :])
    return block


def _inline_declaration(block: Block, index: int, declare: Declare, uses: _Uses) -> Block:
    name, value = declare.name, declare.value
    if value is None or isinstance(value, Call):
        return block
    if name not in uses.reads:
        return block[:index] + block[index + 1 :]
    free = {part.name for part in subexpressions(value) if isinstance(part, Local)}
    for place in range(index + 1, len(block)):
        user = block[place]
        if not isinstance(user, For | While) and name in _own_reads(user):
            return block[:index] + block[index + 1 : place] + (_put(user, name, value),) + block[place + 1 :]
        if free.intersection(_writes((user,), uses.functions)):
            break
    return block


def _put(stmt: Stmt, name: str, value: Expr) -> Stmt:
    """The statement with a value in place of a variable, in its own expressions."""

    def change(expr: Expr) -> Expr:
        return value if _is(expr, name) else expr

    if isinstance(stmt, Declare | Return) and stmt.value is not None:
        return stmt._replace(value=rewrite(stmt.value, change))
    if isinstance(stmt, Assign):
        return stmt._replace(target=rewrite(stmt.target, change), value=rewrite(stmt.value, change))
    assert isinstance(stmt, If)
    return stmt._replace(condition=rewrite(stmt.condition, change))


def _join_arms(block: Block, functions: Functions) -> Block:
    """`x = select(m, a, x); …; x = select(m, x, b);` as `…; x = select(m, a, b);`."""
    result: list[Stmt] = []
    for stmt in block:
        if isinstance(stmt, If):
            then, otherwise = _join_arms(stmt.then, functions), _join_arms(stmt.otherwise, functions)
            stmt = stmt._replace(then=then, otherwise=otherwise)
        elif isinstance(stmt, For | While):
            stmt = stmt._replace(body=_join_arms(stmt.body, functions))
        elif isinstance(stmt, Assign) and isinstance(stmt.target, Local) and isinstance(stmt.value, Select):
            name, choice = stmt.target.name, stmt.value
            if isinstance(choice.condition, Local) and _is(choice.yes, name) and not _mentions(choice.no, name):
                place = _other_arm(result, name, choice.condition.name, functions)
                if place is not None:
                    other = result.pop(place)
                    assert isinstance(other, Assign) and isinstance(other.value, Select)
                    stmt = stmt._replace(value=choice._replace(yes=other.value.yes))
        result.append(stmt)
    return tuple(result)


def _other_arm(done: list[Stmt], name: str, mask: str, functions: Functions) -> int | None:
    """Where `name = select(mask, …, name)` stands, if it could as well be done at the end."""
    changed: set[str] = set()
    for place in range(len(done) - 1, -1, -1):
        stmt = done[place]
        if isinstance(stmt, Assign) and not stmt.op and _is(stmt.target, name) and isinstance(stmt.value, Select):
            choice = stmt.value
            free = {part.name for part in subexpressions(choice.yes) if isinstance(part, Local)} | {mask}
            fits = _is(choice.condition, mask) and _is(choice.no, name) and not free & changed
            return place if fits else None
        changed.update(_writes((stmt,), functions))
        if name in changed or name in _reads((stmt,)):
            return None
    return None


def renumber(body: Block, made: Set[str], taken: Set[str]) -> Block:
    """Closes the gaps that tidying left in the numbers of the names that were made."""
    names: dict[str, str] = {}
    used = set(taken) - made
    for stmt in statements(body):
        if isinstance(stmt, Declare) and stmt.name in made and stmt.name not in names:
            names[stmt.name] = fresh(_NUMBER.sub("", stmt.name), used)
            used.add(names[stmt.name])

    def change(expr: Expr) -> Expr:
        return expr._replace(name=names[expr.name]) if isinstance(expr, Local) and expr.name in names else expr

    def restate(stmt: Stmt) -> Block | None:
        if isinstance(stmt, Declare) and stmt.name in names:
            return (stmt._replace(name=names[stmt.name]),)
        return None

    return rewrite_block(body, change, restate)


# Variables that lanes may not have set


def settle(body: Block, function: Function, functions: Functions) -> Block:
    """Gives a start to variables, out parameters too, that may be read before they are set in all lanes.

    What is declared a second time, as two arms may that now stand in one block, is assigned instead.
    """
    unset = [param for param in function.params if param.direction == "out"]
    starts = tuple(
        Assign(Local(param.type, param.name, param.span), "", zero(param.type, param.span), param.span)
        for param in unset
        if not _set_first((*body, Return(None, param.span)), param.name, functions, out=True)
    )
    visible = {param.name: param.type for param in function.params}
    return starts + _settle(body, visible, functions)


def _settle(block: Block, visible: dict[str, Type], functions: Functions) -> Block:
    result: list[Stmt] = []
    for index, stmt in enumerate(block):
        if isinstance(stmt, Declare):
            again = visible.get(stmt.name) == stmt.type
            visible[stmt.name] = stmt.type
            if stmt.value is None and not _set_first(block[index + 1 :], stmt.name, functions):
                stmt = stmt._replace(value=zero(stmt.type, stmt.span))
            if again:
                if stmt.value is not None:
                    result.append(Assign(Local(stmt.type, stmt.name, stmt.span), "", stmt.value, stmt.span))
                continue
        elif isinstance(stmt, If):
            then = _settle(stmt.then, dict(visible), functions)
            stmt = stmt._replace(then=then, otherwise=_settle(stmt.otherwise, dict(visible), functions))
        elif isinstance(stmt, For | While):
            stmt = stmt._replace(body=_settle(stmt.body, dict(visible), functions))
        result.append(stmt)
    return tuple(result)


def _set_first(block: Block, name: str, functions: Functions, out: bool = False) -> bool:
    """Whether a variable is set whole, or not used at all, before anything reads it; returns read an `out` one."""
    for stmt in block:
        if isinstance(stmt, Declare) and stmt.name == name and (stmt.value is None or not _mentions(stmt.value, name)):
            return True
        reads = name in _reads((stmt,), functions)
        reads = reads or (out and any(isinstance(inner, Return) for inner in statements((stmt,))))
        if not reads and isinstance(stmt, Assign) and _is(stmt.target, name):
            return True
        if not reads and any(name in out_arguments(expr, functions) for expr in expressions(stmt)):
            return True
        if reads or name in _writes((stmt,), functions):
            return False
    return True


# What statements read and write


def _is(expr: Expr, name: str) -> bool:
    return isinstance(expr, Local) and expr.name == name


def _mentions(expr: Expr, name: str) -> bool:
    return any(_is(part, name) for part in subexpressions(expr))


def _own_reads(stmt: Stmt, functions: Functions | None = None) -> Iterable[str]:
    """The variables that a statement's own expressions read, each as often as it is read.

    With `functions`, what a call only writes does not count as read.
    """
    found = []
    for expr in expressions(stmt):
        parts = list(subexpressions(expr))
        if isinstance(stmt, Assign) and expr is stmt.target and not stmt.op and isinstance(expr, Local):
            continue
        if functions is not None and isinstance(expr, Call):
            params = functions[expr.function].params
            read = [arg for arg, param in zip(expr.args, params, strict=True) if param.direction != "out"]
            parts = [part for arg in read for part in subexpressions(arg)]
        found += [part.name for part in parts if isinstance(part, Local)]
    return found


def _reads(block: Block, functions: Functions | None = None) -> list[str]:
    """The same for statements and all inside them."""
    return [name for stmt in statements(block) for name in _own_reads(stmt, functions)]


def _writes(block: Block, functions: Functions) -> set[str]:
    """The variables that statements, and all inside them, change, not by declaring them."""
    return {name for stmt in statements(block) for name in _own_writes(stmt, functions)}


def _own_writes(stmt: Stmt, functions: Functions) -> list[str]:
    """The same for the statement itself."""
    names = [name for expr in expressions(stmt) for name in out_arguments(expr, functions)]
    target = root(stmt.target) if isinstance(stmt, Assign) else None
    return names if target is None else [*names, target.name]
