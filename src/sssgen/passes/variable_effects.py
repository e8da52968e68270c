"""The module variables that a function and its callees read and write.

Used by the passes that move, drop or repeat expressions: an expression that reads a variable must not move past a call
that writes it.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.nodes import Function, Global, Module
from sssgen.ir.walk import calls_of, statements, written_places, written_root
from sssgen.passes.scopes import globals_of, outs_of


class Effects(NamedTuple):
    """The names of the module variables that a call may read, and of those that it may write."""

    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()


NONE = Effects()


def effects(module: Module) -> dict[str, Effects]:
    """The effects of each function that has any, by its key; callees may come after their callers."""
    if not module.variables:
        return {}
    finder = _Finder(module)
    result = {function.key: finder.of(function.key) for function in module.functions}
    return {key: effect for key, effect in result.items() if effect != NONE}


class _Finder:
    def __init__(self, module: Module) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.outs = outs_of(module.functions)
        self.variables = frozenset(variable.name for variable in module.variables)
        self.effects: dict[str, Effects] = {}

    def of(self, key: str) -> Effects:
        effect = self.effects.get(key)
        if effect is None:
            self.effects[key] = NONE
            function = self.functions.get(key)
            effect = self.effects[key] = self.function(function) if function is not None else NONE
        return effect

    def function(self, function: Function) -> Effects:
        body = function.body or ()
        calls = calls_of(body)
        targets = [place for stmt in statements(body) for place in written_places(stmt)]
        targets += [call.args[index] for call in calls for index in self.outs.get(call.function, ())]
        writes = {place.name for place in map(written_root, targets) if isinstance(place, Global)}
        called = [self.of(key) for key in {call.function for call in calls}]
        return Effects(
            (self.variables & globals_of(function)).union(*[effect.reads for effect in called]),
            frozenset(writes).union(*[effect.writes for effect in called]),
        )
