"""The entry function of a stage in WGSL: attributes for locations and builtins, a struct for several outputs."""

from __future__ import annotations

from sssgen.ir.nodes import NOWHERE
from sssgen.passes.scopes import names_of
from sssgen.passes.stage.stage_interface import Slot, Stage, interpolation
from sssgen.targets.printers.entry_points import entry_body, member, output_text, parameter_type, parameters
from sssgen.targets.printers.printed_lines import Line, wrap
from sssgen.targets.printers.printer import Printer

_INTERPOLATION = {"flat": "flat", "noperspective": "linear", "centroid": "perspective, centroid"}


def print_entry(printer: Printer, stage: Stage, name: str, resolution: str) -> list[Line]:
    """The lines of the entry `name`; `resolution` is how that uniform is read."""
    taken = names_of(printer.module) | {name}
    builtins = printer.target.stage_builtins
    entry_parameters = parameters(stage, taken)

    def attributes(slot: Slot, varying: bool) -> str:
        if slot.location < 0:
            return f"@builtin({builtins[slot.variable.builtin]})"
        word = interpolation(slot.variable)
        sampled = f" @interpolate({_INTERPOLATION[word]})" if varying and word else ""
        return f"@location({slot.location}){sampled}"

    def declaration(slot: Slot, name: str, varying: bool) -> str:
        return f"{attributes(slot, varying)} {printer.variable(parameter_type(slot), name)}"

    params = ", ".join([declaration(slot, name, stage.kind == "fragment") for name, slot in entry_parameters])
    body = entry_body(printer, stage, entry_parameters, resolution, False)
    lines: list[Line] = []
    result = ""
    if len(stage.outputs) == 1:
        (slot,) = stage.outputs
        result = f" -> {attributes(slot, stage.kind == 'vertex')} {printer.type(parameter_type(slot))}"
        body.append(f"return {output_text(printer, slot)};")
    elif stage.outputs:
        struct = f"{stage.kind.capitalize()}Output"
        while struct in taken:
            struct += "_"
        lines.append(Line(f"struct {struct} {{"))
        lines += [Line(f"    {declaration(slot, member(slot), stage.kind == 'vertex')},") for slot in stage.outputs]
        lines += [Line("}"), Line("")]
        result = f" -> {struct}"
        body.append(f"return {struct}({', '.join([output_text(printer, slot) for slot in stage.outputs])});")
    sizes = f" @workgroup_size({', '.join(map(str, printer.module.workgroup))})" if printer.module.workgroup else ""
    lines += [Line(f"@{stage.kind}{sizes}"), *wrap(f"fn {name}({params}){result} {{", NOWHERE)]
    return [*lines, *[line for text in body for line in wrap(f"    {text}", NOWHERE)], Line("}")]
