"""The interface of a whole shader: its stage, and where each of its in and out variables is bound.

A module with a function `void main()` is a whole shader: a vertex shader if it writes gl_Position, else a fragment
shader.
A location that the author wrote is kept; the other variables get the lowest free ones in the order of their
declaration, so that a vertex shader's outputs meet a fragment shader's inputs where both are declared alike.
Place: what depends on the framebuffer before `hoist`, the interface last, as the names are final there.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Expr, Function, Global, Index, Intrinsic, Literal, Module, Span, Unary, Variable
from sssgen.ir.rules import element_type
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import VOID, Array, Matrix, Struct, Type, Vector
from sssgen.ir.walk import all_expressions, builtins_of, operands
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.unsupported import Unsupported
from sssgen.passes.variable_effects import effects

ENTRY = "main()"
"""The key of the function that a stage begins with."""

RESOLUTION = "iResolution"
"""The uniform that holds the size of the framebuffer in pixels."""

COLORS = ("gl_FragColor", "gl_FragData")
"""Builtins that are colours of the framebuffer at the locations from 0 on."""


class Slot(NamedTuple):
    """One input or output: a variable, or an element or column of one."""

    variable: Variable
    path: tuple[int, ...]
    """The indices of the element or column."""
    type: Type
    location: int
    """-1 for a builtin."""


class Stage(NamedTuple):
    """A whole shader's interface."""

    kind: str
    """vertex or fragment"""
    function: str
    """The key of the author's main function."""
    inputs: tuple[Slot, ...]
    outputs: tuple[Slot, ...]
    """Those with a location first, in its order."""
    resolution: str
    """The uniform from whose y gl_FragCoord.y is subtracted; '' where y is not flipped."""


def entry_of(module: Module) -> Function | None:
    """The function that a stage begins with."""
    entries = (
        function
        for function in module.functions
        if function.key == ENTRY and function.result == VOID and function.body is not None
    )
    return next(entries, None)


def stage_kind(module: Module) -> str:
    """vertex or fragment; '' for a module without an entry."""
    if entry_of(module) is None:
        return ""
    positions = {variable.name for variable in module.variables if variable.builtin == "gl_Position"}
    written = [effect.writes for effect in effects(module).values()] if positions else []
    return "fragment" if all(map(positions.isdisjoint, written)) else "vertex"


def interface(module: Module, kind: str, function: str, builtins: Collection[str], turned: bool) -> Stage:
    """The interface of a module with its final names. Raises Unsupported for an input that the target lacks.

    `function` is the key of its main function, `builtins` are those that the target has; any other
    output is dropped. `turned`: the framebuffer's y counts from the top.
    """
    inputs = [variable for variable in module.variables if variable.storage == "in"]
    outputs = [variable for variable in module.variables if variable.storage == "out"]
    for variable in inputs:
        if variable.builtin and variable.builtin not in builtins:
            raise Unsupported(f"a {kind} shader of this target is given no {variable.builtin}", variable.span)
    outputs = [
        output for output in outputs if not output.builtin or output.builtin in builtins or output.builtin in COLORS
    ]
    resolution = resolution_of(module) if turned and kind == "fragment" else ""
    return Stage(kind, function, _slots(inputs), _slots(outputs), resolution)


def resolution_of(module: Module) -> str:
    """The name of the uniform that holds the size of the framebuffer; '' where there is none."""
    for uniform in module.uniforms:
        if uniform.name == RESOLUTION and isinstance(uniform.type, Vector) and uniform.type.kind == "float":
            return uniform.name
    return ""


def turned_derivatives(module: Module) -> Module:
    """The module for a framebuffer whose y counts from the top: dFdy is negated, which keeps its meaning."""

    def change(expr: Expr) -> Expr:
        if isinstance(expr, Intrinsic) and BUILTINS[expr.name].axis == "y":
            return Unary(expr.type, "-", expr, expr.span)
        return expr

    turned = any(BUILTINS[name].axis == "y" for name in builtins_of(module))
    return rewrite_module(module, change) if turned else module


def colors_in_use(module: Module) -> Module:
    """The module with gl_FragData as long as its highest index requires, where all indices are constant."""
    data = {variable.name: variable.type for variable in module.variables if variable.builtin == "gl_FragData"}
    if not data:
        return module
    length = 0
    for function in module.functions:
        for expr in all_expressions(function.body or ()):
            named = [part for part in operands(expr) if isinstance(part, Global) and part.name in data]
            if named and not (isinstance(expr, Index) and isinstance(expr.index, Literal)):
                return module
            if named and isinstance(expr, Index) and isinstance(expr.index, Literal):
                length = max(length, int(expr.index.value) + 1)

    def short(type_: Type) -> Type:
        return type_._replace(length=length) if isinstance(type_, Array) and length else type_

    def change(expr: Expr) -> Expr:
        return expr._replace(type=short(expr.type)) if isinstance(expr, Global) and expr.name in data else expr

    variables = tuple(
        [
            variable._replace(type=short(variable.type)) if variable.name in data else variable
            for variable in module.variables
        ]
    )
    return rewrite_module(module._replace(variables=variables), change)


def remarks(
    module: Module, builtins: Collection[str], turned: bool, capabilities: Capabilities
) -> list[tuple[str, Span]]:
    """What differs from the source in a target's whole shader, with its place."""
    differences = []
    for variable in module.variables:
        if variable.interpolation == "noperspective" and not capabilities.noperspective:
            differences.append(
                (
                    f"'{variable.name}' is interpolated with perspective here: this target has no other interpolation",
                    variable.span,
                )
            )
        if variable.builtin == "gl_FragCoord" and turned and not resolution_of(module):
            hint = f"declare a uniform vec2 {RESOLUTION}, and it is flipped"
            differences.append((f"gl_FragCoord.y counts from the top of the framebuffer here; {hint}", variable.span))
        elif variable.storage == "out" and variable.builtin and variable.builtin not in (*builtins, *COLORS):
            differences.append(
                (f"{variable.builtin} has no effect here: this target has no such output", variable.span)
            )
    return differences


def _slots(variables: Sequence[Variable]) -> tuple[Slot, ...]:
    """The slots of the variables: those with a location, then the builtins."""
    placed: list[Slot] = []
    builtins: list[Slot] = []
    taken: set[int] = set()
    written = {variable.name: variable.location if variable.builtin not in COLORS else 0 for variable in variables}
    parts = {variable.name: _parts(variable, variable.type) for variable in variables}
    for name, location in written.items():
        if location >= 0:
            taken.update(range(location, location + len(parts[name])))
    for variable in variables:
        own_parts = parts[variable.name]
        if variable.builtin and variable.builtin not in COLORS:
            builtins.append(Slot(variable, (), variable.type, -1))
            continue
        first = written[variable.name]
        if first < 0:
            first = next(
                candidate
                for candidate in range(len(taken) + 1)
                if taken.isdisjoint(range(candidate, candidate + len(own_parts)))
            )
            taken.update(range(first, first + len(own_parts)))
        placed += [Slot(variable, path, type_, first + index) for index, (path, type_) in enumerate(own_parts)]
    return (*sorted(placed, key=lambda slot: slot.location), *builtins)


def _parts(variable: Variable, type_: Type, path: tuple[int, ...] = ()) -> list[tuple[tuple[int, ...], Type]]:
    """The scalars and vectors of a variable, with the indices that lead to each."""
    inner = type_.element if isinstance(type_, Array) else type_
    if isinstance(inner, Struct):
        raise Unsupported(f"'{variable.name}' contains structs, which cannot be passed between stages", variable.span)
    if not isinstance(type_, Array | Matrix):
        return [(path, type_)]
    elements = element_type(type_)
    assert elements is not None
    element, count = elements
    return [part for index in range(count) for part in _parts(variable, element, (*path, index))]
