"""A module that the interpreter runs, and what it has to know of the nodes."""

from __future__ import annotations

from collections.abc import Callable

from sssgen.analyse.verify.loop_inputs import is_counted
from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.walk import all_expressions, builtins_of, statements
from sssgen.passes.scopes import separate


class Program:
    """A module that can be run; its nodes keep their identities from run to run."""

    def __init__(self, module: ir.Module, check: Callable[[], None] = lambda: None) -> None:
        self.check = check
        """Called at each call of a function and each round of a loop; it may raise an error to end the run."""
        self.module = module._replace(functions=tuple([separate(function) for function in module.functions]))
        self.functions = {function.key: function for function in self.module.functions}
        self.neighbours = any(BUILTINS[name].kind == "derivative" for name in builtins_of(self.module))
        """Whether lanes read values of other lanes."""
        constants = {constant.name for constant in module.constants}
        nodes = [stmt for function in self.module.functions for stmt in statements(function.body or ())]
        self.counted = {id(stmt) for stmt in nodes if isinstance(stmt, ir.For) and is_counted(stmt, constants)}
        """The ids of loops that count from a constant to a constant."""
        self.long_branches = {id(stmt) for stmt in nodes if isinstance(stmt, ir.If) and _is_long(stmt)}
        """The ids of the branches with calls or loops."""


def _is_long(branch: ir.If) -> bool:
    parts = [part for block in (branch.then, branch.otherwise) for part in statements(block)]
    calls_functions = any(
        isinstance(part, ir.Call) for block in (branch.then, branch.otherwise) for part in all_expressions(block)
    )
    return calls_functions or any(isinstance(part, ir.For | ir.While) for part in parts)
