"""Gives values to the variables that some lanes may read before they are set. Used by `predicate`."""

from __future__ import annotations

from sssgen.ir.constant_expressions import zero
from sssgen.ir.nodes import Assign, Block, Declare, For, Function, If, Local, Return, Stmt, While
from sssgen.ir.types import Type
from sssgen.ir.walk import expressions, statements
from sssgen.passes.lift_calls import Functions, out_arguments
from sssgen.passes.numpy.variable_uses import is_local, mentions, reads_of, writes_of


def settle(body: Block, function: Function, functions: Functions) -> Block:
    """Gives an initial value to variables and out parameters that may be read before they are set in all lanes.

    A second declaration, of two arms that are now in one block, becomes an assignment.
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
    """Whether a variable is set as a whole before it is read, or not used; a return reads it if it is `out`."""
    for stmt in block:
        if isinstance(stmt, Declare) and stmt.name == name and (stmt.value is None or not mentions(stmt.value, name)):
            return True
        reads = name in reads_of((stmt,), functions)
        reads = reads or (out and any(isinstance(inner, Return) for inner in statements((stmt,))))
        if not reads and isinstance(stmt, Assign) and is_local(stmt.target, name):
            return True
        if not reads and any(name in out_arguments(expr, functions) for expr in expressions(stmt)):
            return True
        if reads or name in writes_of((stmt,), functions):
            return False
    return True
