"""Functions of plain numbers around the functions of a shader's own text, written in GLSL.

A probe sets the module variables that a function reads, calls it with arguments put together from numbers, and returns
one number, vector or matrix of what it gave: of its result, of an `out` or `inout` parameter, or of a variable that it
writes. As text behind the author's own, probes go through the driver and through our front end alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import FLOAT, VOID, Array, Sampler, Struct, Type, spell, with_article
from sssgen.passes.variable_effects import NONE, effects

MOST_INPUTS = 64
"""How many numbers, vectors and matrices a function may be given: drivers have no room for many more."""
MOST_OUTPUTS = 16
TEXTURES = [Sampler(dim) for dim in ("2D", "3D", "Cube")]
"""What back ends can be given."""


class Leaf(NamedTuple):
    """A number, vector, matrix or texture of an input."""

    name: str
    """The probe's parameter."""
    path: str
    """Where it goes, as in `local_light.color` or `weights[2]`; '' where that is nowhere."""
    type: Type


class Probe(NamedTuple):
    """A function that gives one thing."""

    name: str
    output: str
    """As `result`, `light.color`, `weights[2]`."""
    result: Type
    leaves: tuple[Leaf, ...]
    text: str


class Probed(NamedTuple):
    """The probes of one function, or why it has none."""

    function: Function
    probes: tuple[Probe, ...] = ()
    reason: str = ""


def probed(module: Module, functions: list[Function]) -> list[Probed]:
    """The probes of each function."""
    known = effects(module)
    variables = {variable.name: variable.type for variable in module.variables}
    found = []
    for number, function in enumerate(functions):
        effect = known.get(function.key, NONE)
        read = {name: variables[name] for name in sorted(effect.reads)}
        written = {name: variables[name] for name in sorted(effect.writes)}
        found.append(_probed(function, f"sssgen_probe_{number}", read, written))
    return found


def leaves(type_: Type, path: str = "") -> Iterator[tuple[str, Type]]:
    """(path, type) of each number, vector, matrix and texture in a value: `light.color`, `weights[2]`."""
    if isinstance(type_, Struct):
        for field in type_.fields:
            yield from leaves(field.type, f"{path}.{field.name}")
    elif isinstance(type_, Array):
        for index in range(type_.length):
            yield from leaves(type_.element, f"{path}[{index}]")
    else:
        yield path, type_


def declared(type_: Type, name: str) -> str:
    """A declaration as GLSL has it, an array's lengths behind the name."""
    lengths = ""
    while isinstance(type_, Array):
        lengths += f"[{type_.length}]"
        type_ = type_.element
    return f"{spell(type_)} {name}{lengths}"


def _probed(function: Function, name: str, read: Mapping[str, Type], written: Mapping[str, Type]) -> Probed:
    local = {param.name: f"local_{param.name}" for param in function.params}
    given = [(local[param.name], param.type) for param in function.params if param.direction != "out"]
    inputs = [*read.items(), *given]
    outs = [param for param in function.params if param.direction != "in"]
    ends = [] if function.result == VOID else [("returned", "result", function.result)]
    ends += [(local[param.name], param.name, param.type) for param in outs]
    ends += [(variable, variable, type_) for variable, type_ in written.items()]
    if reason := _unfit([type_ for _, type_ in inputs], [type_ for *_, type_ in ends]):
        return Probed(function, reason=reason)
    taken = [leaf for path, type_ in inputs for leaf in leaves(type_, path)]
    named = tuple([Leaf(f"given_{index}", path, type_) for index, (path, type_) in enumerate(taken)])
    if not any(not isinstance(leaf.type, Sampler) for leaf in named):
        named += (Leaf("given_lane", "", FLOAT),)  # there is one number at least: it tells how many lanes there are
    head = ", ".join([f"{spell(leaf.type)} {leaf.name}" for leaf in named])
    body = _body(function, local, named)
    probes: list[Probe] = []
    for value, shown, whole in ends:
        for suffix, type_ in leaves(whole):
            title = f"{name}_{len(probes)}"
            lines = [f"{spell(type_)} {title}({head}) {{", *body, f"    return {value}{suffix};", "}"]
            probes.append(Probe(title, f"{shown}{suffix}", type_, named, "\n".join(lines) + "\n"))
    return Probed(function, tuple(probes))


def _body(function: Function, local: Mapping[str, str], named: tuple[Leaf, ...]) -> list[str]:
    """The statements before the return: the function's result is `returned`."""
    textures = {leaf.path: leaf.name for leaf in named if isinstance(leaf.type, Sampler)}
    values = [param for param in function.params if not isinstance(param.type, Sampler)]
    lines = [f"    {declared(param.type, local[param.name])};" for param in values]
    lines += [f"    {leaf.path} = {leaf.name};" for leaf in named if leaf.path and leaf.path not in textures]
    args = ", ".join([textures.get(path, path) for path in local.values()])
    kept = "" if function.result == VOID else f"{declared(function.result, 'returned')} = "
    return [*lines, f"    {kept}{function.name}({args});"]


def _unfit(inputs: list[Type], outputs: list[Type]) -> str:
    """Why a function with these cannot be run; '' where it can."""
    if not outputs:
        return "it gives nothing"
    for type_ in inputs:
        for _, part in leaves(type_):
            if isinstance(part, Sampler) and (part is not type_ or part not in TEXTURES):
                return f"it takes {with_article(spell(part))}, which cannot be given"
    taken, given = (sum([len(list(leaves(type_))) for type_ in types]) for types in (inputs, outputs))
    if taken > MOST_INPUTS:
        return f"it takes {taken} numbers, vectors and matrices; at most {MOST_INPUTS} can be given"
    if given > MOST_OUTPUTS:
        return f"it gives {given} numbers, vectors and matrices; at most {MOST_OUTPUTS} are looked at"
    return ""
