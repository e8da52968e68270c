"""Passes module variables to functions as parameters, for targets that have none.

Why: a NumPy function has no variables but its own, and its inputs must be visible.
Place: after `hoist` and `guards`, before `uniforms_to_parameters`, whose parameters follow these, and `legalise`.

A function gets a parameter for each variable that it or its callees use: after its own parameters, in the order in
which the variables are declared, with their names; `inout` where the variable may be written, else `in`. A local
variable of the same name is renamed. A caller from outside passes the initial values of the variables; nothing else
sets them.

The entry of a stage has the stage's `in` variables as parameters and its `out` variables as `out` parameters; private
variables become local variables with their initial values. A compute shader keeps its other variables: what calls its
entry declares and passes them.
"""

from __future__ import annotations

from sssgen.ir.nodes import Declare, Function, Module, Param, Stmt
from sssgen.passes.lift_calls import Calls, lift
from sssgen.passes.stage.initial_values import set_at_start
from sssgen.passes.uniforms_to_parameters import Closer
from sssgen.passes.variable_effects import effects


def variables_to_parameters(module: Module, entry: str = "") -> Module:
    """The module with its variables as parameters; `entry` is the key of a stage's main function, if there is one."""
    if not module.variables:
        return module
    if entry:
        module = set_at_start(module, entry, all_of_them=True)
    shared = effects(module)
    calls = Calls({function.key: function for function in module.functions}, shared)
    # from here on a call that writes is a separate statement, so that no variable is passed twice
    module = module._replace(functions=tuple([lift(variable, calls) for variable in module.functions]))
    parameters = {
        variable.name: Param(variable.name, variable.type, "in", "", variable.span, variable.name)
        for variable in module.variables
    }
    closer = Closer(module, parameters, {key: effect.writes for key, effect in shared.items()})
    functions = [
        _entry(new, len(old.params), module) if old.key == entry else new
        for old, new in zip(module.functions, closer.run(), strict=True)
    ]
    kept = ("buffer", "image", *(("in", "shared") if module.workgroup else ()))
    others = tuple([variable for variable in module.variables if variable.storage in kept])
    return module._replace(functions=tuple(functions), variables=others)


def _entry(function: Function, own: int, module: Module) -> Function:
    """The entry, with parameters for the inputs and outputs of its stage, and local variables for the others."""
    storage = {variable.name: variable.storage for variable in module.variables}
    params: list[Param] = list(function.params[:own])
    begins: list[Stmt] = []
    for param in function.params[own:]:
        kind = storage[param.name]
        if kind == "private":
            begins.append(Declare(param.name, param.type, None, param.span))
        else:
            params.append(param._replace(direction=kind if kind in ("in", "out") else param.direction))
    return function._replace(params=tuple(params), body=(*begins, *(function.body or ())))
