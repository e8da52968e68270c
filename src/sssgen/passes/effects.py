"""Which module variables a function reads and writes, itself or through what it calls.

Asked by the passes that move, drop or repeat expressions: what reads a variable must not get behind a call that
writes it, nor before.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ..ir.nodes import Assign, Call, Expr, Function, Global, Module, Stmt
from ..ir.walk import expressions, statements, subexpressions, written_root


class Effects(NamedTuple):
    """The names of the module variables that a call may read, and of those that it may write."""

    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()


NONE = Effects()


def effects(module: Module) -> dict[str, Effects]:
    """The effects of each function that has any, by its key; callees may stand behind their callers."""
    if not module.variables:
        return {}
    finder = _Finder(module)
    found = {function.key: finder.of(function.key) for function in module.functions}
    return {key: effect for key, effect in found.items() if effect != NONE}


def read_in(expr: Expr, variables: frozenset[str], known: Mapping[str, Effects]) -> frozenset[str]:
    """Which of the module variables an expression reads, its calls included."""
    found: set[str] = set()
    for part in subexpressions(expr):
        if isinstance(part, Global) and part.name in variables:
            found.add(part.name)
        elif isinstance(part, Call):
            found |= known.get(part.function, NONE).reads
    return frozenset(found)


def stored(stmt: Stmt, functions: Mapping[str, Function]) -> Iterable[str]:
    """The module variables that a statement writes by name: by an assignment, or as an out argument."""
    targets = [stmt.target] if isinstance(stmt, Assign) else []
    for expr in expressions(stmt):
        for part in subexpressions(expr):
            if isinstance(part, Call) and part.function in functions:
                params = functions[part.function].params
                targets += [arg for arg, param in zip(part.args, params, strict=True) if param.direction != "in"]
    return [found.name for found in map(written_root, targets) if isinstance(found, Global)]


class _Finder:
    def __init__(self, module: Module) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.variables = frozenset(variable.name for variable in module.variables)
        self.found: dict[str, Effects] = {}

    def of(self, key: str) -> Effects:
        known = self.found.get(key)
        if known is None:
            self.found[key] = NONE
            function = self.functions.get(key)
            known = self.found[key] = self.function(function) if function is not None else NONE
        return known

    def function(self, function: Function) -> Effects:
        reads: set[str] = set()
        writes: set[str] = set()
        for stmt in statements(function.body or ()):
            writes.update(stored(stmt, self.functions))
            for expr in expressions(stmt):
                for part in subexpressions(expr):
                    if isinstance(part, Global) and part.name in self.variables:
                        reads.add(part.name)
                    elif isinstance(part, Call):
                        called = self.of(part.function)
                        reads |= called.reads
                        writes |= called.writes
        return Effects(frozenset(reads), frozenset(writes))
