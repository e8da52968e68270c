"""Removes everything that a material does not use: functions, uniforms, constants, structs, statements without effect.

Why: a shader must contain only the parameters of its techniques, and a reader should not find dead code.
Place: after `fold`, which makes branches and uniforms unused; before `hoist`, `uniform_parameters` and `names`, which
then see only used declarations, callees before callers. It may run again after a pass that leaves unused code.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from sssgen.ir.nodes import Module
from sssgen.ir.types import Type
from sssgen.passes.dead_statements import Cleaner, CleanFunction, needs_of
from sssgen.passes.reachable import structs_in

_T = TypeVar("_T")


def prune(module: Module, roots: Iterable[str]) -> Module:
    """The part of a module that the functions with the keys `roots` use, without dead statements.

    The inputs and outputs of a stage (in and out variables) stay: other stages depend on them.

    The functions are ordered, callees before callers, otherwise in the order they had. Raises KeyError for a
    root that the module does not have.
    """
    cleaner = Cleaner(module)
    reached = set(roots)
    pending = list(reached)
    while pending:
        for callee in cleaner.clean(pending.pop()).needs.calls:
            if callee not in reached and callee in cleaner.functions:
                reached.add(callee)
                pending.append(callee)
    kept: dict[str, CleanFunction] = {}
    for key in cleaner.functions:
        if key in reached:
            _place(key, cleaner, kept)
    names, types = set[str](), set[Type]()
    for cleaned in kept.values():
        names |= cleaned.needs.globals
        types |= cleaned.needs.types
    variables = []
    for variable in reversed(module.variables):
        if variable.name in names or variable.storage != "private":
            variables.append(variable)
            needs = needs_of(variable.value, variable.type)
            names |= needs.globals
            types |= needs.types
    constants = []
    for constant in reversed(module.constants):
        if constant.name in names:
            constants.append(constant)
            needs = needs_of(constant.value, constant.type)
            names |= needs.globals
            types |= needs.types
    structs = set(structs_in(types))
    return Module(
        _same(module.structs, [struct for struct in module.structs if struct.type in structs]),
        _same(module.constants, constants[::-1]),
        _same(module.uniforms, [uniform for uniform in module.uniforms if uniform.name in names]),
        _same(module.functions, [cleaned.function for cleaned in kept.values()]),
        _same(module.variables, variables[::-1]),
        module.workgroup,
    )


def _same(old: tuple[_T, ...], new: list[_T]) -> tuple[_T, ...]:
    """`new` as a tuple; `old` itself where it holds the same."""
    same = len(old) == len(new) and all(first is second for first, second in zip(old, new, strict=True))
    return old if same else tuple(new)


def _place(key: str, cleaner: Cleaner, kept: dict[str, CleanFunction]) -> None:
    """Adds a function after those it calls."""
    if key in kept or key not in cleaner.functions:
        return
    cleaned = cleaner.clean(key)
    callees = cleaned.needs.calls
    if not all(callee in kept for callee in callees):
        for callee in cleaner.functions:
            if callee in callees:
                _place(callee, cleaner, kept)
    kept[key] = cleaned
