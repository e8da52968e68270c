"""The builtin functions of GLSL ES, as the prototypes of the OpenGL reference pages list them: a program for each.

A page has prototypes with generic types (`genType`, `gsampler2D`), which stand for several functions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from qualification.suites.text_cases import TextCase

VERSIONS = {"es3.0": "300 es", "es3.1": "310 es"}
"""Folder → version."""
_SCALARS = {"genType": ("float", "vec"), "genIType": ("int", "ivec"), "genUType": ("uint", "uvec"),
            "genBType": ("bool", "bvec")}  # fmt: skip
_MATRICES = ("mat2", "mat2x3", "mat2x4", "mat3x2", "mat3", "mat3x4", "mat4x2", "mat4x3", "mat4")
_COMPUTE = re.compile(r"atomic|image|.*[bB]arrier")
"""Functions that run in a compute shader: a fragment shader need not have them."""
_FORMATS = {"": "rgba32f", "i": "rgba32i", "u": "rgba32ui"}
"""Of images, by the prefix of their types."""
_CONSTANT = ("offset", "comp")
"""Parameters of texture functions that have to be constants."""


class Parameter(NamedTuple):
    """A parameter of a prototype."""

    type: str
    name: str
    qualifier: str = ""
    optional: bool = False


class Prototype(NamedTuple):
    """A function of a page; its types may be generic."""

    result: str
    name: str
    parameters: tuple[Parameter, ...]

    def overloads(self) -> Iterator[Prototype]:
        """The functions that it stands for."""
        count = 2 if any(parameter.optional for parameter in self.parameters) else 1
        width = max(len(self._kinds(parameter.type)) for parameter in (Parameter(self.result, ""), *self.parameters))
        for kind, missing in product(range(width), range(count)):
            parameters = [each for each in self.parameters if not (each.optional and missing)]
            yield Prototype(
                self._of(self.result, kind),
                self.name,
                tuple(each._replace(type=self._of(each.type, kind)) for each in parameters),
            )

    def _of(self, type_: str, kind: int) -> str:
        kinds = self._kinds(type_)
        return kinds[kind] if len(kinds) > 1 else kinds[0]

    def _kinds(self, type_: str) -> tuple[str, ...]:
        """The types that a type stands for: those of one prototype go together."""
        if type_ in _SCALARS:
            scalar, vector = _SCALARS[type_]
            return (scalar, *(f"{vector}{size}" for size in (2, 3, 4)))
        if type_ in ("vec", "ivec", "uvec", "bvec"):
            return tuple(f"{type_}{size}" for size in (2, 3, 4))
        if type_ == "mat":
            return _MATRICES
        if re.match(r"g(vec4|sampler|image)", type_):
            return tuple(f"{prefix}{type_[1:]}" for prefix in ("", "i", "u"))
        return (type_,)


def cases(root: Path) -> Iterator[TextCase]:
    """The functions of the pages in a folder. Those that a version shares with an earlier one are cases of that one."""
    earlier: set[Prototype] = set()
    for folder, version in VERSIONS.items():
        own = {
            overload: None
            for path in sorted((root / folder).glob("*.xml"))
            for prototype in prototypes(path.read_text("utf-8"))
            for overload in prototype.overloads()
        }
        for number, overload in enumerate(overload for overload in own if overload not in earlier):
            stage = "comp" if _COMPUTE.match(overload.name) else "frag"
            name = f"reference-pages/{folder}/{overload.name}-{number}"
            yield TextCase(name, f"{overload.name}.{stage}", program(overload, version), judged=True)
        earlier |= set(own)


def prototypes(page: str) -> Iterator[Prototype]:
    """The functions of GLSL on a page: those of the API, which begin with gl, are none."""
    entities = re.sub(r"<!DOCTYPE.*?\]\s*>", "", page, count=1, flags=re.DOTALL)
    tree = ElementTree.fromstring(re.sub(r"&(?!#|amp;|lt;|gt;|quot;|apos;)\w+;", " ", entities))
    for element in tree.findall(".//{*}funcprototype"):
        definition = element.find("{*}funcdef")
        if definition is None:
            continue
        result, name = " ".join(definition.itertext()).split()[-2:]
        if not name.startswith("gl"):
            texts = [" ".join("".join(each.itertext()).split()) for each in element.findall("{*}paramdef")]
            yield Prototype(result, name, tuple(_parameter(text) for text in texts if text != "void"))


def _parameter(text: str) -> Parameter:
    """A parameter as a page has it: `[float bias]`, `out genType i`."""
    *qualifier, type_, name = text.strip("[]").split()
    return Parameter(type_, name, " ".join(qualifier), text.startswith("["))


def program(function: Prototype, version: str) -> str:
    """A shader that calls a function with uniforms and uses all that it writes."""
    is_compute = bool(_COMPUTE.match(function.name))
    globals_, locals_, arguments, results = list[str](), list[str](), list[str](), list[str]()
    for number, parameter in enumerate(function.parameters):
        argument = f"a{number}"
        if parameter.name in _CONSTANT and "sampler" in function.parameters[0].type:
            argument = f"{parameter.type}(1)"
        elif parameter.qualifier == "out":
            locals_.append(f"    {parameter.type} {argument};")
            results.append(_number(parameter.type, argument))
        elif parameter.qualifier == "inout":
            globals_.append(f"shared {parameter.type} {argument};")
        elif "image" in parameter.type:
            access = "writeonly" if function.name == "imageStore" else "readonly"
            format_ = _FORMATS[parameter.type.partition("image")[0]]
            globals_.append(f"layout({format_}, binding = 0) uniform {access} highp {parameter.type} {argument};")
        elif parameter.type == "atomic_uint":
            globals_.append(f"layout(binding = 0) uniform atomic_uint {argument};")
        else:
            precision = "highp " if "sampler" in parameter.type else ""
            globals_.append(f"uniform {precision}{parameter.type} {argument};")
        arguments.append(argument)
    call = f"{function.name}({', '.join(arguments)})"
    if function.result != "void":
        locals_.append(f"    {function.result} result = {call};")
        results.append(_number(function.result, "result"))
    else:
        locals_.append(f"    {call};")
    total = " + ".join(results) or "1.0"
    if is_compute:
        globals_.append("layout(local_size_x = 1) in;\nlayout(std430, binding = 1) buffer Results { float number; };")
        locals_.append(f"    number = {total};")
    else:
        globals_.append("out vec4 color;")
        locals_.append(f"    color = vec4({total});")
    lines = [
        f"#version {version}", "precision highp float;", "precision highp int;", *globals_,
        "void main() {", *locals_, "}", "",
    ]  # fmt: skip
    return "\n".join(lines)


def _number(type_: str, name: str) -> str:
    """A float of the first component of a value."""
    if "mat" in type_:
        return f"{name}[0][0]"
    return f"float({name}.x)" if "vec" in type_ else f"float({name})"
