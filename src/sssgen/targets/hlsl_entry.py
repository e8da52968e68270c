"""The entry function of a stage in HLSL: semantics for locations and builtins, a struct for several outputs.

A vertex shader's attributes are ATTR0, ATTR1, …, what goes from stage to stage TEXCOORD0, …, colours SV_Target0, …,
each by its location.
"""

from __future__ import annotations

from sssgen.ir.nodes import NOWHERE
from sssgen.ir.types import INT, kind_of
from sssgen.passes.stage.stage_interface import Slot, Stage
from sssgen.targets.entry_points import (
    adjusted,
    depth_halved,
    given_type,
    is_count,
    member,
    names_of,
    parameters,
    place_text,
)
from sssgen.targets.printer import Line, Printer, wrap

_INTERPOLATION = {"flat": "nointerpolation ", "noperspective": "noperspective ", "centroid": "centroid "}
_GIVEN = {"vertex": "ATTR", "fragment": "TEXCOORD"}
_MADE = {"vertex": "TEXCOORD", "fragment": "SV_Target"}


def print_entry(printer: Printer, stage: Stage, name: str, resolution: str) -> list[Line]:
    """The lines of the entry `name`; `resolution` is how that uniform is read."""
    taken = names_of(printer.module) | {name}
    builtins = printer.target.stage_builtins
    given = parameters(stage, taken)

    def declared(slot: Slot, name: str, semantics: str) -> str:
        semantic = f"{semantics}{slot.location}" if slot.location >= 0 else builtins[slot.variable.builtin]
        word = "flat" if kind_of(slot.type) in ("int", "uint") else slot.variable.interpolation
        sampled = _INTERPOLATION[word] if semantics == "TEXCOORD" and slot.location >= 0 and word else ""
        return f"{sampled}{printer.variable(given_type(slot), name)} : {semantic}"

    params = ", ".join([declared(one.slot, one.name, _GIVEN[stage.kind]) for one in given])
    body = []
    for one in given:
        value = f"{printer.type(INT)}({one.name})" if is_count(one.slot) else one.name
        body.append(f"{place_text(one.slot)} = {value};")
    body += [
        *adjusted(stage, resolution, True),
        f"{printer.by_key[stage.function].name}();",
        *depth_halved(stage.outputs),
    ]
    lines: list[Line] = []
    if len(stage.outputs) == 1:
        (slot,) = stage.outputs
        head, _, semantic = declared(slot, "result", _MADE[stage.kind]).partition(" result : ")
        signature = f"{head} {name}({params}) : {semantic} {{"
        body.append(f"return {place_text(slot)};")
    elif stage.outputs:
        struct, result = f"{stage.kind.capitalize()}Output", "made"
        while struct in taken:
            struct += "_"
        while result in taken:
            result += "_"
        lines.append(Line(f"struct {struct} {{"))
        lines += [Line(f"    {declared(slot, member(slot), _MADE[stage.kind])};") for slot in stage.outputs]
        lines += [Line("};"), Line("")]
        signature = f"{struct} {name}({params}) {{"
        body += [f"{struct} {result};"]
        body += [f"{result}.{member(slot)} = {place_text(slot)};" for slot in stage.outputs]
        body.append(f"return {result};")
    else:
        signature = f"void {name}({params}) {{"
    lines += wrap(signature, NOWHERE)
    return [*lines, *[line for text in body for line in wrap(f"    {text}", NOWHERE)], Line("}")]
