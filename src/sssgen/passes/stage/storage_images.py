"""What a target can have of images, and the access that a program needs.

WebGPU has fewer formats than OpenGL, reads and writes only those with one number of 32 bits, and has no atomics of
images.
"""

from __future__ import annotations

from sssgen.ir.image_formats import FORMATS
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.nodes import Global, Local, MemoryOperation, Module, Variable
from sssgen.ir.walk import statements
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.stage.atomic_places import passed_variables
from sssgen.passes.unsupported import Unsupported


def has_images(module: Module) -> bool:
    """Whether a module has images."""
    return any(variable.storage == "image" for variable in module.variables)


def used_access(module: Module) -> dict[str, str]:
    """Image → readonly, writeonly, or '' where a program both loads and stores; writeonly if it does neither."""
    loaded, stored = set[str](), set[str]()
    for function in module.functions:
        passed = passed_variables(function)
        for stmt in statements(function.body or ()):
            place = stmt.args[0] if isinstance(stmt, MemoryOperation) and stmt.args else None
            if not isinstance(stmt, MemoryOperation) or not isinstance(place, Global | Local):
                continue
            name = passed.get(place.name, place.name)
            loaded |= {name} if MEMORY[stmt.name].loads_texel else set()
            stored |= {name} if not MEMORY[stmt.name].reads_only else set()
    names = [variable.name for variable in module.variables if variable.storage == "image"]
    return {name: ("" if name in stored else "readonly") if name in loaded else "writeonly" for name in names}


def check_images(module: Module, form: str, capabilities: Capabilities) -> Module:
    """The module with the access that it needs of its images. Raises Unsupported for an image that the target lacks."""
    if not has_images(module):
        return module
    access = used_access(module)
    variables: list[Variable] = []
    for variable in module.variables:
        if variable.storage == "image":
            _check_image(variable, access[variable.name], form, capabilities)
            allowed = variable.access or access[variable.name]
            variable = variable._replace(access=allowed if capabilities.any_images else access[variable.name])
        variables.append(variable)
    if not capabilities.image_atomics:
        _check_atomics(module)
    return module._replace(variables=tuple(variables))


def _check_image(variable: Variable, access: str, form: str, capabilities: Capabilities) -> None:
    name, span = variable.name, variable.span
    if not capabilities.storage_images:
        raise Unsupported(f"'{name}' is an image, which this target lacks", span)
    if not capabilities.module_variables and form != "compute":
        message = f"'{name}' is an image, which this target has in compute shaders alone"
        raise Unsupported(message, span, hint="write it in a compute shader")
    if capabilities.any_images:
        return
    if not variable.layout:
        raise Unsupported(f"the image '{name}' needs a format here", span, hint="write layout(rgba8) before it")
    if not FORMATS[variable.layout].webgpu:
        hint = "write rgba8, rgba16f, rgba32f, rg32f or r32f, or an integer format of 32 bits or four numbers"
        raise Unsupported(f"images of this target have no format {variable.layout}", span, hint=hint)
    if form == "vertex" and access != "readonly":
        hint = "write it in a compute or fragment shader"
        raise Unsupported(f"a vertex shader of this target cannot write the image '{name}'", span, hint=hint)
    if not access and variable.layout not in ("r32f", "r32i", "r32ui"):
        hint = "read one image and write another, or write layout(r32f), layout(r32i) or layout(r32ui)"
        message = f"'{name}' is read and written, which this target can only with one number of 32 bits"
        raise Unsupported(message, span, hint=hint)


def _check_atomics(module: Module) -> None:
    for function in module.functions:
        for stmt in statements(function.body or ()):
            if isinstance(stmt, MemoryOperation) and MEMORY[stmt.name].is_image_atomic:
                hint = "work on a storage buffer of uint"
                raise Unsupported(f"this target has no {stmt.name}", stmt.span, hint=hint)
