"""Removes the calls of conversions: functions that return one of their parameters unchanged.

Why: in a technique such a function turns one quantity into another; only the checker needs it.
Place: after `fold`, which can make a conversion of a longer function; before `prune`, which then removes the functions.
"""

from __future__ import annotations

from sssgen.ir.nodes import Block, Call, Evaluate, Expr, Function, Intrinsic, Local, Module, Return, Stmt
from sssgen.ir.transform import rewrite_module
from sssgen.passes.constructed_parts import calls


def drop_conversions(module: Module) -> Module:
    """The module with the argument in place of each call of a conversion. The functions themselves remain."""
    converted = {
        function.key: position
        for function in module.functions
        if (position := _returned_position(function)) is not None
    }
    if not converted:
        return module

    def change(node: Expr) -> Expr:
        if type(node) is not Call or node.function not in converted:
            return node
        position = converted[node.function]
        dropped = node.args[:position] + node.args[position + 1 :]
        return node if any(map(calls, dropped)) else node.args[position]

    return rewrite_module(module, change, _without_idle_calls)


def _returned_position(function: Function) -> int | None:
    """The position of the parameter that a conversion returns; None for any other function."""
    body = function.body or ()
    value = body[0].value if len(body) == 1 and isinstance(body[0], Return) else None
    names = [param.name for param in function.params]
    only_reads = all(param.direction == "in" for param in function.params)
    return names.index(value.name) if only_reads and isinstance(value, Local) else None


def _without_idle_calls(stmt: Stmt) -> Block | None:
    return () if isinstance(stmt, Evaluate) and not isinstance(stmt.call, Call | Intrinsic) else None
