"""The entry function of a stage in HLSL: semantics for locations and builtins, a struct for several outputs.

A vertex shader's attributes are ATTR0, ATTR1, …, colours SV_Target0, …, each numbered by its location. A value between
stages has a semantic of its name, as D3D matches these: NORMAL for `normal`; one with a location is TEXCOORDn.
"""

from __future__ import annotations

import re

from sssgen.ir.nodes import NOWHERE
from sssgen.passes.scopes import names_of
from sssgen.passes.stage.stage_interface import Slot, Stage, interpolation
from sssgen.targets.printers.entry_points import entry_body, member, output_text, parameter_type, parameters
from sssgen.targets.printers.printed_lines import Line, wrap
from sssgen.targets.printers.printer import Printer

_INTERPOLATION = {"flat": "nointerpolation ", "noperspective": "noperspective ", "centroid": "centroid "}
_INPUT_SEMANTICS = {"vertex": "ATTR", "fragment": "TEXCOORD", "compute": ""}
_OUTPUT_SEMANTICS = {"vertex": "TEXCOORD", "fragment": "SV_Target", "compute": ""}


def semantic(slot: Slot) -> str:
    """The semantic of a value between stages that is matched by name.

    Semantics ignore case, and digits at their end are an index. So an upper-case letter gets `_` in front, `_` is
    doubled, and a name that ends in a digit gets `_` at its end; no two names have the same semantic.
    """
    name = re.sub(r"([A-Z_])", r"_\1", slot.link).upper()
    if name.startswith("SV_") or name == "TEXCOORD":
        name = f"_0{name}"
    if name[-1].isdecimal():
        name += "_"
    return f"{name}{slot.part}" if slot.path else name


def print_entry(printer: Printer, stage: Stage, name: str, resolution: str) -> list[Line]:
    """The lines of the entry `name`; `resolution` is how that uniform is read."""
    taken = names_of(printer.module) | {name}
    builtins = printer.target.stage_builtins
    entry_parameters = parameters(stage, taken)

    def place_of(slot: Slot, semantics: str) -> str:
        if slot.link:
            return semantic(slot)
        return f"{semantics}{slot.location}" if slot.location >= 0 else builtins[slot.variable.builtin]

    def sampling(slot: Slot, semantics: str) -> str:
        word = interpolation(slot.variable)
        return _INTERPOLATION[word] if semantics == "TEXCOORD" and slot.location >= 0 and word else ""

    def declaration(slot: Slot, name: str, semantics: str) -> str:
        variable = printer.variable(parameter_type(slot), name)
        return f"{sampling(slot, semantics)}{variable} : {place_of(slot, semantics)}"

    params = ", ".join([declaration(slot, name, _INPUT_SEMANTICS[stage.kind]) for name, slot in entry_parameters])
    body = entry_body(printer, stage, entry_parameters, resolution, True)
    lines: list[Line] = []
    if len(stage.outputs) == 1:
        (slot,) = stage.outputs
        semantics = _OUTPUT_SEMANTICS[stage.kind]
        head = f"{sampling(slot, semantics)}{printer.type(parameter_type(slot))}"
        signature = f"{head} {name}({params}) : {place_of(slot, semantics)} {{"
        body.append(f"return {output_text(printer, slot)};")
    elif stage.outputs:
        struct, result = f"{stage.kind.capitalize()}Output", "output"
        while struct in taken:
            struct += "_"
        while result in taken:
            result += "_"
        lines.append(Line(f"struct {struct} {{"))
        lines += [
            Line(f"    {declaration(slot, member(slot), _OUTPUT_SEMANTICS[stage.kind])};") for slot in stage.outputs
        ]
        lines += [Line("};"), Line("")]
        signature = f"{struct} {name}({params}) {{"
        body += [f"{struct} {result};"]
        body += [f"{result}.{member(slot)} = {output_text(printer, slot)};" for slot in stage.outputs]
        body.append(f"return {result};")
    else:
        signature = f"void {name}({params}) {{"
    if printer.module.workgroup:
        lines.append(Line(f"[numthreads({', '.join(map(str, printer.module.workgroup))})]"))
    lines += wrap(signature, NOWHERE)
    return [*lines, *[line for text in body for line in wrap(f"    {text}", NOWHERE)], Line("}")]
