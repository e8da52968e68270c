"""Which memory holds atomics: WGSL and Metal have a type of its own for it, and read and write it by functions.

Such memory is read and written number by number. `check_atomics` refuses what would copy more of it, before `legalise`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.nodes import Declare, Expr, Function, Global, Index, Local, Member, MemoryOperation, Module, Span
from sssgen.ir.types import Array, Scalar, Struct, Type, unnested
from sssgen.ir.walk import expressions, operands, statements
from sssgen.passes.unsupported import Unsupported

Memory = tuple[str, ...]
"""A variable's name, or a struct and its member."""
_NO_PARAMETERS: Mapping[str, str] = {}


def memory_of(place: Expr, passed: Mapping[str, str] = _NO_PARAMETERS) -> Memory:
    """What a place is in: a module variable, or a member of a struct; () for any other place.

    `passed`: the parameters of the function that pass module variables, with the names of these.
    """
    while isinstance(place, Index) and isinstance(place.value.type, Array):
        place = place.value
    if isinstance(place, Global):
        return (place.name,)
    if isinstance(place, Local):
        return (passed[place.name],) if place.name in passed else ()
    if isinstance(place, Member) and isinstance(place.value.type, Struct):
        return (place.value.type.name, place.field)
    return ()


def passed_variables(function: Function) -> dict[str, str]:
    """The parameters of a function that pass module variables or uniforms, with the names of these."""
    return {param.name: param.passes for param in function.params if param.passes}


def atomic_places(module: Module) -> frozenset[Memory]:
    """The memory on which atomics work."""
    return frozenset(
        memory_of(stmt.args[0], passed_variables(function))
        for function in module.functions
        for stmt in statements(function.body or ())
        if isinstance(stmt, MemoryOperation) and MEMORY[stmt.name].is_atomic
    )


def check_atomics(module: Module) -> None:
    """Raises Unsupported for atomics on components, and where memory of atomics is copied as a whole."""
    errors = list({(error.span.file, error.span.line): error for error in _errors(module)}.values())
    if errors:
        raise Unsupported(errors[0].message, errors[0].span, errors[1:], errors[0].hint)


def _errors(module: Module) -> Iterator[Unsupported]:
    places = atomic_places(module) - {()}
    for function in module.functions:
        for stmt in statements(function.body or ()):
            if isinstance(stmt, MemoryOperation) and MEMORY[stmt.name].is_atomic and not memory_of(stmt.args[0]):
                hint = "atomics of this target work on whole numbers in memory: declare an array of uint"
                yield Unsupported(f"{stmt.name} works on a component of a vector", stmt.args[0].span, (), hint)
    holders = {place[0]: place[1] for place in places if len(place) == 2}
    for function in module.functions:
        declared: list[tuple[Type, Span]] = [(function.result, function.span)]
        declared += [(param.type, param.span) for param in function.params]
        for stmt in statements(function.body or ()):
            if isinstance(stmt, Declare):
                declared.append((stmt.type, stmt.span))
            is_length = isinstance(stmt, MemoryOperation) and stmt.name == "arrayLength"  # which reads no number
            for expr in expressions(stmt) if not is_length else ():
                yield from _copies(expr, places, holders)
        for type_, span in declared:
            if name := _holder(type_, holders):
                yield _copy_error(name, holders[name], span)


def _copies(expr: Expr, places: Iterable[Memory], holders: Mapping[str, str]) -> Iterator[Unsupported]:
    """The errors of an expression whose value is used: memory of atomics that is no single number."""
    if not isinstance(expr.type, Scalar):
        if name := _holder(expr.type, holders):
            yield _copy_error(name, holders[name], expr.span)
        elif memory_of(expr) in places:
            hint = "copy it element by element in a loop"
            yield Unsupported(f"'{memory_of(expr)[-1]}' has atomics, and is copied as a whole", expr.span, (), hint)
    while isinstance(expr, Index | Member):  # the places on the way are not read
        if isinstance(expr, Index):
            yield from _copies(expr.index, places, holders)
        expr = expr.value
    for operand in operands(expr):
        yield from _copies(operand, places, holders)


def _copy_error(name: str, member: str, span: Span) -> Unsupported:
    message = f"'{name}.{member}' is an atomic of this target, so a {name} cannot be copied or be a local variable"
    return Unsupported(
        message, span, (), "read and write its members one by one, or give the number an array of its own"
    )


def _holder(type_: Type, holders: Mapping[str, str]) -> str:
    """The name of a struct with atomics that a value of the type has; '' for none."""
    inner, _ = unnested(type_)
    if not isinstance(inner, Struct):
        return ""
    if inner.name in holders:
        return inner.name
    return next((name for field in inner.fields if (name := _holder(field.type, holders))), "")
