"""Sets module variables at the start of the entry where a declaration cannot, or in each function without an entry.

Why: WGSL, GLSL ES and HLSL want constants there, and a target without module variables has no such declarations. In a
library of functions uniforms are parameters, which no declaration at file scope can read.
Place: before `legalise`, to which the assignments are ordinary code; before uniforms become parameters.
"""

from __future__ import annotations

from collections.abc import Collection

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Assign, Declare, Expr, Function, Global, Intrinsic, Local, Module, Variable
from sssgen.ir.transform import rewrite, rewrite_function
from sssgen.ir.walk import subexpressions
from sssgen.passes.scopes import declared, fresh, globals_of, rename_locals
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects


def set_at_start(module: Module, entry: str, all_of_them: bool = False) -> Module:
    """The module with its variables' values set first in the function with the key `entry`, in their order.

    Only those that are no constants, unless it is to be `all_of_them`. Raises Unsupported where `entry` is ''.
    """
    constants = {constant.name for constant in module.constants}
    moved = [
        variable
        for variable in module.variables
        if variable.value is not None and (all_of_them or _varies(variable, constants))
    ]
    if not moved:
        return module
    if not entry:
        raise _error(moved[0])
    names = {variable.name for variable in moved}
    variables = [each._replace(value=None) if each.name in names else each for each in module.variables]
    stmts = tuple(map(_assignment, moved))
    functions = [
        function.begun_with(tuple(stmts)) if function.key == entry else function for function in module.functions
    ]
    return module._replace(variables=tuple(variables), functions=tuple(functions))


def set_in_functions(module: Module, variables_exist: bool, values_vary: bool) -> Module:
    """A module without an entry: a variable that is never written is declared in the functions that read it.

    `variables_exist`: the target has module variables. Then only those are moved that are computed from uniforms, and,
    unless `values_vary`, from other variables; Unsupported is raised for one that is written.
    """
    constants = {constant.name for constant in module.constants}
    private = {variable.name for variable in module.variables if variable.storage == "private"}
    computed: dict[str, Variable] = {}
    for variable in module.variables:
        if variable.value is None:
            continue
        used = _globals(variable.value)
        if not variables_exist or (
            _varies(variable, constants) and (not values_vary or used - constants - private or used & computed.keys())
        ):
            computed[variable.name] = variable
    if not computed:
        return module
    written = frozenset[str]().union(*[effect.writes for effect in effects(module).values()])
    for variable in list(computed.values()):
        assert variable.value is not None
        if written.isdisjoint({variable.name, *_globals(variable.value)}):
            continue
        if variables_exist:
            raise _error(variable)
        del computed[variable.name]
    functions = tuple([_with_declarations(function, computed) for function in module.functions])
    variables = tuple([variable for variable in module.variables if variable.name not in computed])
    return module._replace(functions=functions, variables=variables)


def _with_declarations(function: Function, computed: dict[str, Variable]) -> Function:
    """A function with local variables in place of the computed ones that it reads."""
    needed = globals_of(function) & computed.keys()
    for name in reversed(computed):  # a value reads earlier variables only
        value = computed[name].value
        if name in needed and value is not None:
            needed |= _globals(value) & computed.keys()
    if not needed:
        return function
    hidden = needed & set(declared(function))
    if hidden:
        function, _ = rename_locals(function, hidden, fresh)

    def change(node: Expr) -> Expr:
        return Local(node.type, node.name, node.span) if isinstance(node, Global) and node.name in needed else node

    function = rewrite_function(function, change)
    declarations = [
        Declare(name, variable.type, rewrite(variable.value, change), variable.span)
        for name, variable in computed.items()
        if name in needed and variable.value is not None
    ]
    return function.begun_with(tuple(declarations))


def _globals(value: Expr) -> set[str]:
    return {part.name for part in subexpressions(value) if isinstance(part, Global)}


def _error(variable: Variable) -> Unsupported:
    message = f"the value of '{variable.name}' is not constant, and there is no main() that could set it"
    return Unsupported(message, variable.span)


def _assignment(variable: Variable) -> Assign:
    assert variable.value is not None
    return Assign(Global(variable.type, variable.name, variable.span), "", variable.value, variable.span)


def _varies(variable: Variable, constants: Collection[str]) -> bool:
    """Whether a value is of more than constants."""
    assert variable.value is not None
    return any(
        (isinstance(part, Global) and part.name not in constants)
        or (isinstance(part, Intrinsic) and BUILTINS[part.name].reads_neighbours_or_textures)
        for part in subexpressions(variable.value)
    )
