"""The interface of a whole shader: its stage, and where each of its in and out variables is bound.

A module with a function `void main()` is a whole shader: a vertex shader if it has gl_Position, else a fragment
shader.
A location that the author wrote is kept; the other variables get the lowest free ones. What the vertex shader passes on
is numbered by `varyings`, so that both stages agree; attributes and colours are in the order of their declaration.
Place: what depends on the framebuffer before `hoist`, the interface last, as the names are final there.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Expr, Function, Global, Index, Intrinsic, Literal, Module, Unary, Variable
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import VOID, Array, Type, Vector, kind_of, unnested
from sssgen.ir.walk import all_expressions, builtins_of, operands
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.stage.varyings import Path, locations, output_of, parts, varyings
from sssgen.passes.unsupported import Note, Unsupported

ENTRY = "main()"
"""The key of the function that a stage begins with."""

RESOLUTION = "iResolution"
"""The uniform that holds the size of the framebuffer in pixels."""

COLORS = ("gl_FragColor", "gl_FragData")
"""Builtins that are colours of the framebuffer at the locations from 0 on."""

_INSTEAD = {
    "gl_PointSize": "for larger points draw two triangles for each: docs/webgl-to-webgpu.md#points",
    "gl_PointCoord": "draw two triangles for each point, with a varying in its place: docs/webgl-to-webgpu.md#points",
}
"""Builtin → what to do where the target does not have it."""


class Slot(NamedTuple):
    """One input or output: a variable, or an element, a column or a member of one."""

    variable: Variable
    path: Path
    """What leads to the part: indices and names of members."""
    type: Type
    location: int
    """-1 for a builtin."""
    link: str = ""
    """The name by which the next or the previous stage matches the variable; '' where nothing is matched by name."""
    part: int = 0
    """How many parts of the variable precede this one."""
    is_declared: bool = True
    """False: the module does not have the variable; it is only an output of the vertex shader."""


def interpolation(variable: Variable) -> str:
    """How a variable is interpolated: flat, noperspective, centroid or ''; integers always are flat."""
    return "flat" if kind_of(unnested(variable.type)[0]) in ("int", "uint") else variable.interpolation


class Stage(NamedTuple):
    """A whole shader's interface."""

    kind: str
    """vertex, fragment or compute"""
    function: str
    """The key of the author's main function."""
    inputs: tuple[Slot, ...]
    outputs: tuple[Slot, ...]
    """Those with a location first, in its order."""
    resolution: str
    """The uniform from whose y gl_FragCoord.y is subtracted; '' where y is not flipped."""
    upends: bool = False
    """Whether the vertex shader turns the picture upside down: its bottom row is then the first one, as in OpenGL."""

    @property
    def passes_locations(self) -> bool:
        """Whether the source states locations for what the vertex shader passes to the fragment shader."""
        passed = self.outputs if self.kind == "vertex" else self.inputs
        return any(slot.variable.location >= 0 for slot in passed)


def entry_of(module: Module) -> Function | None:
    """The function that a stage begins with."""
    entries = (
        function
        for function in module.functions
        if not function.params and function.key == ENTRY and function.result == VOID and function.body is not None
    )
    return next(entries, None)


def stage_kind(module: Module) -> str:
    """vertex, fragment or compute; '' for a module without an entry."""
    if entry_of(module) is None:
        return ""
    if module.workgroup:
        return "compute"
    return "vertex" if any(variable.builtin == "gl_Position" for variable in module.variables) else "fragment"


class Matching(NamedTuple):
    """What the matching of a stage with the other one depends on."""

    names: Mapping[str, str]
    """A variable's name in the module → its name in the source."""
    partner: Module | None
    """The other stage's module before any pass, if it is given."""
    subsets: bool
    """Whether a fragment shader may have fewer inputs than the vertex shader has outputs."""


def interface(
    module: Module, kind: str, function: str, builtins: Collection[str], turned: bool, matching: Matching
) -> Stage:
    """The interface of a module with its final names. Raises Unsupported for an input that the target lacks.

    `function` is the key of its main function, `builtins` are those that the target has; any other
    output but gl_SampleMask is dropped. `turned`: the framebuffer's y counts from the top.
    """
    inputs = [variable for variable in module.variables if variable.storage == "in"]
    outputs = [variable for variable in module.variables if variable.storage == "out"]
    masks = [variable for variable in outputs if variable.builtin == "gl_SampleMask"]  # which cannot be left out
    for variable in inputs + masks:
        if variable.builtin and variable.builtin not in builtins:
            message = f"a {kind} shader of this target has no {variable.builtin}"
            raise Unsupported(message, variable.span, hint=_INSTEAD.get(variable.builtin, ""))
    outputs = [
        output for output in outputs if not output.builtin or output.builtin in builtins or output.builtin in COLORS
    ]
    resolution = resolution_of(module) if turned and kind == "fragment" else ""
    if kind == "compute":
        return Stage(kind, function, _slots(inputs), (), "")
    if kind == "vertex":
        return Stage(kind, function, _slots(inputs), _matched_slots(outputs, kind, matching), resolution)
    return Stage(kind, function, _matched_slots(inputs, kind, matching), _slots(outputs), resolution)


def _slots(variables: Sequence[Variable]) -> tuple[Slot, ...]:
    """The slots of attributes or colours: those with a location, then the builtins."""
    numbered = [variable for variable in variables if not variable.builtin or variable.builtin in COLORS]
    stated = [variable._replace(location=0) if variable.builtin in COLORS else variable for variable in numbered]
    placed = locations(stated, {}, by_name=False)
    return _in_order(variables, [slot for variable in numbered for slot in _slots_of(variable, placed[variable.name])])


def _matched_slots(variables: Sequence[Variable], kind: str, matching: Matching) -> tuple[Slot, ...]:
    """The slots of what the vertex shader passes to the fragment shader: those with a location, then the builtins."""
    names, partner = matching.names, matching.partner
    own = [variable for variable in variables if not variable.builtin]
    named = [variable._replace(name=names.get(variable.name, variable.name)) for variable in own]
    others = varyings(partner, "vertex") if kind == "fragment" and partner is not None else []
    places = locations(others, {}, by_name=True)
    placed = locations(named, places, by_name=True)
    slots: list[Slot] = []
    received = list[Variable]()
    for variable, source in zip(own, named, strict=True):
        link = "" if source.location >= 0 else source.name
        if kind == "fragment" and partner is not None:
            output = output_of(source, others)
            if output is None:
                continue  # it is not read, or `mismatches` reports it
            received.append(output)
        slots += _slots_of(variable, placed[source.name], link)
    if kind == "fragment" and not matching.subsets:
        for output in others:
            if output not in received:
                link = "" if output.location >= 0 else output.name
                slots += [slot._replace(is_declared=False) for slot in _slots_of(output, places[output.name], link)]
    return _in_order(variables, slots)


def _slots_of(variable: Variable, places: range, link: str = "") -> list[Slot]:
    return [Slot(variable, path, type_, places[part], link, part) for part, (path, type_) in enumerate(parts(variable))]


def _in_order(variables: Sequence[Variable], slots: Sequence[Slot]) -> tuple[Slot, ...]:
    """The slots in the order of their locations, then the builtins."""
    builtins = [
        Slot(variable, (0,), variable.type.element, -1)  # gl_SampleMask, of which there is one number
        if isinstance(variable.type, Array)
        else Slot(variable, (), variable.type, -1)
        for variable in variables
        if variable.builtin and variable.builtin not in COLORS
    ]
    return (*sorted(slots, key=lambda slot: slot.location), *builtins)


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

    variables = [each._replace(type=short(each.type)) if each.name in data else each for each in module.variables]
    return rewrite_module(module._replace(variables=tuple(variables)), change)


def remarks(
    module: Module, kind: str, builtins: Collection[str], turned: bool, capabilities: Capabilities, alone: bool
) -> list[Note]:
    """What differs from the source in a target's whole shader, with its place.

    `alone`: the other stage is not given.
    """
    differences = _notes_without_partner(module, kind, capabilities) if alone else []
    for variable in module.variables:
        if variable.interpolation == "noperspective" and not capabilities.noperspective:
            message = f"'{variable.name}' is interpolated with perspective here: this target has no other interpolation"
            differences.append(Note(message, variable.span))
        if variable.builtin == "gl_FragCoord" and turned and not resolution_of(module):
            message = "gl_FragCoord.y counts from the top of the framebuffer here"
            hint = f"declare a uniform vec2 {RESOLUTION}, and it is flipped"
            differences.append(Note(message, variable.span, hint))
        elif variable.storage == "out" and variable.builtin and variable.builtin not in (*builtins, *COLORS):
            message = f"{variable.builtin} has no effect here: this target has no such output"
            differences.append(Note(message, variable.span, _INSTEAD.get(variable.builtin, "")))
    return differences


def _notes_without_partner(module: Module, kind: str, capabilities: Capabilities) -> list[Note]:
    """What only the other stage can tell."""
    passed = varyings(module, kind)
    named = sorted([variable for variable in passed if variable.location < 0], key=lambda variable: variable.name)
    if named and kind == "fragment" and not capabilities.named_varyings:
        names = ", ".join([f"'{variable.name}'" for variable in named])
        are = f"the inputs {names} are numbered" if len(named) > 1 else f"the input {names} is numbered"
        hint = "give the vertex shader, --with FILE, if it has other outputs; or both, --stages A.vert B.frag"
        return [Note(f"{are} by name", named[0].span, hint)]
    if capabilities.varying_locations:
        return []
    message = "has a location, but is matched by its name here: the other stage must have the same name"
    return [Note(f"'{variable.name}' {message}", variable.span) for variable in passed if variable.location >= 0]
