"""Calls a function of plain GLSL on a back end, by its transpiled text.

    called("float f(float x) { return x + 1.0; }", "hlsl", np.float32([1.0, 2.0]))     # array([2., 3.])
    called("uniform float u; float f(float x) { return x + u; }", "gl", x, u)

The function is `f`. The values of the uniforms that it reads come after its arguments.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from sssgen.ir.nodes import Function, Module
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Call, Text

Array: TypeAlias = np.ndarray[Any, Any]

BACKENDS = ("numpy", "gl", "hlsl", "webgpu")


def module_of(text: str) -> Module:
    return load_glsl_text(text, "case.glsl").module


def function_of(module: Module, name: str) -> Function:
    return next(function for function in module.functions if function.name == name)


def called(text: str, backend: Backend, *args: Array) -> Array:
    """The result of `f`; lanes are last."""
    return called_all(text, backend, ("f",), *args)["f"]


def called_all(text: str, backend: Backend, names: tuple[str, ...], *args: Array) -> dict[str, Array]:
    """The results of functions that all take the same arguments, by their names."""
    module = module_of(text)
    keys = [function_of(module, name).key for name in names]
    if backend.target.name == "numpy" and module.variables:
        module = variables_to_parameters(module, keys[0])
    closed = uniforms_to_parameters(module)
    compiled = transpile(module, backend.target.name, "case", "none", keys, keep=True)
    text = "\n".join([text for name, text in compiled.files.items() if not name.endswith(".json")])
    renames = compiled.reflection["renames"]
    calls = []
    for name in names:
        types = tuple([param.type for param in function_of(closed, name).params])
        calls.append(Call(renames.get(name, name), types, function_of(module, name).result, args))
    return dict(zip(names, backend.run(Text(text), calls), strict=True))
