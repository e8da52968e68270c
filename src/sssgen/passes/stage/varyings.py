"""What a vertex shader passes to a fragment shader: how two stages that are translated apart agree on it.

GLSL matches outputs and inputs by their location where both state one, else by their name. A language that matches by
location needs numbers for the names: those without a location are numbered in the order of their names, which both
stages know, if they declare the same. A fragment shader may declare fewer; then it needs its vertex shader, the
partner, whose numbers it takes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sssgen.ir.nodes import Module, Span, Variable
from sssgen.ir.rules import element_type
from sssgen.ir.types import Array, Matrix, Struct, Type, spell, unnested, with_article
from sssgen.passes.scopes import globals_of
from sssgen.passes.unsupported import Unsupported
from sssgen.support.diagnostics import did_you_mean

Path = tuple[int | str, ...]
"""The indices and the names of members that lead to a part of a variable."""
Part = tuple[Path, Type]
"""A scalar or vector of a variable, and its path."""


def varyings(module: Module, kind: str) -> list[Variable]:
    """The outputs of a vertex shader, or the inputs of a fragment shader, without builtins."""
    storage = "out" if kind == "vertex" else "in"
    return [variable for variable in module.variables if variable.storage == storage and not variable.builtin]


def locations(variables: Sequence[Variable], partner: Mapping[str, range], by_name: bool) -> dict[str, range]:
    """The locations of each variable, by its name: those that it states, those of the partner, or the lowest free
    ones, in the order of the names or of the declarations. Raises Unsupported where stated ones overlap."""
    placed: dict[str, range] = {}
    counts = {variable.name: len(parts(variable)) for variable in variables}
    for variable in variables:
        if variable.location >= 0:
            placed[variable.name] = range(variable.location, variable.location + counts[variable.name])
            for name, others in placed.items():
                if name != variable.name and set(others) & set(placed[variable.name]):
                    message = f"'{variable.name}' has a location of '{name}'"
                    hint = "give each variable locations of its own; a matrix has one for each column"
                    raise Unsupported(message, variable.span, hint=hint)
        elif variable.name in partner:
            placed[variable.name] = partner[variable.name]
    taken = {location for places in (*placed.values(), *partner.values()) for location in places}
    names = [variable.name for variable in variables if variable.name not in placed]
    for name in sorted(names) if by_name else names:
        candidates = (range(first, first + counts[name]) for first in range(len(taken) + 1))
        placed[name] = next(candidate for candidate in candidates if taken.isdisjoint(candidate))
        taken.update(placed[name])
    return placed


def parts(variable: Variable) -> list[Part]:
    """The scalars and vectors of a variable, in their order."""
    return _parts(variable.type, ())


def _parts(type_: Type, path: Path) -> list[Part]:
    if isinstance(type_, Struct):
        return [part for field in type_.fields for part in _parts(field.type, (*path, field.name))]
    if not isinstance(type_, Array | Matrix):
        return [(path, type_)]
    elements = element_type(type_)
    assert elements is not None
    element, count = elements
    return [part for index in range(count) for part in _parts(element, (*path, index))]


def output_of(input_: Variable, outputs: Sequence[Variable]) -> Variable | None:
    """The output of the vertex shader that a fragment shader's input receives."""
    for output in outputs:
        matches = output.name == input_.name if input_.location < 0 else output.location == input_.location
        if matches and (output.location < 0) == (input_.location < 0):
            return output
    return None


def interpolated_alike(vertex: Module, fragment: Module) -> Module:
    """The vertex shader with the interpolation of the fragment shader, which decides on it in GLSL 4.40."""
    words = {}
    outputs = varyings(vertex, "vertex")
    for input_ in varyings(fragment, "fragment"):
        output = output_of(input_, outputs)
        if output is not None:
            words[output.name] = input_.interpolation
    variables = [
        variable._replace(interpolation=words.get(variable.name, variable.interpolation))
        for variable in vertex.variables
    ]
    return vertex._replace(variables=tuple(variables))


def mismatches(vertex: Module, fragment: Module) -> list[Unsupported]:
    """Where the inputs that a fragment shader reads are not the outputs of the vertex shader, with their places."""
    outputs = varyings(vertex, "vertex")
    read = set[str]().union(*map(globals_of, fragment.functions))
    wrong = list[Unsupported]()
    for input_ in varyings(fragment, "fragment"):
        output = output_of(input_, outputs)
        if output is None and input_.name in read:
            file = next((function.span.file for function in reversed(vertex.functions)), "")
            message = f"the vertex shader {file} does not write '{input_.name}', which the fragment shader reads"
            hint = did_you_mean(input_.name, [variable.name for variable in outputs])
            hint = hint or f"declare '{input_.name}' as an output of the vertex shader, and write it there"
            wrong.append(Unsupported(message, input_.span, hint=hint))
        elif output is not None:
            written, expected = contrast(output.type, input_.type)
            if written == expected:
                continue
            message = f"the vertex shader writes '{input_.name}' as {written} ({place(output.span)})"
            message += f", but the fragment shader reads {expected}"
            wrong.append(Unsupported(message, input_.span, hint="declare it with one type in both stages"))
    return wrong


def contrast(there: Type, here: Type) -> tuple[str, str]:
    """The types of a variable in both stages, in words that differ where the types do.

    A struct is one of its members: its name may be missing, and numbers may make it unique.
    """
    if _shape(there) == _shape(here):
        return spell(here), spell(here)
    words = [_with_members(type_, is_deep=False) for type_ in (there, here)]
    if words[0] == words[1]:  # a struct inside differs
        words = [_with_members(type_, is_deep=True) for type_ in (there, here)]
    return with_article(words[0]), with_article(words[1])


def _with_members(type_: Type, is_deep: bool) -> str:
    """A type in words: a struct, or that of an array, is its members; `is_deep`: so are those in it."""
    struct, _ = unnested(type_)
    if not isinstance(struct, Struct):
        return spell(type_)
    words = [_with_members(field.type, True) if is_deep else spell(field.type) for field in struct.fields]
    members = "; ".join([f"{word} {field.name}" for word, field in zip(words, struct.fields, strict=True)])
    return f"struct {{ {members}; }}"


def _shape(type_: Type) -> object:
    """A type without the names of structs."""
    if isinstance(type_, Array):
        return type_.length, _shape(type_.element)
    if isinstance(type_, Struct):
        return tuple([(field.name, _shape(field.type)) for field in type_.fields])
    return type_


def place(span: Span) -> str:
    """A place in the other stage, in a message."""
    return f"{span.file}:{span.line}:{span.column}"
