"""Which parameters bound the rounds of a loop: huge values of these would make a driver hang.

A slice backwards from the conditions of loops, through assignments and calls, regardless of their order. A loop that
counts to a constant is bounded by itself. In a loop without a condition of its own, the conditions around its `break`
count.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sssgen.ir.nodes import (
    Assign,
    Block,
    Break,
    Call,
    Declare,
    Expr,
    For,
    Function,
    Global,
    If,
    Literal,
    Local,
    Module,
    Return,
    Stmt,
    While,
)
from sssgen.ir.walk import all_expressions, inner_statements, statements, subexpressions, written_root
from sssgen.passes.numpy.uniformity import count

Name = tuple[str, str]
"""A variable: the key of its function, '' for one of the module; and its name."""


def loop_inputs(module: Module, key: str) -> set[str]:
    """The names of the parameters of a function, and of uniforms, that bound loops in it or in its callees."""
    sources: dict[Name, set[Name]] = {}
    bounds: set[Name] = set()
    functions = {function.key: function for function in module.functions}
    constants = {constant.name for constant in module.constants}
    for function in module.functions:
        for stmt in statements(function.body or ()):
            if isinstance(stmt, Declare) and stmt.value is not None:
                sources.setdefault((function.key, stmt.name), set()).update(_read(function, stmt.value))
            elif isinstance(stmt, Assign) and (target := written_root(stmt.target)) is not None:
                sources.setdefault(_name(function, target), set()).update(
                    [*_read(function, stmt.value), *_read(function, stmt.target)]
                )
            bounds.update(_bounds(function, stmt, constants))
        for part in all_expressions(function.body or ()):
            if isinstance(part, Call) and part.function in functions:
                params = functions[part.function].params
                for arg, param in zip(part.args, params, strict=True):
                    if param.direction != "out":
                        sources.setdefault((part.function, param.name), set()).update(_read(function, arg))
                    if param.direction != "in" and (target := written_root(arg)) is not None:
                        names = [(part.function, other.name) for other in params if other.direction != "out"]
                        sources.setdefault(_name(function, target), set()).update(names)
    pending, reached = list(bounds), set(bounds)
    while pending:
        for name in sources.get(pending.pop(), ()):
            if name not in reached:
                reached.add(name)
                pending.append(name)
    own = {(key, param.name) for param in functions[key].params}
    return {name for owner, name in reached if not owner or (owner, name) in own}


def _bounds(function: Function, stmt: Stmt, constants: set[str]) -> Iterator[Name]:
    if not isinstance(stmt, For | While):
        return
    if isinstance(stmt, For) and is_counted(stmt, constants):
        return
    condition = stmt.condition
    if condition is not None and not _is_fixed(condition, constants):
        yield from _read(function, condition)
    else:
        yield from _around_breaks(function, stmt.body)


def is_counted(loop: For, constants: Iterable[str]) -> bool:
    """Whether a loop counts from a constant to a constant."""
    counter = count(loop)
    return counter is not None and _is_fixed(counter.start, constants) and _is_fixed(counter.stop, constants)


def _around_breaks(function: Function, block: Block) -> Iterator[Name]:
    for stmt in statements(block):
        if isinstance(stmt, If) and any(
            isinstance(inner, Break | Return) for part in inner_statements(stmt) for inner in statements((part,))
        ):
            yield from _read(function, stmt.condition)


def _is_fixed(expr: Expr, constants: Iterable[str]) -> bool:
    return all(
        isinstance(part, Literal) or (isinstance(part, Global) and part.name in constants)
        for part in subexpressions(expr)
        if isinstance(part, Literal | Local | Global | Call)
    )


def _read(function: Function, expr: Expr) -> Iterator[Name]:
    for part in subexpressions(expr):
        if isinstance(part, Local | Global):
            yield _name(function, part)


def _name(function: Function, variable: Local | Global) -> Name:
    return (function.key if isinstance(variable, Local) else "", variable.name)
