"""Probes: GLSL functions of numbers, vectors and matrices that call the functions of a shader's text.

A probe sets the module variables that a function reads, calls it with arguments assembled from its own parameters, and
returns one number, vector or matrix: of the result, of an `out` or `inout` parameter, or of a variable that the
function writes. Probes are appended to the author's text, so that the driver and our front end read the same text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import FLOAT, VOID, Array, Sampler, Struct, Type, spell, with_article
from sssgen.ir.walk import all_expressions
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.variable_effects import NONE, effects

MAX_INPUTS = 256
"""The largest number of inputs (numbers, vectors, matrices): drivers do not support many more."""
MAX_OUTPUTS = 64
TEXTURES = [
    Sampler("Cube"),
    Sampler("2D", shadow=True),
    *(
        Sampler(dim, kind, array)
        for kind in ("float", "int", "uint")
        for dim, array in (("2D", False), ("2D", True), ("3D", False))
    ),
]
"""The textures that back ends support as inputs."""


class Leaf(NamedTuple):
    """A number, vector, matrix or texture of an input."""

    name: str
    """The probe's parameter."""
    path: str
    """The part that it sets, such as `local_light.color` or `weights[2]`; '' for none."""
    type: Type
    author_name: str
    """The same for the author: without the prefix."""


class Probe(NamedTuple):
    """A function that returns one output."""

    name: str
    output: str
    """Such as `result`, `light.color`, `weights[2]`."""
    result: Type
    leaves: tuple[Leaf, ...]
    text: str


class FunctionProbes(NamedTuple):
    """The probes of one function, or why it has none."""

    function: Function
    probes: tuple[Probe, ...] = ()
    reason: str = ""


def probe_functions(module: Module, functions: list[Function], text: str) -> list[FunctionProbes]:
    """The probes of each function; every name that they declare begins with letters that are nowhere in the text."""
    prefix, count = "sssgen_", 2
    while prefix in text:
        prefix, count = f"sssgen{count}_", count + 1
    effect_of = effects(module)
    variables = {variable.name: variable.type for variable in module.variables}
    buffers = {variable.name for variable in module.variables if variable.storage in ("buffer", "image")}
    probes = []
    for number, function in enumerate(functions):
        effect = effect_of.get(function.key, NONE)
        read = {name: variables[name] for name in sorted(effect.reads)}
        written = {name: variables[name] for name in sorted(effect.writes)}
        if buffers & (read.keys() | written.keys()):
            reason = "it reads or writes storage buffers or images, which functions are not verified with"
            probes.append(FunctionProbes(function, reason=reason))
            continue
        if "sampler1D" in text and _reads_textures(module, function):
            reason = "it reads a texture, and the driver gets none of one dimension, which the text declares"
            probes.append(FunctionProbes(function, reason=reason))
            continue
        probes.append(_probe_function(function, prefix, f"{prefix}probe_{number}", read, written))
    return probes


def _reads_textures(module: Module, function: Function) -> bool:
    called = keep_reachable(module, [function.key]).functions
    return any(isinstance(each.type, Sampler) for part in called for each in all_expressions(part.body or ()))


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


def declaration(type_: Type, name: str) -> str:
    """A declaration in GLSL, with an array's lengths after the name."""
    lengths = ""
    while isinstance(type_, Array):
        lengths += f"[{type_.length}]"
        type_ = type_.element
    return f"{spell(type_)} {name}{lengths}"


def _probe_function(
    function: Function, prefix: str, name: str, read: Mapping[str, Type], written: Mapping[str, Type]
) -> FunctionProbes:
    local = {param.name: f"{prefix}of_{param.name}" for param in function.params}
    result = f"{prefix}result"
    arguments = [(local[param.name], param.type) for param in function.params if param.direction != "out"]
    inputs = [*read.items(), *arguments]
    outs = [param for param in function.params if param.direction != "in"]
    outputs = [] if function.result == VOID else [(result, "result", function.result)]
    outputs += [(local[param.name], param.name, param.type) for param in outs]
    outputs += [(variable, variable, type_) for variable, type_ in written.items()]
    if reason := _unfit([type_ for _, type_ in inputs], [type_ for *_, type_ in outputs]):
        return FunctionProbes(function, reason=reason)
    parts = [leaf for path, type_ in inputs for leaf in leaves(type_, path)]
    named = tuple(
        [
            Leaf(f"{prefix}{index}", path, type_, path.removeprefix(f"{prefix}of_"))
            for index, (path, type_) in enumerate(parts)
        ]
    )
    if not any(not isinstance(leaf.type, Sampler) for leaf in named):
        named += (
            Leaf(f"{prefix}lane", "", FLOAT, ""),
        )  # one number at least is needed: its shape gives the number of lanes
    head = ", ".join([f"{spell(leaf.type)} {leaf.name}" for leaf in named])
    body = _body(function, local, named, result)
    probes: list[Probe] = []
    for value, shown, output_type in outputs:
        for suffix, type_ in leaves(output_type):
            title = f"{name}_{len(probes)}"
            lines = [f"{spell(type_)} {title}({head}) {{", *body, f"    return {value}{suffix};", "}"]
            probes.append(Probe(title, f"{shown}{suffix}", type_, named, "\n".join(lines) + "\n"))
    return FunctionProbes(function, tuple(probes))


def _body(function: Function, local: Mapping[str, str], named: tuple[Leaf, ...], result: str) -> list[str]:
    """The statements before `return`: they put the function's result into the variable `result`."""
    textures = {leaf.path: leaf.name for leaf in named if isinstance(leaf.type, Sampler)}
    values = [param for param in function.params if not isinstance(param.type, Sampler)]
    lines = [f"    {declaration(param.type, local[param.name])};" for param in values]
    lines += [f"    {leaf.path} = {leaf.name};" for leaf in named if leaf.path and leaf.path not in textures]
    args = ", ".join([textures.get(path, path) for path in local.values()])
    target = "" if function.result == VOID else f"{declaration(function.result, result)} = "
    return [*lines, f"    {target}{function.name}({args});"]


def _unfit(inputs: list[Type], outputs: list[Type]) -> str:
    """Why a function with these inputs and outputs cannot be run; '' where it can."""
    if not outputs:
        return "it has no outputs"
    for type_ in inputs:
        for _, part in leaves(type_):
            if isinstance(part, Sampler) and (part is not type_ or part not in TEXTURES):
                return f"it takes {with_article(spell(part))}, which is not supported here"
    input_count, output_count = (sum([len(list(leaves(type_))) for type_ in types]) for types in (inputs, outputs))
    if input_count > MAX_INPUTS:
        return f"it takes {input_count} numbers, vectors and matrices; at most {MAX_INPUTS} are supported"
    if output_count > MAX_OUTPUTS:
        return f"it returns {output_count} numbers, vectors and matrices; at most {MAX_OUTPUTS} are supported"
    return ""
