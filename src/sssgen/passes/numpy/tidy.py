"""Shortens the code that `predicate` leaves: joins assignments, and inlines or removes the variables it generated."""

from __future__ import annotations

import re
from collections.abc import Set
from typing import NamedTuple

from sssgen.ir.nodes import Assign, Block, Call, Declare, Expr, For, If, Local, Return, Select, Stmt, While
from sssgen.ir.transform import rewrite, rewrite_block
from sssgen.ir.walk import statements, subexpressions
from sssgen.passes.lift_calls import Functions
from sssgen.passes.numpy.variable_uses import is_local, mentions, own_reads, own_writes, reads_of, set_in
from sssgen.passes.scopes import fresh

_NUMBER = re.compile(r"_\d+$")


class _Uses(NamedTuple):
    """The uses of a function's variables."""

    generated: Set[str]
    single: Set[str]
    """Those of `generated` that are assigned once and read at most once."""
    reads: dict[str, int]
    functions: Functions


def tidy(body: Block, generated: Set[str], functions: Functions) -> Block:
    """Joins the assignments of two arms where possible, and removes or inlines variables of `generated` used once."""
    body = _join_arms(body, functions)
    while True:
        reads: dict[str, int] = {}
        written: set[str] = set()
        for stmt in statements(body):
            for name in own_reads(stmt):
                reads[name] = reads.get(name, 0) + 1
            written.update(own_writes(stmt, functions))
        single = {name for name in generated - written if reads.get(name, 0) <= 1}
        new = _inline(body, _Uses(generated, single, reads, functions))
        if new is body:
            return body
        body = new


def _inline(block: Block, uses: _Uses) -> Block:
    """One step: removes or inlines the first declaration for which this is possible."""
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
            previous = block[index - 1]
            if (
                isinstance(previous, Assign)
                and stmt.value.name in uses.generated
                and is_local(previous.target, stmt.value.name)
            ):
                return (*block[: index - 1], Return(previous.value, stmt.span), *block[index + 1 :])
    return block


def _inline_declaration(block: Block, index: int, declare: Declare, uses: _Uses) -> Block:
    name, value = declare.name, declare.value
    if value is None or isinstance(value, Call):
        return block
    if name not in uses.reads:
        return block[:index] + block[index + 1 :]
    free = {part.name for part in subexpressions(value) if isinstance(part, Local)}
    for position in range(index + 1, len(block)):
        user = block[position]
        if not isinstance(user, For | While) and name in own_reads(user):
            return block[:index] + block[index + 1 : position] + (_put(user, name, value),) + block[position + 1 :]
        if free.intersection(set_in(user, uses.functions)):
            break
    return block


def _put(stmt: Stmt, name: str, value: Expr) -> Stmt:
    """The statement with a value in place of a variable, in its own expressions."""

    def change(expr: Expr) -> Expr:
        return value if is_local(expr, name) else expr

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
            if isinstance(choice.condition, Local) and is_local(choice.yes, name) and not mentions(choice.no, name):
                position = _other_arm(result, name, choice.condition.name, functions)
                if position is not None:
                    other = result.pop(position)
                    assert isinstance(other, Assign) and isinstance(other.value, Select)
                    stmt = stmt._replace(value=choice._replace(yes=other.value.yes))
        result.append(stmt)
    return tuple(result)


def _other_arm(done: list[Stmt], name: str, mask: str, functions: Functions) -> int | None:
    """The position of `name = select(mask, …, name)`, if it may move to the end."""
    changed: set[str] = set()
    for position in range(len(done) - 1, -1, -1):
        stmt = done[position]
        if isinstance(stmt, Assign) and not stmt.op and is_local(stmt.target, name) and isinstance(stmt.value, Select):
            choice = stmt.value
            reads = {part.name for part in subexpressions(choice.yes) if isinstance(part, Local)} | {mask}
            joinable = is_local(choice.condition, mask) and is_local(choice.no, name) and not reads & changed
            return position if joinable else None
        changed |= set_in(stmt, functions)
        if name in changed or name in reads_of((stmt,)):
            return None
    return None


def renumber(body: Block, generated: Set[str], taken: Set[str]) -> Block:
    """Numbers the names in `generated` without gaps: `tidy` removed some of them."""
    names: dict[str, str] = {}
    used = set(taken) - generated
    for stmt in statements(body):
        if isinstance(stmt, Declare) and stmt.name in generated and stmt.name not in names:
            names[stmt.name] = fresh(_NUMBER.sub("", stmt.name), used)
            used.add(names[stmt.name])

    def change(expr: Expr) -> Expr:
        return expr._replace(name=names[expr.name]) if isinstance(expr, Local) and expr.name in names else expr

    def restate(stmt: Stmt) -> Block | None:
        if isinstance(stmt, Declare) and stmt.name in names:
            return (stmt._replace(name=names[stmt.name]),)
        return None

    return rewrite_block(body, change, restate)
