"""Joins the storage buffers and images of the two stages of a program: they are one memory of the program.

A buffer of both stages is one buffer if its block has one name, an image if the variable has one name. Each gets a
binding, and its number among those of the program, for targets that number them.
Place: behind `link_program`, so that what no function uses does not count.
"""

from __future__ import annotations

from collections.abc import Iterator

from sssgen.ir.nodes import Module, Variable
from sssgen.ir.types import Struct, spell
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.scopes import globals_of
from sssgen.passes.stage.storage_images import used_access
from sssgen.passes.stage.storage_layout import with_free_bindings
from sssgen.passes.stage.varyings import contrast, place
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects

MEMORY = ("buffer", "image")
"""The kinds of storage, in the order of the numbers."""


def memory_key(variable: Variable) -> tuple[str, str]:
    """What is equal for the memory of both stages: its storage, and the name by which a program binds it."""
    return variable.storage, spell(variable.type) if variable.storage == "buffer" else variable.name


def without_unused_memory(module: Module) -> Module:
    """The module without storage buffers and images that no function mentions."""
    names = set[str]().union(*map(globals_of, module.functions))
    variables = [each for each in module.variables if each.storage not in MEMORY or each.name in names]
    return module._replace(variables=tuple(variables))


def unlike_memory(vertex: Module, fragment: Module) -> Iterator[Unsupported]:
    """The buffers and images of one name that differ; their places are in the fragment shader."""
    theirs = {memory_key(variable): variable for variable in _memory(vertex)}
    yield from _shared_names(vertex, fragment)
    for here in _memory(fragment):
        there = theirs.get(memory_key(here))
        if there is None:
            continue
        kind, name = memory_key(here)
        words = contrast(there.type, here.type)
        if words[0] == words[1]:
            words = there.layout or "without a format", here.layout or "without a format"
        if words[0] == words[1]:
            words = _instance(there), _instance(here)
        if words[0] == words[1] and -1 not in (there.location, here.location):
            words = f"binding = {there.location}", f"binding = {here.location}"
        if words[0] != words[1]:
            what = "storage buffer" if kind == "buffer" else "image"
            message = f"the {what} '{name}' is {words[0]} in {place(there.span)}, but {words[1]} here"
            yield Unsupported(message, here.span, hint="it is one memory of the program: declare it alike")


def _instance(variable: Variable) -> str:
    return f"{'without' if variable.block else 'with'} an instance name"


def _shared_names(vertex: Module, fragment: Module) -> Iterator[Unsupported]:
    """The members with one name of two buffers without instance names (GLSL 4.60, 4.3.9)."""
    members = {
        field.name: variable
        for variable in _memory(vertex)
        if variable.block and isinstance(variable.type, Struct)
        for field in variable.type.fields
    }
    for here in _memory(fragment):
        for field in here.type.fields if here.block and isinstance(here.type, Struct) else ():
            there = members.get(field.name, here)
            if memory_key(there) != memory_key(here):
                message = f"the storage buffer '{there.block}' has a '{field.name}', too, in {place(there.span)}"
                yield Unsupported(message, here.span, hint="give one of the buffers an instance name")


def with_shared_memory(vertex: Module, fragment: Module, capabilities: Capabilities) -> tuple[Module, Module]:
    """Both stages with one binding, number and access for each buffer and image.

    Raises Unsupported where a vertex shader reads what the fragment shader writes, if the target cannot. What a target
    lacks at all is reported later.
    """
    modules = (vertex, fragment)
    keys = dict.fromkeys(memory_key(variable) for module in modules for variable in _memory(module))
    ordered = sorted(keys, key=lambda key: MEMORY.index(key[0]))
    memory = [variable for module in modules for variable in _memory(module)]
    # buffers and images together, as some targets number them so
    bindings = with_free_bindings([(memory_key(variable), variable.location) for variable in memory])
    written = {memory_key(each) for module in modules for each in _memory(module) if _writes(module, each)}
    if not capabilities.vertex_buffer_writes:
        of_vertex = {memory_key(variable) for variable in _memory(vertex)}
        for variable in _memory(fragment):
            is_image = variable.storage == "image"
            exists = capabilities.storage_images if is_image else capabilities.storage_buffers
            if exists and memory_key(variable) in of_vertex & written:
                what = f"'{variable.name}' is used by the vertex shader, too, and one of both stages writes it"
                hint = "let the vertex shader read a buffer or image of its own, with the values of the last draw"
                raise Unsupported(what, variable.span, hint=hint)

    def shared(variable: Variable) -> Variable:
        if variable.storage not in MEMORY:
            return variable
        key = memory_key(variable)
        access = variable.access if key in written else "readonly"
        return variable._replace(location=bindings[key], order=ordered.index(key), access=access)

    first, second = [
        module._replace(variables=tuple([shared(variable) for variable in module.variables])) for module in modules
    ]
    return first, second


def _memory(module: Module) -> list[Variable]:
    return [variable for variable in module.variables if variable.storage in MEMORY]


def _writes(module: Module, variable: Variable) -> bool:
    if variable.storage == "image":
        return used_access(module)[variable.name] != "readonly"
    return any(variable.name in effect.writes for effect in effects(module).values())
