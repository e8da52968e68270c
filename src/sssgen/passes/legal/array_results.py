"""Functions that return an array, for a target without such functions: an out parameter takes the result."""

from __future__ import annotations

from sssgen.ir.nodes import Assign, Block, Call, Function, Local, Param, Return, Stmt, function_key
from sssgen.ir.transform import rewrite_block
from sssgen.ir.types import VOID, Array
from sssgen.passes.scopes import declared, fresh


def by_out_parameter(function: Function) -> Function:
    """The function with its result as its last parameter."""
    name = fresh("result", set(declared(function)))
    place = Local(function.result, name, function.span)

    def restate(stmt: Stmt) -> Block | None:
        if not isinstance(stmt, Return) or stmt.value is None:
            return None
        return Assign(place, "", stmt.value, stmt.span), Return(None, stmt.span)

    body = rewrite_block(function.body or (), lambda node: node, restate)
    if body and isinstance(body[-1], Return):
        body = body[:-1]
    result = Param(name, function.result, "out", function.quantity, function.span)
    return function._replace(params=(*function.params, result), result=VOID, quantity="", body=body)


def call_into(call: Call, function: Function, place: Local) -> Call:
    """A call of such a function that puts the result into a variable."""
    assert isinstance(function.result, Array)
    key = function_key(function.name, [*(param.type for param in function.params), function.result])
    return Call(VOID, key, (*call.args, place), call.span)
