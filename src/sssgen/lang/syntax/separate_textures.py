"""Textures and samplers that Vulkan's GLSL declares apart, as one: `texture(sampler2D(t, s), uv)` is `texture(t, uv)`.

A texture of the IR has its sampler, which its user sets with it. So samplers are left out: their declarations, and the
parameters and arguments of functions. A texture that is read with two samplers would need both, and is an error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

from sssgen.ir.spans import Span
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import Reporter

_DIMS = ("1D", "2D", "3D", "Cube", "1DArray", "2DArray", "CubeArray")
_JOINED = {f"{kind}texture{dim}": f"{kind}sampler{dim}" for kind in ("", "i", "u") for dim in _DIMS}
_SHADOWS = {f"sampler{dim}Shadow" for dim in ("1D", "2D", "Cube", "1DArray", "2DArray")}
_SAMPLERS = ("sampler", "samplerShadow")


def join_textures(file: s.File, reporter: Reporter) -> s.File:
    """The same file where it has no such declarations. Reports a texture with two samplers."""
    types = {
        declarator.name.text: external.declaration.type.name
        for external in file.externals
        if isinstance(external, s.GlobalSyntax) and "uniform" in external.declaration.qualifiers.keywords
        for declarator in external.declaration.declarators
    }
    textures = {name for name, type_ in types.items() if type_ in _JOINED}
    samplers = {name for name, type_ in types.items() if type_ in _SAMPLERS}
    if not textures and not samplers:
        return file
    joiner = _Joiner(textures, samplers, reporter)
    joiner.find_uses(file.externals)
    externals = [joined for external in file.externals if (joined := joiner.external(external)) is not None]
    return replace(file, externals=tuple(externals))


class _Joiner:
    """Joins the textures and samplers of these names."""

    def __init__(self, textures: set[str], samplers: set[str], reporter: Reporter) -> None:
        self.textures, self.samplers = textures, samplers
        self.reporter = reporter
        self.shadows: set[str] = set()
        """The textures that are read with a comparison."""
        self.sampler_of: dict[str, str] = {}
        self.compared: dict[tuple[str, int], set[int]] = {}
        """The name and number of parameters of a function → the parameters that are textures with a comparison."""

    def find_uses(self, externals: tuple[s.External, ...]) -> None:
        """Finds what each texture is read with. A function is declared before its calls."""
        for external in externals:
            if isinstance(external, s.FunctionSyntax):
                names = [param.name.text if param.name else "" for param in external.params]
                shadows = self.find_in(external, names)
                own = {index for index, name in enumerate(names) if name and name in shadows}
                self.compared.setdefault((external.name.text, len(names)), set()).update(own)
                self.shadows |= shadows & self.textures - {*names}

    def find_in(self, function: s.FunctionSyntax, params: list[str]) -> set[str]:
        """The textures and parameters that a function reads with a comparison."""
        shadows: set[str] = set()
        for call in _calls(function.body):
            if isinstance(call.callee, s.TypeName):
                compared = {0} if call.callee.name in _SHADOWS else set()
            else:
                name = call.callee.text if isinstance(call.callee, s.Name) else ""
                compared = self.compared.get((name, len(call.args)), set())
            texture = ""
            for index, arg in enumerate(call.args):
                name = _root(arg)
                if index in compared:
                    shadows.add(name)
                if name in self.textures and name not in params:
                    texture = name
                elif name in self.samplers and name not in params and texture:
                    self.pair(texture, name, call.span)
        return shadows

    def pair(self, texture: str, sampler: str, span: Span) -> None:
        first = self.sampler_of.setdefault(texture, sampler)
        if first != sampler:
            message = f"the texture '{texture}' is read with the samplers '{first}' and '{sampler}'"
            self.reporter.error(span, message, "a texture has one sampler here: declare it twice, with other names")

    def external(self, external: s.External) -> s.External | None:
        """A declaration with joined types; None for a sampler's."""
        if isinstance(external, s.GlobalSyntax):
            declaration = external.declaration
            if declaration.type.name in _SAMPLERS and "uniform" in declaration.qualifiers.keywords:
                return None
            shadows = {declarator.name.text for declarator in declaration.declarators} & self.shadows
            if shadows and declaration.type.name in _JOINED:
                return replace(external, declaration=replace(declaration, type=_shadow(declaration.type)))
        if isinstance(external, s.FunctionSyntax):
            own = {parameter.name.text for parameter in external.params if _is_sampler(parameter) and parameter.name}
            compared = self.compared.get((external.name.text, len(external.params)), set())
            typed = [
                replace(parameter, type=_shadow(parameter.type)) if index in compared else parameter
                for index, parameter in enumerate(external.params)
            ]
            params = [self.joined(parameter) for parameter in typed if not _is_sampler(parameter)]
            outer, self.samplers = self.samplers, self.samplers | own
            body = self.joined(external.body)
            self.samplers = outer
            return replace(external, params=tuple(params), body=body)
        joined: s.External = self.joined(external)
        return joined

    def joined(self, node: Any) -> Any:
        """A part of the tree without samplers."""
        if type(node) is tuple:  # no place in the source
            return tuple([self.joined(part) for part in node])
        if isinstance(node, s.TypeName) and node.name in _JOINED:
            return replace(node, name=_JOINED[node.name])
        if isinstance(node, s.CallOf):
            args = tuple([self.joined(arg) for arg in node.args if _root(arg) not in self.samplers])
            is_pair = isinstance(node.callee, s.TypeName) and "sampler" in node.callee.name and len(args) == 1
            return args[0] if is_pair else replace(node, args=args)
        if is_dataclass(node) and not isinstance(node, type):
            parts = {field.name: getattr(node, field.name) for field in fields(node)}
            changed = {name: new for name, part in parts.items() if (new := self.joined(part)) is not part}
            return replace(node, **changed) if changed else node
        return node


def _shadow(type_: s.TypeName) -> s.TypeName:
    """The type of a texture with a comparison."""
    return replace(type_, name=f"{_JOINED[type_.name]}Shadow") if type_.name in _JOINED else type_


def _is_sampler(parameter: s.Parameter) -> bool:
    return parameter.type.name in _SAMPLERS


def _root(expression: s.Expression) -> str:
    """The name of a variable, or of the array that an element is of; '' for anything else."""
    while isinstance(expression, s.IndexOf):
        expression = expression.value
    return expression.text if isinstance(expression, s.Name) else ""


def _calls(node: object) -> Iterator[s.CallOf]:
    """The calls in a part of the tree."""
    if type(node) is tuple:
        for part in node:
            yield from _calls(part)
    elif is_dataclass(node) and not isinstance(node, type):
        if isinstance(node, s.CallOf):
            yield node
        for field in fields(node):
            yield from _calls(getattr(node, field.name))
