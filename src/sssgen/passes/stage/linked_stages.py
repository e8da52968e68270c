"""Joins the two stages of a program, as a linker of OpenGL does, and finds where they disagree.

What the other stage does not need is left out: attributes and inputs that are never read, outputs that no input
receives. A uniform is one variable of the program, so where uniforms are in a block, both stages declare the same ones
in the same order: a block then has one layout, and a texture one binding.
Place: after the functions that main() does not call are gone, before names are changed for a target.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Call, Expr, Function, Global, Intrinsic, Local, Module, Span, Uniform
from sssgen.ir.types import Sampler, spell, with_article
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.passes.scopes import fresh
from sssgen.passes.stage.varyings import mismatches, output_of, varyings

Mismatch = tuple[str, Span]
"""A message and the place in the fragment shader."""


def disagreements(vertex: Module, fragment: Module) -> list[Mismatch]:
    """Where the stages cannot be one program: values between them, and uniforms of one name but two types."""
    uniforms = {uniform.name: uniform for uniform in vertex.uniforms}
    wrong = mismatches(vertex, fragment)
    for uniform in fragment.uniforms:
        other = uniforms.get(uniform.name)
        if other is not None and other.type != uniform.type:
            here, there = with_article(spell(uniform.type)), with_article(spell(other.type))
            place = f"{other.span.file}:{other.span.line}:{other.span.column}"
            wrong.append((f"the uniform '{uniform.name}' is {there} in {place}, but {here} here", uniform.span))
    return wrong


def linked(vertex: Module, fragment: Module) -> tuple[Module, Module]:
    """Both stages without inputs that are not read; outputs that are not received are private variables."""
    fragment = _without_unread_inputs(fragment)
    outputs = varyings(vertex, "vertex")
    received = {output_of(input_, outputs) for input_ in varyings(fragment, "fragment")}
    variables = tuple(
        [
            variable._replace(storage="private", location=-1, interpolation="")
            if variable in outputs and variable not in received
            else variable
            for variable in vertex.variables
        ]
    )
    return _without_unread_inputs(vertex._replace(variables=variables)), fragment


def _without_unread_inputs(module: Module) -> Module:
    names = _mentioned(module)
    variables = [variable for variable in module.variables if variable.storage != "in" or variable.name in names]
    return module._replace(variables=tuple(variables))


def _mentioned(module: Module) -> set[str]:
    """The names of the globals that the functions and the variables' values mention."""
    nodes = [node for function in module.functions for node in all_expressions(function.body or ())]
    nodes += [node for variable in module.variables if variable.value for node in subexpressions(variable.value)]
    return {node.name for node in nodes if isinstance(node, Global)}


def with_shared_uniforms(vertex: Module, fragment: Module) -> tuple[Module, Module]:
    """Both stages with the uniforms of both: first those of the vertex shader.

    A name of the other stage that this stage has for something else is changed here, where nothing reads it.
    """
    own = {uniform.name for uniform in vertex.uniforms}
    names = [uniform.name for uniform in vertex.uniforms]
    names += [uniform.name for uniform in fragment.uniforms if uniform.name not in own]
    return _declared(vertex, names, fragment), _declared(fragment, names, vertex)


def _declared(module: Module, names: list[str], other: Module) -> Module:
    mine = {uniform.name: uniform for uniform in module.uniforms}
    theirs = {uniform.name: uniform for uniform in other.uniforms}
    declared = (module.constants, module.uniforms, module.variables, module.functions)
    taken = {declaration.name for group in declared for declaration in group}
    uniforms = list[Uniform]()
    for name in names:
        uniform = mine.get(name)
        if uniform is None:
            free = fresh(name, taken)
            taken.add(free)
            uniform = theirs[name]._replace(name=free)
        uniforms.append(uniform)
    return module._replace(uniforms=tuple(uniforms))


def sampled_textures(module: Module) -> set[str]:
    """The names of the textures that are read with a sampler; the others are read texel by texel, or only measured."""
    functions = {function.key: function for function in module.functions}
    sampled = set[tuple[str, str]]()  # a function and one of its parameters; '' and a uniform
    while True:
        before = len(sampled)
        for function in module.functions:
            for node in all_expressions(function.body or ()):
                names = _sampled(node, functions, sampled)
                sampled.update((function.key if is_parameter else "", name) for name, is_parameter in names)
        if len(sampled) == before:
            return {name for key, name in sampled if not key}


def _sampled(node: Expr, functions: dict[str, Function], sampled: set[tuple[str, str]]) -> list[tuple[str, bool]]:
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
