"""Removes variables that are another name of a value: `float through = thinness;`, where neither is assigned later.

Why: conversions between quantities leave them behind, and a reader has to look up what the other name is.
Place: after `conversions` and `prune`, which leave them; before `guards`, whose text then reads the name that stays.
"""

from __future__ import annotations

from collections import Counter

from sssgen.ir.nodes import Block, Declare, Expr, Local, Module, Stmt
from sssgen.ir.transform import Transformer
from sssgen.passes.scopes import assigned, declared, outs_of


def drop_aliases(module: Module) -> Module:
    """The module with one name for each value: the last one of its block, which says most. Parameters keep theirs."""
    outs = outs_of(module.functions)
    functions = []
    for function in module.functions:
        once = {name for name, count in Counter(declared(function)).items() if count == 1}
        finder = _Finder(once - assigned(function, outs))
        finder.function(function)
        functions.append(_Merger(finder).function(function) if finder.first else function)
    return module._replace(functions=tuple(functions))


class _Finder(Transformer):
    """Finds the aliases of a function, and changes nothing."""

    def __init__(self, names: set[str]) -> None:
        super().__init__()
        self.names = names
        """The parameters and variables that are declared once and not assigned."""
        self.first: dict[str, str] = {}
        """Alias → the variable that has the value first."""
        self.last: dict[str, str] = {}
        """That variable → the name that stays, where it is another one."""
        self.own: set[str] = set()
        """The variables of the current block, without aliases."""

    def block(self, block: Block) -> Block:
        outer, self.own = self.own, set()
        super().block(block)
        self.own = outer
        return block

    def declare(self, stmt: Declare) -> Stmt:
        value = stmt.value
        if not {stmt.name, getattr(value, "name", "")} <= self.names or not isinstance(value, Local):
            self.own.add(stmt.name)
        else:
            first = self.first[stmt.name] = self.first.get(value.name, value.name)
            if first in self.own:  # in an outer block, others would see the new name
                self.last[first] = stmt.name
        return stmt

    def expression(self, expr: Expr) -> Expr:
        return expr


class _Merger(Transformer):
    """Gives each value the name that stays."""

    def __init__(self, aliases: _Finder) -> None:
        super().__init__()
        self.aliases = aliases

    def declare(self, stmt: Declare) -> Stmt | None:
        if stmt.name in self.aliases.first:
            return None
        return super().declare(stmt._replace(name=self.aliases.last.get(stmt.name, stmt.name)))

    def expression(self, expr: Expr) -> Expr:
        if not isinstance(expr, Local):
            return super().expression(expr)
        first = self.aliases.first.get(expr.name, expr.name)
        return expr._replace(name=self.aliases.last.get(first, first))
