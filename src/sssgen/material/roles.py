"""The roles of a chain: what techniques of each role return and may read, and the check of a whole chain.

A parameter is matched to a value of the chain by its name, a scalar quantity by its type.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Param, Span
from sssgen.ir.types import BOOL, FLOAT, VEC3, VOID, Type, spell
from sssgen.lang.check.quantities import SCALARS, words
from sssgen.lang.check.suggested_conversions import suggested_conversions
from sssgen.material.chain_assembly import DEFAULTS, INPUTS
from sssgen.material.library import OF_SHELLS, Technique, folder_of, index, load_path
from sssgen.support.diagnostics import did_you_mean

SECTIONS = ("geometry", "coordinates", "thickness", "surface", "translucency", "lighting", *OF_SHELLS, "output")
"""The sections of a material file that hold stages, in the order they run."""

OF_LIGHTS = ("shadow", "environment")
"""The roles of lit materials with at most one stage."""

VALUE_QUANTITIES = {
    "uv": "uv_position",
    "uv2": "uv_position",
    "P": "world_position",
    "ray_origin": "world_position",
    "P_object": "object_position",
    "normal": "tangent_direction",
    **dict.fromkeys(("N", "V", "T", "B", "L", "ray_direction"), "world_direction"),
    **dict.fromkeys(("N_object", "V_object", "L_object"), "object_direction"),
}
"""The quantity types of the chain's values; all others have none."""

Report = Callable[[Span, str, str], None]


class Link(NamedTuple):
    """A stage, as the check of the chain needs it."""

    technique: Technique
    span: Span
    levels: tuple[int, ...] = ()
    """The levels of detail that it belongs to; () for all of them"""


class _Value(NamedTuple):
    type: Type
    quantity: str


def allowed_roles(section: str) -> tuple[str, ...]:
    """The roles of the techniques that a section takes."""
    return ("thickness", "conversion") if section == "thickness" else (section,)


def check_levels(links: Sequence[Link], levels: int, shading: str, report: Report) -> None:
    """As `check_chain`, for the chain of each level of detail; what several of them have is reported once."""
    reports: dict[tuple[Span, str, str], None] = {}
    for level in range(levels):
        own = [link for link in links if not link.levels or level in link.levels]
        check_chain(own, shading, lambda *content: reports.setdefault(content))
    for content in reports:
        report(*content)


def check_chain(links: Sequence[Link], shading: str, report: Report) -> None:
    """Reports each parameter that no stage supplies, and each technique whose result does not fit its role."""
    values = {name: _Value(type_, VALUE_QUANTITIES.get(name, "")) for name, type_ in INPUTS.items()}
    values |= {name: _Value(type_, VALUE_QUANTITIES.get(name, "")) for name, (type_, _) in DEFAULTS.items()}
    sources: dict[str, str] = {}
    unread: set[str] = set()
    of_lights: set[str] = set()
    colored = False
    for technique, span, _ in links:
        if error := wrong_result(technique):
            report(span, error, "")
        written = {technique.function.quantity} & set(SCALARS)
        for param in technique.function.params:
            if param.quantity in SCALARS:
                if param.direction != "out":
                    _check_quantity(technique, param.quantity, sources, span, report)
                    unread.discard(param.quantity)
                if param.direction != "in":
                    written.add(param.quantity)
            else:
                _check_value(technique, param, values, span, report)
                colored = colored or (param.name == "color" and param.direction != "in")
        for quantity in sorted(written):
            if quantity in unread:
                earlier = f"but that of '{sources[quantity]}' has not been used"
                report(span, f"'{technique.name}' gives {words(quantity)}, {earlier}", "remove one of the two")
            sources[quantity] = technique.name
            unread.add(quantity)
        colored = colored or technique.role == "lighting"
        if technique.role in OF_LIGHTS and (shading == "unlit" or technique.role in of_lights):
            unlit = f"an unlit material has no lights for [{technique.role}]"
            message = unlit if shading == "unlit" else f"a second [{technique.role}] stage"
            report(span, message, "remove it")
        of_lights.add(technique.role)
        if technique.role == "geometry" and technique.function.result == BOOL and shading == "lit":
            message = f"'{technique.name}' may miss, and then there is no surface for the engine to light"
            report(span, message, 'write shading = "unlit", and add a [lighting] stage')
    if shading == "unlit" and links and not colored:
        names = ", ".join(sorted(name for name, path in index().items() if folder_of(path) == "lighting"))
        report(
            links[-1].span,
            "an unlit material needs a stage that gives its color",
            f'add a [lighting] stage ({names}), or write shading = "lit"',
        )


def wrong_result(technique: Technique) -> str:
    """The error message if a technique's result does not fit its role, or ''."""
    function, role = technique.function, technique.role
    wanted: dict[str, tuple[tuple[Type, ...], str]] = {
        "geometry": ((BOOL, VOID), "bool or void"),
        "surface": ((VOID,), "void"),
        "translucency": ((FLOAT, VEC3), "float or vec3"),
        "lighting": ((VEC3,), "vec3"),
        "shadow": ((FLOAT,), "float"),
        "environment": ((VEC3,), "vec3"),
        "tone_mapping": ((VEC3,), "vec3"),
        "output": ((VEC3,), "vec3"),
    }
    if role in wanted:
        types, text = wanted[role]
        if function.result in types and not function.quantity:
            return ""
    elif role == "coordinates":
        text = "uv_position"
        if function.quantity == text:
            return ""
    elif role in ("thickness", "conversion"):
        text = f"{', '.join(SCALARS[:-1])} or {SCALARS[-1]}"
        if function.quantity in SCALARS:
            taken = [param.quantity for param in function.params if param.quantity in SCALARS]
            if role == "conversion" and (len(taken) != 1 or taken[0] == function.quantity):
                return f"'{technique.name}' is a conversion, but does not take one quantity and return another"
            return ""
    else:
        return ""
    returned = function.quantity or spell(function.result)
    return f"'{technique.name}' is a {role} technique, which returns {text}, but it returns {returned}"


def _check_quantity(technique: Technique, quantity: str, sources: dict[str, str], span: Span, report: Report) -> None:
    if quantity in sources:
        return
    for source in reversed(list(sources)):
        name = suggested_conversions().get((source, quantity))
        if name is None:  # a length along the eye's ray is not a length towards the light
            continue
        hint = f"add a conversion stage after '{sources[source]}': [[thickness]] technique = \"{name}\""
        report(span, f"'{technique.name}' takes {words(quantity)}, but the chain has {words(source)}", hint)
        return
    report(
        span,
        f"'{technique.name}' takes {words(quantity)}, which no stage before it gives",
        f"add a [thickness] stage: {', '.join(_producers(quantity))}",
    )


def _check_value(technique: Technique, param: Param, values: dict[str, _Value], span: Span, report: Report) -> None:
    value = values.get(param.name)
    if value is None:
        if param.direction == "out":
            values[param.name] = _Value(param.type, param.quantity)
            return
        report(
            span,
            f"'{technique.name}' takes '{param.name}', which no stage before it gives",
            did_you_mean(param.name, values) or f"values: {', '.join(values)}",
        )
        return
    same_quantity = param.quantity == value.quantity or (param.direction == "in" and not param.quantity)
    if param.type != value.type or not same_quantity:
        report(
            span,
            f"'{technique.name}' takes '{param.name}' as {param.quantity or spell(param.type)}, "
            f"but in a chain it is {value.quantity or spell(value.type)}",
            "declare the parameter with that type in the technique, or rename it",
        )


def _producers(quantity: str) -> list[str]:
    """The library's thickness techniques that return a quantity."""
    paths = {name: path for name, path in index().items() if folder_of(path) == "thickness"}
    return [name for name, path in paths.items() if load_path(path).function.quantity == quantity]
