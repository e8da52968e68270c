"""A function of plain GLSL as the file of a technique, with a doc comment to edit."""

from __future__ import annotations

from itertools import dropwhile

from sssgen.ir.nodes import Function, Module, Uniform
from sssgen.ir.types import FLOAT, VEC2, VEC3, Array, Matrix, Sampler, Struct, Type, components, kind_of, spell
from sssgen.lang.check.quantities import QUANTITIES
from sssgen.lang.loader import load_text
from sssgen.material.library import ROLES
from sssgen.pipeline.programs import make_library
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets import registry

_LANGUAGE = "glsl-es-300"
"""The target whose text is the language of techniques, but for uniforms."""

_ROLES: dict[Type, str] = {VEC2: "coordinates", FLOAT: "thickness", VEC3: "translucency"}
"""The likely role of a function, by its result type."""


def technique_file(module: Module, label: str, wanted: str = "") -> tuple[str, str]:
    """The name of the technique and the text of its file.

    `wanted` is the function's name; '' means the last one of the file `label`. Raises SssgenError where there is none,
    and where a technique cannot have the function: its loops must be provably bounded, and it cannot use module
    variables.
    """
    function = _select_function(module, label, wanted)
    program = make_library(module, registry.load(_LANGUAGE)._replace(parameters=()), "none", [function.key], keep=True)
    if program.module.variables:
        name = program.module.variables[0].name
        hint = "pass it to the function as a parameter"
        raise failure(f"'{name}' is a module variable, which a technique cannot have", hint, label)
    name = program.module.functions[-1].name  # its callees come first; GLSL may reserve its original name
    parts = {kind: [[line.text for line in block] for block in blocks] for kind, blocks in program.parts.items()}
    own = "\n".join(dropwhile(lambda line: line.startswith("//"), parts["functions"].pop()))
    blocks = ["\n".join(block) for kind in ("types", "constants") for block in parts[kind]]
    blocks += map(_uniform, program.module.uniforms)
    blocks += ["\n".join(block) for block in parts["functions"]]
    text = "\n\n".join([*filter(None, blocks), _doc(function) + own]) + "\n"
    load_text(text, f"{name}.sss")  # raises SssgenError for what a technique cannot do
    return name, text


def _select_function(module: Module, label: str, wanted: str) -> Function:
    functions = [
        function
        for function in module.functions
        if function.body is not None and function.span.file == label and function.name != "main"
    ]
    if wanted:
        functions = [function for function in functions if function.name == wanted]
    if not functions:
        names = [function.name for function in module.functions]
        message = f"there is no function '{wanted}' in this file" if wanted else "there is no function in this file"
        raise failure(message, did_you_mean(wanted, names), label)
    return functions[-1]


def _uniform(uniform: Uniform) -> str:
    """A uniform's declaration with the hints that its type allows."""
    type_ = uniform.type
    doc = f"/// {uniform.doc.splitlines()[0]}" if uniform.doc else "/// Its meaning."
    if isinstance(type_, Sampler):
        return f"{doc}\nuniform {spell(type_)} {uniform.name} : default_white;"
    if isinstance(type_, Array | Struct):
        return f"{doc}\nuniform {spell(type_)} {uniform.name};"
    numbers = [
        f"{int(number)}" if kind_of(type_) in ("int", "uint") else repr(float(number)) for number in uniform.default
    ]
    value = numbers[0] if components(type_) == 1 else f"{spell(type_)}({', '.join(numbers)})"
    if kind_of(type_) == "bool":
        return f"{doc}\nuniform {spell(type_)} {uniform.name};"
    low, high = min(0.0, *uniform.default), max(1.0, *uniform.default)
    ranged = f" : hint_range({low!r}, {high!r})" if kind_of(type_) == "float" and not isinstance(type_, Matrix) else ""
    return f"{doc}\nuniform {spell(type_)} {uniform.name}{ranged} = {value};"


def _doc(function: Function) -> str:
    """The doc comment to complete, after comments with the possible quantities of each parameter."""
    doc = function.doc.strip().splitlines()
    role = _ROLES.get(function.result, "surface")
    lines = [doc[0] if doc else "The result, in one sentence.", f"role: {role}"]
    lines += ["formula: ", "source: ", "units: ", "limits: "]
    text = "/**\n" + "".join(f" * {line}".rstrip() + "\n" for line in lines) + " */\n"
    notes = [f"// role: one of {', '.join(ROLES)}"]
    for name, type_ in [("the result", function.result), *((param.name, param.type) for param in function.params)]:
        quantities = [quantity for quantity, plain in QUANTITIES.items() if plain == type_]
        if quantities:
            notes.append(f"// {name}: {spell(type_)}, or if it measures that: {', '.join(quantities)}")
    return "\n".join(notes) + "\n" + text
