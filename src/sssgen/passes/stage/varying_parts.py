"""Passes nested structs and arrays between stages as variables of their parts, for languages that pass none.

    out Surface surface;    // struct Surface { vec2 uv; Light lights[2]; };

becomes a private variable `surface` and the outputs `surface_uv`, `surface_lights_0_color`, …, which main() sets before
it returns. A fragment shader has them as inputs, and sets its variable first.

Place: with the interface, before arrays of arrays become structs; both stages have the same names by it.
"""

from __future__ import annotations

from collections.abc import Iterator

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, Array, Struct, Type
from sssgen.passes.scopes import claim, names_of
from sssgen.passes.stage.entry_copies import copies_last
from sssgen.passes.stage.stage_interface import entry_of, stage_kind
from sssgen.passes.stage.varyings import parts, varyings


def varying_parts(module: ir.Module) -> ir.Module:
    """The module without nested types between the stages."""
    kind = stage_kind(module)
    nested = [variable for variable in varyings(module, kind) if _nests(variable.type)]
    entry = entry_of(module)
    if not nested or entry is None:
        return module
    taken = names_of(module)
    variables: list[ir.Variable] = []
    copies: list[ir.Stmt] = []
    for variable in module.variables:
        if variable not in nested:
            variables.append(variable)
            continue
        variables.append(variable._replace(storage="private", interpolation="", location=-1))
        location = variable.location
        for names, place in _places(ir.Global(variable.type, variable.name, variable.span), (variable.name,)):
            part = variable._replace(name=claim("_".join(names), taken), type=place.type, location=location)
            location += len(parts(part)) if location >= 0 else 0
            variables.append(part)
            passed = ir.Global(part.type, part.name, part.span)
            target, value = (passed, place) if kind == "vertex" else (place, passed)
            copies.append(ir.Assign(target, "", value, part.span))
    add_copies = copies_last if kind == "vertex" else ir.Function.begun_with
    functions = [
        add_copies(function, tuple(copies)) if function is entry else function for function in module.functions
    ]
    return module._replace(variables=tuple(variables), functions=tuple(functions))


def _nests(type_: Type) -> bool:
    """Whether it is a struct or an array with structs or arrays in it."""
    parts_ = [field.type for field in type_.fields] if isinstance(type_, Struct) else []
    parts_ += [type_.element] if isinstance(type_, Array) else []
    return any(isinstance(part, Struct | Array) for part in parts_)


def _places(place: ir.Expr, names: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], ir.Expr]]:
    """The parts of a variable that are no structs and no nested arrays, each with the steps to it."""
    type_, span = place.type, place.span
    if isinstance(type_, Struct):
        for field in type_.fields:
            yield from _places(ir.Member(field.type, place, field.name, span), (*names, field.name))
    elif _nests(type_) and isinstance(type_, Array):
        for index in range(type_.length):
            element = ir.Index(type_.element, place, ir.Literal(INT, index, span), span)
            yield from _places(element, (*names, str(index)))
    else:
        yield names, place
