"""Sets module variables at the start of the entry where a declaration cannot.

Why: WGSL, GLSL ES and HLSL want constants there, and a target without module variables has no such declarations.
Place: before `legalise`, to which the assignments are ordinary code.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Assign, Global, Intrinsic, Module, Variable
from sssgen.ir.walk import subexpressions
from sssgen.passes.unsupported import Unsupported


def set_at_start(module: Module, entry: str, all_of_them: bool = False) -> Module:
    """The module with its variables' values set first in the function with the key `entry`, in their order.

    Only those that are no constants, unless it is to be `all_of_them`. Raises Unsupported where `entry` is ''.
    """
    constants = {constant.name for constant in module.constants}
    moved = [
        declaration
        for declaration in module.variables
        if declaration.value is not None and (all_of_them or _varies(declaration, constants))
    ]
    if not moved:
        return module
    if not entry:
        message = f"the value of '{moved[0].name}' is not constant, and there is no main() that could set it"
        raise Unsupported(message, moved[0].span)
    names = {variable.name for variable in moved}
    variables = tuple(
        [
            declaration._replace(value=None) if declaration.name in names else declaration
            for declaration in module.variables
        ]
    )
    stmts = tuple(map(_set, moved))
    functions = tuple(
        [
            declaration._replace(body=(*stmts, *(declaration.body or ()))) if declaration.key == entry else declaration
            for declaration in module.functions
        ]
    )
    return module._replace(variables=variables, functions=functions)


def _set(variable: Variable) -> Assign:
    assert variable.value is not None
    return Assign(Global(variable.type, variable.name, variable.span), "", variable.value, variable.span)


def _varies(variable: Variable, constants: set[str]) -> bool:
    """Whether a value is of more than constants."""
    assert variable.value is not None
    return any(
        (isinstance(part, Global) and part.name not in constants)
        or (isinstance(part, Intrinsic) and BUILTINS[part.name].reads_neighbours_or_textures)
        for part in subexpressions(variable.value)
    )
