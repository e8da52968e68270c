"""The entry function of a stage in languages where inputs and outputs are parameters and results.

It copies its parameters to the module's variables, calls the author's main function, and returns the values of the
output variables. `wgsl_entry` and `hlsl_entry` print it; this module has what they share.

gl_FragCoord counts y from the bottom in GLSL and from the top in WebGPU and D3D, where its w is that of the clip
space in D3D. gl_Position.z goes from -w to w in GLSL, from 0 to w in the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir.types import INT, UINT, Type
from sssgen.passes.scopes import claim
from sssgen.passes.stage.stage_interface import Slot, Stage
from sssgen.targets.printers.printer import Printer


class EntryParameter(NamedTuple):
    """A parameter of the entry: its name, and the slot whose value it is."""

    name: str
    slot: Slot


def parameters(stage: Stage, taken: set[str]) -> list[EntryParameter]:
    """A parameter for each input."""
    return [
        EntryParameter(claim("_".join([slot.variable.name, "in", *map(str, slot.path)]), taken), slot)
        for slot in stage.inputs
    ]


def place_text(slot: Slot) -> str:
    """A slot as an expression."""
    return slot.variable.name + "".join([f".{step}" if isinstance(step, str) else f"[{step}]" for step in slot.path])


def output_text(printer: Printer, slot: Slot) -> str:
    """An output as the entry returns it."""
    return f"{printer.type(UINT)}({place_text(slot)})" if is_count(slot) else place_text(slot)


def member(slot: Slot) -> str:
    """A slot's name in a struct."""
    return "_".join([slot.variable.name, *map(str, slot.path)])


def is_count(slot: Slot) -> bool:
    """Whether it is a builtin that is an int in GLSL and a uint elsewhere."""
    return slot.location < 0 and slot.type == INT


def parameter_type(slot: Slot) -> Type:
    """The type of a slot as a parameter or result."""
    return UINT if is_count(slot) else slot.type


def entry_body(
    printer: Printer, stage: Stage, inputs: Sequence[EntryParameter], resolution: str, clip_w: bool
) -> list[str]:
    """The statements of the entry before its return: `inputs` are its parameters."""
    body = [
        f"{place_text(slot)} = {f'{printer.type(INT)}({name})' if is_count(slot) else name};"
        for name, slot in inputs
        if slot.is_declared
    ]
    body += fragment_coordinates(stage, resolution, clip_w)
    return [*body, f"{printer.by_key[stage.function].name}();", *clip_space(stage)]


def fragment_coordinates(stage: Stage, resolution: str, clip_w: bool) -> list[str]:
    """Statements that give gl_FragCoord its meaning in GLSL."""
    lines = []
    for slot in stage.inputs:
        if slot.variable.builtin == "gl_FragCoord":
            name = slot.variable.name
            if stage.resolution:
                lines.append(f"{name}.y = {resolution}.y - {name}.y;")
            if clip_w:
                lines.append(f"{name}.w = 1.0 / {name}.w;")
    return lines


def clip_space(stage: Stage) -> list[str]:
    """Statements that map the depth of gl_Position from [-w, w] to [0, w], and turn the picture where it is upended."""
    lines = []
    for slot in stage.outputs:
        if slot.variable.builtin == "gl_Position":
            name = slot.variable.name
            if stage.upends:
                lines.append(f"{name}.y = -{name}.y;")
            lines.append(f"{name}.z = ({name}.z + {name}.w) * 0.5;")
    return lines
