"""Slots of techniques and the functions that a material binds to them."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping

from sssgen.ir.nodes import Call, Function, Global, Module
from sssgen.ir.types import spell
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.lang.loader import load_file
from sssgen.material import library
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.file_memo import note
from sssgen.support.paths import source_name, stem

Needs = tuple[frozenset[str], tuple[Function, ...]]

_needs_of: dict[int, tuple[Module, Function, Needs]] = {}
_CACHE_SIZE = 4096


def needs(module: Module, function: Function) -> Needs:
    """The names of the globals that a function reads and the slots it calls, itself or through others."""
    cached = _needs_of.get(id(function))
    if cached is None or cached[0] is not module or cached[1] is not function:
        if len(_needs_of) >= _CACHE_SIZE:
            _needs_of.clear()
        cached = _needs_of[id(function)] = (module, function, _needs(module, function))
    return cached[2]


def _needs(module: Module, function: Function) -> Needs:
    functions = {other.key: other for other in module.functions}
    constants = {constant.name: constant for constant in module.constants}
    names: set[str] = set()
    slots: list[Function] = []
    waiting, seen = [function], {function.key}
    while waiting:
        current = waiting.pop()
        if current.body is None:
            slots.append(current)
        for expr in all_expressions(current.body or ()):
            kind = type(expr)
            if kind is Call and expr.function not in seen:  # type: ignore[union-attr]  # it is a Call
                seen.add(expr.function)  # type: ignore[union-attr]
                waiting.append(functions[expr.function])  # type: ignore[union-attr]
            elif kind is Global:
                names.add(expr.name)  # type: ignore[union-attr]
    for name in list(names & constants.keys()):
        names |= {expr.name for expr in subexpressions(constants[name].value) if isinstance(expr, Global)}
    return frozenset(names), tuple(slots)


def signature(function: Function) -> str:
    """A function's declaration as in the source: `float sphere(world_position p)`."""
    params = []
    for param in function.params:
        direction = "" if param.direction == "in" else f"{param.direction} "
        params.append(f"{direction}{param.quantity or spell(param.type)} {param.name}")
    return f"{function.quantity or spell(function.result)} {function.name}({', '.join(params)})"


def fits(slot: Function, function: Function) -> bool:
    """Whether a function can be bound to the slot: the types are equal; quantities may only be dropped."""

    def drops(source: str, target: str) -> bool:
        return target in ("", source)

    return (
        function.body is not None
        and slot.result == function.result
        and drops(function.quantity, slot.quantity)
        and len(slot.params) == len(function.params)
        and all(
            expected.type == param.type
            and expected.direction == param.direction
            and (expected.direction == "out" or drops(expected.quantity, param.quantity))
            and (expected.direction == "in" or drops(param.quantity, expected.quantity))
            for expected, param in zip(slot.params, function.params, strict=True)
        )
    )


def find(text: str, slot: Function, folder: str) -> tuple[Module, Function]:
    """The function that `NAME`, `NAME:FUNCTION`, `FILE` or `FILE:FUNCTION` names.

    A file is relative to `folder`, or to the technique library.

    Raises SssgenError if there is none or it does not fit the slot.
    """
    source, _, name = text.rpartition(":") if text.rpartition(":")[2].isidentifier() else (text, "", "")
    if not source:
        source, name = name, ""
    if source.endswith((".sss", ".glsl")):
        paths = [os.path.join(root, source) for root in (folder, library.TECHNIQUES)]
        note(paths[0])
        path = next((path for path in paths if os.path.isfile(path)), None)
        if path is None:
            raise failure(f"cannot find the file '{source}'", "the path is relative to the material")
        module = load_file(path, (library.TECHNIQUES,))
        name = name or stem(path)
    else:
        if source not in library.index():
            near = library.file_meant(source, folder) or did_you_mean(source, library.index())
            hint = near or f"functions that fit: {', '.join(candidates(slot))}"
            raise failure(f"unknown function '{source}'", hint)
        module = library.load(source).module
        name = name or source
    named = [function for function in module.functions if function.name == name and function.body is not None]
    if not named:
        names = [function.name for function in module.functions if function.body is not None]
        raise failure(
            f"'{source}' has no function '{name}'", did_you_mean(name, names) or f"it has: {', '.join(names)}"
        )
    for function in named:
        if fits(slot, function):
            return module, function
    fitting_names = [function.name for function in module.functions if fits(slot, function)]
    if fitting_names:
        hint = f'write "{source}:{fitting_names[0]}"'
    else:
        fitting = candidates(slot)
        hint = f"functions that fit: {', '.join(fitting)}" if fitting else "write a function of that signature"
    raise failure(f"'{text}' does not fit the slot: {signature(named[0])} is bound to {signature(slot)}", hint)


def candidates(slot: Function) -> list[str]:
    """The library's functions that fit a slot, as a material writes them."""
    names: list[str] = []
    for name, path in library.index().items():
        if library.folder_of(path) != ("thickness" if slot.quantity else "distance"):
            continue
        with contextlib.suppress(SssgenError):  # a file with errors is reported when it is used
            module, file = library.load_path(path).module, source_name(path)
            own = [function for function in module.functions if function.span.file == file and fits(slot, function)]
            function_names = [
                function.name
                for function in own
                if function.name == name or any(param.quantity for param in function.params)
            ]
            names += [name if other == name else f"{name}:{other}" for other in function_names]
    return names


def body(shape: str, place: str) -> str:
    """The library's distance function of a `shape` for positions of the quantity `place`, as a material writes it.

    '' where there is none: `body("box", "object_position")` is `box:box_object`.
    """
    for technique in library.load_all():
        file = source_name(technique.path)
        own = [function for function in technique.module.functions if function.span.file == file]
        for function in own if technique.attributes.shape == shape else ():
            if [param.quantity for param in function.params] == [place]:
                return technique.name if function.name == technique.name else f"{technique.name}:{function.name}"
    return ""


def cycle(bound: Mapping[str, tuple[Module, Function]]) -> list[str]:
    """The first slot whose function calls the slot again, directly or through others; [] if there is none."""
    calls = {name: [slot.name for slot in needs(module, function)[1]] for name, (module, function) in bound.items()}
    for start in bound:
        waiting, seen = list(calls[start]), set()
        while waiting:
            name = waiting.pop()
            if name == start:
                return [start]
            if name not in seen:
                seen.add(name)
                waiting += calls.get(name, [])
    return []
