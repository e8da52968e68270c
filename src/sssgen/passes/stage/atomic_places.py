"""Which memory holds atomics: WGSL has a type of its own for it, and reads and writes it by functions."""

from __future__ import annotations

from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.nodes import Expr, Global, Index, Member, MemoryOperation, Module
from sssgen.ir.types import Struct
from sssgen.ir.walk import statements
from sssgen.passes.unsupported import Unsupported


def memory_of(place: Expr) -> tuple[str, ...]:
    """A shared variable's name, or a storage buffer's struct and member; () for any other place."""
    while isinstance(place, Index):
        place = place.value
    if isinstance(place, Global):
        return (place.name,)
    if isinstance(place, Member) and isinstance(place.value, Global) and isinstance(place.value.type, Struct):
        return (place.value.type.name, place.field)
    return ()


def atomic_places(module: Module) -> frozenset[tuple[str, ...]]:
    """The memory on which atomics work. Raises Unsupported for a member of a struct inside of it."""
    places: set[tuple[str, ...]] = set()
    for function in module.functions:
        for stmt in statements(function.body or ()):
            if isinstance(stmt, MemoryOperation) and MEMORY[stmt.name].values:
                memory = memory_of(stmt.args[0])
                if not memory:
                    raise Unsupported("an atomic works on a member of a block, not of a struct in it", stmt.span)
                places.add(memory)
    return frozenset(places)
