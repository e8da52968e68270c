"""Joins the two stages of a program, as a linker of OpenGL does, and finds where they disagree.

What the other stage does not need is left out: attributes and inputs that are never read, outputs that no input
receives. A uniform is one variable of the program, so where uniforms are in a block, both stages declare the same ones
in the same order: a block then has one layout, and a texture one binding.
Place: after the functions that main() does not call are gone, before names are changed for a target.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import zip_longest

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Call, Expr, Function, Global, Intrinsic, Local, Module, Uniform
from sssgen.ir.types import Sampler, uniform_locations
from sssgen.ir.walk import all_expressions, calls_of, subexpressions
from sssgen.passes.scopes import Renamer, claim, declared, globals_of, names_of
from sssgen.passes.stage.varyings import contrast, mismatches, output_of, place, varyings
from sssgen.passes.unsupported import Unsupported


def disagreements(vertex: Module, fragment: Module) -> list[Unsupported]:
    """Where the stages cannot be one program: values between them, and uniforms of one name but two types.

    Their places are in the fragment shader.
    """
    uniforms = {uniform.source: uniform for uniform in vertex.uniforms}
    wrong = mismatches(vertex, fragment)
    for uniform in fragment.uniforms:
        other = uniforms.get(uniform.source)
        if other is None or (uniform.block and uniform.block == other.block):
            continue
        there, here = contrast(other.type, uniform.type)
        if other.block != uniform.block:
            there, here = [
                f"a member of the block '{each.block}'" if each.block else "outside of blocks"
                for each in (other, uniform)
            ]
        if there != here:
            message = f"the uniform '{uniform.source}' is {there} in {place(other.span)}, but {here} here"
            wrong.append(Unsupported(message, uniform.span, hint="it is one variable of the program: declare it alike"))
        elif uniform.precision != other.precision and uniform.precision and other.precision:
            message = f"the uniform '{uniform.source}' is {other.precision} in {place(other.span)}, "
            message += f"but {uniform.precision} here"
            wrong.append(Unsupported(message, uniform.span, hint="write the same precision in both stages"))
    return wrong


def unlike_blocks(vertex: Module, fragment: Module) -> Iterator[Unsupported]:
    """The blocks of one name with other members: they are one buffer of the program.

    The modules are those of the source, with the members that nothing reads.
    """
    for block in dict.fromkeys(uniform.block for uniform in fragment.uniforms if uniform.block):
        mine, theirs = [
            [uniform for uniform in module.uniforms if uniform.block == block] for module in (fragment, vertex)
        ]
        if theirs and (theirs[0].layout or "shared") != (mine[0].layout or "shared"):
            message = f"the block '{block}' is {mine[0].layout or 'shared'}, but {theirs[0].layout or 'shared'} in the "
            message += f"vertex shader ({place(theirs[0].span)})"
            yield Unsupported(message, mine[0].span, hint="write layout(std140) in both stages")
        for here, there in zip_longest(mine, theirs) if theirs else ():
            if here and there and (_name(here), here.row_major) == (_name(there), there.row_major):
                first, second = contrast(there.type, here.type)
                if first == second:
                    continue
            span = (here or mine[-1]).span
            what = f"has '{_name(there)}' here" if there else "ends before this member"
            message = f"the block '{block}' differs from that of the vertex shader, which {what}"
            message += f" ({place((there or theirs[-1]).span)})"
            yield Unsupported(message, span, hint="declare the same members in the same order in both stages")
            break


def unlike_orders(vertex: Module, fragment: Module) -> Iterator[Unsupported]:
    """The blocks of outputs that are blocks of inputs with their members in another order."""
    for block in dict.fromkeys(variable.block for variable in varyings(fragment, "fragment") if variable.block):
        mine, theirs = [
            [variable for variable in varyings(module, kind) if variable.block == block]
            for module, kind in ((fragment, "fragment"), (vertex, "vertex"))
        ]
        names = [[variable.name for variable in members] for members in (mine, theirs)]
        if theirs and names[0] != names[1] and sorted(names[0]) == sorted(names[1]):
            message = f"the members of the block '{block}' are in another order in the vertex shader "
            message += f"({place(theirs[0].span)})"
            yield Unsupported(message, mine[0].span, hint="declare them in one order in both stages")


def unlike_locations(vertex: Module, fragment: Module) -> Iterator[Unsupported]:
    """The uniforms of both stages that take each other's locations, and those with two locations."""
    placed = [
        [(uniform, _locations(uniform)) for uniform in module.uniforms if uniform.location >= 0]
        for module in (fragment, vertex)
    ]
    for here, mine in placed[0]:
        for there, theirs in placed[1]:
            overlap = mine.start < theirs.stop and theirs.start < mine.stop
            if here.source == there.source and mine.start != theirs.start:
                message = f"'{here.source}' is at the location {mine.start}, but at {theirs.start} in the vertex shader"
            elif here.source != there.source and overlap:
                message = f"'{here.source}' takes a location of '{there.source}' of the vertex shader"
            else:
                continue
            hint = "a uniform has one location, and each uniform its own"
            yield Unsupported(f"{message} ({place(there.span)})", here.span, hint=hint)


def _locations(uniform: Uniform) -> range:
    return range(uniform.location, uniform.location + uniform_locations(uniform.type))


def _name(member: Uniform) -> str:
    """The name of a member of a block, without that of the block."""
    return member.source.rpartition(".")[2]


def link_program(vertex: Module, fragment: Module) -> tuple[Module, Module]:
    """Both stages without inputs that are not read; outputs that are not received are private variables."""
    fragment = _without_unread_inputs(fragment)
    outputs = varyings(vertex, "vertex")
    received = {output_of(input_, outputs) for input_ in varyings(fragment, "fragment")}
    variables = [
        variable._replace(storage="private", location=-1, interpolation="")
        if variable in outputs and variable not in received
        else variable
        for variable in vertex.variables
    ]
    return _without_unread_inputs(vertex._replace(variables=tuple(variables))), fragment


def with_common_names(vertex: Module, fragment: Module) -> tuple[Module, Module]:
    """Both stages with one name for each output and the input that receives it, for languages without locations."""
    outputs = varyings(vertex, "vertex")
    taken = {name for module in (vertex, fragment) for name in names_of(module)}
    taken |= {name for module in (vertex, fragment) for function in module.functions for name in declared(function)}
    written, read = dict[str, str](), dict[str, str]()
    for input_ in varyings(fragment, "fragment"):
        output = output_of(input_, outputs)
        if output is not None and output.name != input_.name:
            written[output.name] = read[input_.name] = claim(output.name, taken)
    return _with_names(vertex, written), _with_names(fragment, read)


def _with_names(module: Module, names: Mapping[str, str]) -> Module:
    """The module with other names for some of its variables."""
    if not names:
        return module
    variables = [variable._replace(name=names.get(variable.name, variable.name)) for variable in module.variables]
    functions = [Renamer(names, {}).function(function) for function in module.functions]
    return module._replace(variables=tuple(variables), functions=tuple(functions))


def _without_unread_inputs(module: Module) -> Module:
    names = set[str]().union(*map(globals_of, module.functions))
    values = [variable.value for variable in module.variables if variable.value is not None]
    names |= {node.name for value in values for node in subexpressions(value) if isinstance(node, Global)}
    variables = [variable for variable in module.variables if variable.storage != "in" or variable.name in names]
    return module._replace(variables=tuple(variables))


def with_shared_uniforms(vertex: Module, fragment: Module) -> tuple[Module, Module]:
    """Both stages with the uniforms of both: first those of the vertex shader.

    A name of the other stage that this stage has for something else is changed here, where nothing reads it.
    """
    names = list(dict.fromkeys(uniform.source for uniform in (*vertex.uniforms, *fragment.uniforms)))
    return _with_uniforms(vertex, names, fragment), _with_uniforms(fragment, names, vertex)


def _with_uniforms(module: Module, names: list[str], other: Module) -> Module:
    mine = {uniform.source: uniform for uniform in module.uniforms}
    theirs = {uniform.source: uniform for uniform in other.uniforms}
    taken, uniforms = names_of(module), list[Uniform]()
    for name in names:
        uniform = mine.get(name)
        if uniform is None:
            uniform = theirs[name]._replace(name=claim(theirs[name].name, taken))
        uniforms.append(uniform)
    return module._replace(uniforms=tuple(uniforms))


def passed_textures(module: Module) -> set[str]:
    """The names of the textures that are given to functions: in most languages, each is given with its sampler."""
    calls = [call for function in module.functions for call in calls_of(function.body or ())]
    arguments = [argument for call in calls for argument in call.args]
    return {each.name for each in arguments if isinstance(each, Global) and isinstance(each.type, Sampler)}


def sampled_textures(module: Module) -> set[str]:
    """The names of the textures that are read with a sampler; the others are read texel by texel, or only measured."""
    functions = {function.key: function for function in module.functions}
    sampled = set[tuple[str, str]]()  # a function and one of its parameters; '' and a uniform
    while True:
        before = len(sampled)
        for function in module.functions:
            for node in all_expressions(function.body or ()):
                names = _samples_of(node, functions, sampled)
                sampled.update((function.key if is_parameter else "", name) for name, is_parameter in names)
        if len(sampled) == before:
            return {name for key, name in sampled if not key}


def _samples_of(node: Expr, functions: dict[str, Function], sampled: set[tuple[str, str]]) -> list[tuple[str, bool]]:
    """The textures that an expression itself samples: their names, and whether each is a parameter."""
    textures = list[Expr]()
    if isinstance(node, Intrinsic) and not (BUILTINS[node.name].size_query or BUILTINS[node.name].by_texel):
        textures = list(node.args)
    elif isinstance(node, Call):
        params = functions[node.function].params if node.function in functions else ()
        textures = [
            arg for arg, param in zip(node.args, params, strict=False) if (node.function, param.name) in sampled
        ]
    return [
        (texture.name, isinstance(texture, Local))
        for texture in textures
        if isinstance(texture.type, Sampler) and isinstance(texture, Global | Local)
    ]
