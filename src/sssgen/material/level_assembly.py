"""Assembles a material with several levels of detail: each level is a chain of its own stages.

The chains are merged entry by entry: `if (detail_level < 1) { … }` for all levels that differ, so that a level has the
values of the material with its stages alone. `detail_level` is a uniform, so the branch is uniform, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sssgen.ir.constant_expressions import literal, zero
from sssgen.ir.nodes import (
    NOWHERE,
    Binary,
    Block,
    Construct,
    Function,
    Global,
    If,
    Literal,
    Module,
    Param,
    Return,
    Stmt,
    StructDecl,
    Uniform,
)
from sssgen.ir.text import print_meaning
from sssgen.ir.types import BOOL, INT, Field, Struct
from sssgen.material.chain_assembly import DEFAULTS, DETAIL_LEVEL, Chain, ChainFunction, Entry, assemble
from sssgen.passes.struct_types import Retyper


def assemble_levels(
    module: Module, stages: Sequence[ChainFunction], levels: int, lit: bool, opaque: bool = False
) -> Chain:
    """As `assemble`, for a material with this number of levels. Raises LinkError as `assemble`."""
    if levels == 1:
        return assemble(module, stages, lit, opaque)
    chains = [
        assemble(module, [stage for stage in stages if not stage.levels or level in stage.levels], lit, opaque)
        for level in range(levels)
    ]
    surface = _common_surface([chain.surface for chain in chains if chain.surface is not None])
    kinds = dict.fromkeys(kind for chain in chains for kind in chain.entries)
    entries = {
        kind: _merged([_with_surface(chain.entries.get(kind), chain.surface, surface) for chain in chains])
        for kind in kinds
    }
    structs = [StructDecl(surface, "Surface values that the techniques compute.", NOWHERE)] if surface else []
    merged = module._replace(
        structs=(*module.structs, *structs),
        uniforms=(level_uniform(levels), *module.uniforms),
        functions=(*module.functions, *(entry.function for entry in entries.values())),
    )
    return Chain(merged, entries, surface)


def level_uniform(levels: int) -> Uniform:
    """The uniform that chooses one of the levels."""
    limits = ("hint_range", (0.0, levels - 1.0))
    return Uniform(DETAIL_LEVEL, INT, (0.0,), (limits,), "", "The level of detail: 0 is for the nearest body.", NOWHERE)


def _common_surface(surfaces: Iterable[Struct]) -> Struct | None:
    """The struct with the fields of all of them; None without any."""
    types = {field.name: field.type for surface in surfaces for field in surface.fields}
    return Struct("Surface", tuple(Field(name, type_) for name, type_ in types.items())) if types else None


def _with_surface(entry: Entry | None, old: Struct | None, new: Struct | None) -> Entry | None:
    """The entry of a level with the surface of all levels; the values that it does not compute are the defaults."""
    if entry is None or old is None or new is None:
        return entry
    function = Retyper({old: new}, {}).function(entry.function)
    if function.result == new:
        *before, last = function.body or ()
        assert isinstance(last, Return) and isinstance(last.value, Construct)
        values = dict(zip((field.name for field in old.fields), last.value.args, strict=True))
        defaults = {
            field.name: literal(*DEFAULTS[field.name], last.span)
            if field.name in DEFAULTS
            else zero(field.type, last.span)
            for field in new.fields
        }
        fields = tuple((defaults | values).values())
        function = function._replace(body=(*before, Return(Construct(new, fields, last.span), last.span)))
    return entry._replace(function=function)


def _merged(entries: Sequence[Entry | None]) -> Entry:
    """One entry for all levels. In a level without it, its value is 0: no light."""
    present = [entry for entry in entries if entry is not None]
    first = present[0].function
    params: dict[str, Param] = {}
    for entry in present:
        params |= {param.name: param for param in entry.function.params if param.name not in params}
    inputs = tuple(dict.fromkeys(name for entry in present for name in entry.inputs))
    leading = tuple(name for name in params if name not in inputs)
    ordered = tuple(params[name] for name in (*leading, *inputs))
    none = (Return(zero(first.result, first.span), first.span),)
    bodies = [entry.function.body or () if entry is not None else none for entry in entries]
    return Entry(first._replace(params=ordered, body=_switch(first, bodies)), inputs)


def _switch(function: Function, bodies: Sequence[Block]) -> Block:
    """The body of the level that `detail_level` names; a number beyond the levels is the nearest one."""
    meanings = [print_meaning(function._replace(params=(), body=body)) for body in bodies]
    statements: list[Stmt] = []
    for level, body in enumerate(bodies[:-1]):
        if meanings[level] != meanings[level + 1]:
            switch = Global(INT, DETAIL_LEVEL, function.span)
            below = Binary(BOOL, "<", switch, Literal(INT, level + 1, function.span), function.span)
            statements.append(If(below, body, (), function.span))
    return (*statements, *bodies[-1])
