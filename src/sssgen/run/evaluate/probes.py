"""Functions of one result each, generated from a technique, for back ends that map arrays to arrays.

A technique may return a value, write `out` and `inout` parameters, or both. A probe calls it and returns one of these
values. Uniforms become parameters, as in the functions form of every target.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Call, Declare, Evaluate, Function, Local, Module, Param, Return, Stmt, Uniform
from sssgen.ir.types import VOID, Type
from sssgen.lang.loader import load_file
from sssgen.lang.plain_glsl import AUTO, load_glsl
from sssgen.material import library, slots
from sssgen.material.slots import find, needs
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.link import LinkError, LinkInput, link
from sssgen.passes.prune import prune
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import stem

RESULT = "result"
"""The name of a technique's return value among its outputs."""


class Probe(NamedTuple):
    """A function that returns one output of a technique."""

    output: str
    function: str
    params: tuple[Param, ...]
    """The technique's own parameters, followed by the uniforms that it reads."""
    result: Type


class Subject(NamedTuple):
    """The subject of an evaluation: a module of probes."""

    name: str
    module: Module
    probes: tuple[Probe, ...]
    uniforms: Mapping[str, Uniform]
    chained: bool = True
    """Whether it is a technique, whose parameters have the meaning of their names."""

    @property
    def called(self) -> list[str]:
        """The keys of the probes."""
        shown = {probe.function for probe in self.probes}
        return [function.key for function in self.module.functions if function.name in shown]

    @property
    def params(self) -> dict[str, Param]:
        """Every input that some probe takes, by name."""
        return {param.name: param for probe in self.probes for param in probe.params}


def subject(name: str, bind: Mapping[str, str] | None = None) -> Subject:
    """A technique (a library name, a .sss file, or FILE:FUNCTION) with functions bound to its slots.

    `bind` has slot → FUNCTION, FILE or FILE:FUNCTION; other slots get the library's first function that fits.
    Raises SssgenError for unknown names and functions that do not fit.
    """
    module, function, role = _technique(name)
    bound = _bound(name, module, function, bind or {})
    probes = of_stages(name, [LinkInput(function.name, role, module, function, bound, {}, frozenset())])
    return probes._replace(chained=not _is_function(name))


def of_stages(name: str, stages: Sequence[LinkInput]) -> Subject:
    """The probes of linked techniques, in one module."""
    try:
        linked = link(list(stages))
    except LinkError as error:
        raise failure(error.message) from None
    named_probes = [(output, probe) for function in linked.functions for output, probe in probes_of(function)]
    module = linked.module._replace(functions=(*linked.module.functions, *(probe for _, probe in named_probes)))
    roots = [probe.key for _, probe in named_probes]
    module, _ = hoist(prune(fold(module), roots), roots)
    closed = {function.name: function for function in uniforms_to_parameters(module).functions}
    probes = tuple(
        Probe(output, probe.name, closed[probe.name].params, closed[probe.name].result)
        for output, probe in named_probes
    )
    return Subject(name, module, probes, {uniform.name: uniform for uniform in module.uniforms})


def _is_function(name: str) -> bool:
    """Whether a name is FILE:FUNCTION."""
    file, colon, _ = name.rpartition(":")
    return bool(colon) and file.endswith((".sss", ".glsl"))


def _technique(name: str) -> tuple[Module, Function, str]:
    file, _, inner = name.rpartition(":")
    if not _is_function(name):
        technique = library.load(name)
        return technique.module, technique.function, technique.role
    module = load_file(file, (library.TECHNIQUES,)) if file.endswith(".sss") else load_glsl(file, entry=AUTO).module
    named = {function.name: function for function in module.functions if function.body is not None}
    if inner not in named:
        raise failure(f"{file} has no function '{inner}'", did_you_mean(inner, named) or f"it has: {', '.join(named)}")
    return module, named[inner], "distance"


def _bound(
    name: str, module: Module, function: Function, bind: Mapping[str, str]
) -> dict[str, tuple[Module, Function]]:
    """Each slot with its function, including the slots of the bound functions."""
    bindings: dict[str, tuple[Module, Function]] = {}
    waiting = list(needs(module, function)[1])
    while waiting:
        slot = waiting.pop()
        if slot.name in bindings:
            continue
        chosen = bind.get(slot.name) or next(iter(slots.candidates(slot)), "")
        if not chosen:
            raise failure(f"nothing is bound to the slot {slots.signature(slot)}", f"--bind {slot.name}=FILE:FUNCTION")
        bindings[slot.name] = find(chosen, slot, library.TECHNIQUES if not bind.get(slot.name) else ".")
        waiting += needs(*bindings[slot.name])[1]
    if unknown := [slot for slot in bind if slot not in bindings]:
        hint = did_you_mean(unknown[0], bindings) or (
            f"its slots: {', '.join(bindings)}" if bindings else "it has no slots"
        )
        raise failure(f"{stem(name)} has no slot '{unknown[0]}'", hint)
    return bindings


def probes_of(function: Function) -> list[tuple[str, Function]]:
    """(output, function), one for each output of a technique."""
    span = function.span
    outs = [param for param in function.params if param.direction != "in"]
    outputs: list[Param | None] = [None, *outs] if function.result != VOID else [*outs]
    probes = []
    for output in outputs:
        start: list[Stmt] = []
        args = []
        for param in function.params:
            name = param.name if param.direction == "in" else f"{param.name}_given"
            if param.direction != "in":
                value = Local(param.type, param.name, span) if param.direction == "inout" else None
                start.append(Declare(name, param.type, value, span))
            args.append(Local(param.type, name, span))
        call = Call(function.result, function.key, tuple(args), span)
        value_name = f"{function.name}_value"
        start.append(
            Evaluate(call, span) if function.result == VOID else Declare(value_name, function.result, call, span)
        )
        returned = f"{output.name}_given" if output else value_name
        type_ = output.type if output else function.result
        body = (*start, Return(Local(type_, returned, span), span))
        params = tuple(param._replace(direction="in") for param in function.params if param.direction != "out")
        title = output.name if output else RESULT
        probe = function._replace(name=f"{function.name}_shows_{title}", params=params, result=type_, body=body)
        probes.append((title, probe))
    return probes
