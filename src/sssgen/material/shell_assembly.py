"""Writes the shell of a target without an engine around a material's chain.

A shell is a function of the language, in `shells/`. Its calls of `evaluate_…` are replaced by calls of the material's
assembled functions: each parameter gets the variable of its name that is visible at the call; an input that the shell
does not compute becomes a parameter of the shell. Steps that the material does not have are removed, and so are
parameters that nothing reads: what remains are the values that the target has to supply (its frame).

Place: after `chain`, whose functions it calls; before `fold` and `prune`, which simplify it as the rest.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping

from sssgen.ir.constant_expressions import literal
from sssgen.ir.nodes import Call, Declare, Expr, Function, Global, Literal, Local, Member, Module, Param, Return, Stmt
from sssgen.ir.transform import Transformer, rewrite_module
from sssgen.ir.types import BOOL, Struct
from sssgen.ir.walk import all_expressions
from sssgen.lang.loader import load_file
from sssgen.material.chain_assembly import DEFAULTS, INPUTS, Entry
from sssgen.passes.fold import fold
from sssgen.passes.struct_types import Retyper
from sssgen.support.paths import PACKAGE

SHELLS = os.path.join(PACKAGE, "shells")
"""The folder of the shells."""

EVALUATE = "evaluate_"
"""The beginning of the names of a chain's functions."""


def add_shell(
    module: Module, entries: Mapping[str, Entry], surface: Struct | None, facts: Mapping[str, bool], name: str,
    given: Collection[str] = (),
) -> tuple[Module, Function]:  # fmt: skip
    """The module with the last function of `shells/NAME.sss`, and this function.

    `entries` are the functions of the chain by kind, `surface` its struct; `facts` are the constants `two_sided` and
    `masked` of the shell, and `given` the variables of the shell that its target supplies instead.
    """
    shell = load_file(os.path.join(SHELLS, f"{name}.sss"), (SHELLS,))
    fields = {field.name for field in surface.fields} if surface is not None else set[str]()
    present = dict(facts) | dict.fromkeys([f"has_{name}" for name in (*entries, *fields)], True)
    function = _decide(shell, present, fields).functions[-1]
    if surface is not None:
        function = Retyper({struct.type: surface for struct in shell.structs}, {}).function(function)
    function = without_unread_parameters(_ChainCalls(entries, given).function(function))
    constants = (*module.constants, *shell.constants)
    return module._replace(constants=constants, functions=(*module.functions, function)), function


def without_unread_parameters(function: Function) -> Function:
    """The shell without the parameters that nothing reads: the rest is what its target supplies."""
    read = {expr.name for expr in all_expressions(function.body or ()) if type(expr) is Local}
    return function._replace(params=tuple(param for param in function.params if param.name in read))


def _decide(shell: Module, facts: Mapping[str, bool], fields: set[str]) -> Module:
    """The shell without the branches that the facts exclude, and without the surface's values that do not exist."""

    def change(expr: Expr) -> Expr:
        if type(expr) is Global and expr.type == BOOL:
            return Literal(BOOL, facts.get(expr.name, False), expr.span)
        if type(expr) is Member and expr.field not in fields:
            return literal(*DEFAULTS[expr.field], expr.span)
        return expr

    *others, function = fold(rewrite_module(shell, change)).functions
    body = function.body or ()
    end = next((index for index, stmt in enumerate(body) if type(stmt) is Return), len(body) - 1)
    return shell._replace(functions=(*others, function._replace(body=body[: end + 1])))


class _ChainCalls(Transformer):
    """Replaces the calls of `evaluate_…` in a shell by those of the chain's functions."""

    def __init__(self, entries: Mapping[str, Entry], given: Collection[str]) -> None:
        super().__init__()
        self.entries, self.given = entries, given
        self.added: dict[str, Param] = {}
        """The parameters of the shell for inputs that it does not compute."""

    def function(self, function: Function) -> Function:
        function = super().function(function)
        return function._replace(params=(*function.params, *self.added.values()))

    def declare(self, stmt: Declare) -> Stmt | None:
        return super().declare(stmt) if stmt.name not in self.given else None

    def expression(self, expr: Expr) -> Expr:
        if type(expr) is not Call or not expr.function.startswith(EVALUATE):
            return super().expression(expr)
        entry = self.entries[expr.function.partition("(")[0].removeprefix(EVALUATE)].function
        for param in entry.params:
            if param.name not in self.scope:
                self.added[param.name] = Param(param.name, INPUTS[param.name], "in", "", expr.span)
        args = tuple(Local(param.type, param.name, expr.span) for param in entry.params)
        return Call(entry.result, entry.key, args, expr.span)
