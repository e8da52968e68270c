"""Techniques without the optional values of the surface that no stage of their chain writes: these are constants.

So the text of the standard lighting has a clear coat only in materials with one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from sssgen.ir.constant_expressions import literal
from sssgen.ir.nodes import Assign, Call, Declare, Expr, Function, Local, Module
from sssgen.ir.surface_fields import OPTIONAL
from sssgen.ir.transform import rewrite_function
from sssgen.ir.walk import all_expressions, statements, written_root
from sssgen.material.chain_assembly import DEFAULTS


def unwritten(functions: Sequence[Function]) -> frozenset[str]:
    """The optional values that none of a chain's functions writes."""
    written = {param.name for function in functions for param in function.params if param.direction != "in"}
    return frozenset(OPTIONAL) - written


def with_constants(function: Function, module: Module, names: Collection[str]) -> Function:
    """The function without the parameters of these names, whose values are their defaults.

    A function that changes such a parameter keeps it.
    """
    read = [param for param in function.params if param.name in names]
    given = {param.name for param in read if param.type == DEFAULTS[param.name][0]}
    if not given or function.body is None or not given.isdisjoint(_changes(function, module)):
        return function

    def change(expr: Expr) -> Expr:
        if type(expr) is Local and expr.name in given:
            return literal(*DEFAULTS[expr.name], expr.span)
        return expr

    rest = tuple(param for param in function.params if param.name not in given)
    return rewrite_function(function._replace(params=rest), change)


def _changes(function: Function, module: Module) -> Iterator[str]:
    """The names of the variables that a function declares or changes."""
    assert function.body is not None
    callees = {callee.key: callee for callee in module.functions}
    for stmt in statements(function.body):
        if type(stmt) is Declare:
            yield stmt.name
        elif type(stmt) is Assign and (target := written_root(stmt.target)) is not None:
            yield target.name
    for expr in all_expressions(function.body):
        if type(expr) is Call:
            for arg, param in zip(expr.args, callees[expr.function].params, strict=True):
                if param.direction != "in" and (target := written_root(arg)) is not None:
                    yield target.name
