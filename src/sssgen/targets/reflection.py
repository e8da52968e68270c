"""The reflection JSON of every shader: what the shader needs, the source of each line, and its static cost."""

from __future__ import annotations

from typing import Any

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, Struct, spell
from sssgen.passes.stage.storage_layout import extent, offsets
from sssgen.support.paths import display_name
from sssgen.targets.assemble import Emitted, Program, printer_for, property_name
from sssgen.targets.chain_inputs import CHAIN_INPUTS
from sssgen.targets.descriptor import Target
from sssgen.targets.texture_import import default_color, has_hint, import_of

VERSION = 1
"""The format's version; it is increased when a reader of older files would misread newer ones."""


def reflect(
    target: Target,
    program: Program,
    emitted: Emitted,
    form: str,
) -> dict[str, Any]:
    """Everything that an engine or a tool needs to bind the shader, as JSON."""
    offsets = {member.uniform.name: member for member in emitted.members}
    blocked = bool(target.layout) and target.declares(form)
    uniforms: list[dict[str, Any]] = []
    textures: list[dict[str, Any]] = []
    for uniform in program.module.uniforms:
        source = program.source_names.get(uniform.name, uniform.name)
        technique, own_name = program.owners.get(source, ("", source))
        entry: dict[str, Any] = {"name": uniform.name, "type": spell(uniform.type)}
        entry |= {"source_name": source, "technique": technique, "technique_name": own_name}
        if target.properties.style != "plain":
            entry["property"] = property_name(target, source)
        entry |= _description(uniform)
        if isinstance(uniform.type, Sampler):
            entry |= {"holds": uniform.quantity or None, "default": default_color(uniform)}
            entry |= {"color_space": "linear" if not has_hint(uniform, "source_color") else "sRGB"}
            entry["import"] = import_of(uniform)
            if emitted.bindings:
                entry["binding"] = emitted.bindings[len(textures)]
            textures.append(entry)
        else:
            entry |= {"default": list(uniform.default), "quantity": uniform.quantity or None}
            if blocked:
                entry |= {"offset": offsets[uniform.name].offset, "size": offsets[uniform.name].size}
            uniforms.append(entry)
    sources = {span.file for lines in emitted.lines.values() for span in lines.values()}
    names = {source: display_name(source, program.folder) for source in sources}
    return {
        "format": VERSION,
        "material": program.about.name,
        "shading": program.about.shading,
        "alpha_mode": program.about.alpha_mode,
        "two_sided": program.about.two_sided,
        "raymarched": program.about.raymarched,
        "color": "encoded" if program.encoded else "linear",
        "target": target.name,
        "form": form,
        "files": [
            {"name": target.file_name(output, program.about.name), "stages": output.stages}
            for output in target.files.get(form, ())
            if not output.sources or output.name in emitted.files
        ],
        **_stage(program),
        **_compute(target, program),
        "uniforms": uniforms,
        "uniform_block_size": emitted.block_size if blocked else None,
        "textures": textures,
        "entries": {
            kind: {
                "function": function.name,
                "inputs": list(inputs),
                "params": _signature(kind, emitted),
                "result": spell(function.result),
                "cost": program.costs[kind],
            }
            for kind, (function, inputs) in program.entries.items()
        },
        **_shell(program),
        "proven_safe": program.guards.proven,
        "guards": list(program.guards.rows),
        "renames": dict(program.renames),
        "conventions": _conventions(target),
        "source_map": {
            name: {str(line): f"{names[span.file]}:{span.line}:{span.column}" for line, span in lines.items()}
            for name, lines in emitted.lines.items()
        },
        "warnings": [warning.message for warning in program.warnings],
    }


def _signature(kind: str, emitted: Emitted) -> list[dict[str, Any]]:
    """The parameters of an assembled function in order: what each is, and how this target's shell gets it."""
    params = []
    for index, call in enumerate(emitted.calls[kind]):
        known = CHAIN_INPUTS.get(call["input"])
        entry = {"name": call["name"], "type": call["base"]}
        if known is not None:
            entry |= {"input": call["input"], "meaning": known.meaning, "space": known.space or None}
        else:
            entry |= {"uniform": call["uniform"]}
        entry["expression"] = call["expression"]
        if emitted.embedded_calls:
            others = {name: calls[kind][index]["expression"] for name, calls in emitted.embedded_calls.items()}
            entry["embedded_expressions"] = others
        params.append(entry)
    return params


def _shell(program: Program) -> dict[str, Any]:
    """The function around the chain, with the values that it takes, where the text has it as a function."""
    if program.shell is None:
        return {}
    function, inputs = program.shell
    return {"shell": {"function": function.name, "inputs": list(inputs)}}


def _stage(program: Program) -> dict[str, Any]:
    """The inputs and outputs of a whole shader; its uniforms are listed apart."""
    if program.stage is None:
        return {}
    sides = {"stage_inputs": program.stage.inputs, "stage_outputs": program.stage.outputs}
    return {
        name: [
            {"name": slot.variable.name, "builtin": slot.variable.builtin or None}
            | {"path": list(slot.path), "type": spell(slot.type)}
            | {"location": slot.location if slot.location >= 0 else None, "link": slot.link or None}
            for slot in slots
        ]
        for name, slots in sides.items()
    }


def _compute(target: Target, program: Program) -> dict[str, Any]:
    """The workgroup of a compute shader, and its storage buffers with the layout of their members."""
    module = program.module
    if not module.workgroup:
        return {}
    printer = printer_for(target, module)
    buffers = []
    for variable in printer.buffers:
        assert isinstance(variable.type, Struct)
        places = zip(variable.type.fields, offsets(variable.type, variable.layout), strict=True)
        members = [
            {"name": field.name, "type": spell(field.type), "offset": offset}
            | {"size": extent(field.type, variable.layout).size, "stride": extent(field.type, variable.layout).stride}
            for field, offset in places
        ]
        buffers.append(
            {"name": variable.name, "block": variable.type.name, "access": variable.access or "read_write"}
            | {"layout": variable.layout, "binding": {"binding": printer.buffer_binding(variable)}}
            | {"least_size": extent(variable.type, variable.layout).size, "members": members}
        )
    return {"workgroup_size": list(module.workgroup), "storage_buffers": buffers}


def _conventions(target: Target) -> dict[str, Any]:
    """The conventions that the descriptor declares."""
    declared = {name: value for name, value in target.conventions._asdict().items() if value}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in declared.items()}


def as_text(data: dict[str, Any]) -> str:
    """The reflection as JSON, one uniform, texture or entry a line. (json's own indenting is ten times slower.)"""
    import json

    parts = []
    for key, value in data.items():
        if isinstance(value, list) and value:
            inner = ",\n".join(f"  {json.dumps(item)}" for item in value)
            text = f"[\n{inner}\n ]"
        elif isinstance(value, dict) and value:
            inner = ",\n".join(f"  {json.dumps(name)}: {json.dumps(item)}" for name, item in value.items())
            text = f"{{\n{inner}\n }}"
        else:
            text = json.dumps(value)
        parts.append(f" {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _description(uniform: Uniform) -> dict[str, Any]:
    hints = dict(uniform.hints)
    limits = hints.get("hint_range")
    return {
        "range": list(limits) if limits else None,
        "unit": hints.get("unit", (None,))[0],
        "color": "source_color" in hints,
        "aliases": list(hints.get("alias", ())),
        "drawn": hints.get("drawn", (None,))[0],
        "doc": " ".join(uniform.doc.split()),
    }
