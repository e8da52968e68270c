"""The part of a module that some functions use, with all their statements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sssgen.ir.nodes import Declare, Global, Module
from sssgen.ir.types import Array, Struct, Type
from sssgen.ir.walk import all_expressions, callees, statements, subexpressions


def keep_reachable(module: Module, roots: Iterable[str]) -> Module:
    """The module with only the functions that `roots` call, directly or indirectly; the other declarations remain.

    Raises KeyError for a root that the module does not have.
    """
    functions = {function.key: function for function in module.functions}
    reached: set[str] = set()
    pending = list(roots)
    while pending:
        key = pending.pop()
        if key not in reached:
            reached.add(key)
            pending += callees(functions[key])
    return module._replace(functions=tuple([function for key, function in functions.items() if key in reached]))


def drop_unused(module: Module, is_stage: bool) -> Module:
    """The module with only the declarations that its functions mention, directly or indirectly.

    A stage keeps its inputs and outputs: other stages depend on them.
    """
    names: set[str] = set()
    pending = [expr for function in module.functions for expr in all_expressions(function.body or ())]
    values = {constant.name: constant.value for constant in module.constants}
    values |= {variable.name: variable.value for variable in module.variables if variable.value is not None}
    types: set[Type] = set()
    for function in module.functions:
        types |= {function.result, *(param.type for param in function.params)}
        types |= {stmt.type for stmt in statements(function.body or ()) if isinstance(stmt, Declare)}
    while pending:
        expr = pending.pop()
        types.add(expr.type)
        if isinstance(expr, Global) and expr.name not in names:
            names.add(expr.name)
            if expr.name in values:
                pending += subexpressions(values[expr.name])
    structs = set(structs_in(types))
    names |= {variable.name for variable in module.variables if is_stage and variable.storage != "private"}
    return module._replace(
        structs=tuple([struct for struct in module.structs if struct.type in structs]),
        constants=tuple([constant for constant in module.constants if constant.name in names]),
        uniforms=tuple([uniform for uniform in module.uniforms if uniform.name in names]),
        variables=tuple([variable for variable in module.variables if variable.name in names]),
    )


def structs_in(types: Iterable[Type]) -> Iterator[Type]:
    """The structs that these types are or hold."""
    for type_ in types:
        if isinstance(type_, Array):
            yield from structs_in((type_.element,))
        elif isinstance(type_, Struct):
            yield type_
            yield from structs_in(field.type for field in type_.fields)
