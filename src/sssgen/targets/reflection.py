"""The reflection JSON of every shader: what the shader needs, the source of each line, and its static cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from sssgen.ir.frame_passes import FRAME_PASSES, passes_of
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, Struct, spell
from sssgen.passes.stage.stage_interface import Slot
from sssgen.passes.stage.storage_layout import extent, has_buffers, offsets
from sssgen.passes.stage.uniform_structs import members
from sssgen.support.paths import display_name
from sssgen.targets.assemble import Emitted, Program, needed, printer_for
from sssgen.targets.chain_inputs import CHAIN_INPUTS
from sssgen.targets.descriptor import Target
from sssgen.targets.parameter_variables import property_name
from sssgen.targets.texture_import import default_color, has_hint, import_of

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import (
        BindingRecord,
        BlockPlace,
        BufferMember,
        BufferRecord,
        DeclarationRecord,
        EmbeddedExpressions,
        ImageRecord,
        Kernel,
        NameRecord,
        ParameterRecord,
        ParameterSource,
        PassRecord,
        Reflection,
        ShellPart,
        SlotRecord,
        StageInterface,
        TextureRecord,
        UniformRecord,
    )

VERSION = 1
"""The format's version; it is increased when a reader of older files would misread newer ones."""


def reflect(
    target: Target,
    program: Program,
    emitted: Emitted,
    form: str,
) -> Reflection:
    """Everything that an engine or a tool needs to bind the shader, as JSON."""
    offsets = {member.uniform.name: member for member in emitted.members}
    blocked = bool(target.layout) and target.declares(form)
    uniforms: list[UniformRecord] = []
    textures: list[TextureRecord] = []
    for uniform in [member for declared in program.module.uniforms for member in members(declared)]:
        declared, quantity = _declared(target, program, uniform), uniform.quantity or None
        if isinstance(uniform.type, Sampler):
            color_space = "linear" if not has_hint(uniform, "source_color") else "sRGB"
            bound: BindingRecord = {"binding": emitted.bindings[len(textures)]} if emitted.bindings else {}
            textures.append(
                {
                    **declared, "holds": quantity, "default": default_color(uniform),
                    "needed": needed(program, uniform),
                    "color_space": color_space, "import": import_of(uniform), **bound,
                }
            )  # fmt: skip
        else:
            place: BlockPlace = {}
            if blocked:
                place = {"offset": offsets[uniform.name].offset, "size": offsets[uniform.name].size}
            uniforms.append(
                {
                    **declared,
                    "default": list(uniform.default),
                    "quantity": quantity,
                    "placed": has_hint(uniform, "placed"),
                    **place,
                }
            )
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
            if not (output.sources or output.needs) or target.file_name(output, program.about.name) in emitted.files
        ],
        **_stage(program),
        **_compute(target, program),
        "uniforms": uniforms,
        "uniform_block_size": emitted.block_size if blocked else None,
        "textures": textures,
        "passes": _passes(program),
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


def _signature(kind: str, emitted: Emitted) -> list[ParameterRecord]:
    """The parameters of an assembled function in order: what each is, and how this target's shell gets it."""
    params: list[ParameterRecord] = []
    for index, call in enumerate(emitted.calls[kind]):
        known = CHAIN_INPUTS.get(call["input"])
        source: ParameterSource = {"uniform": call["uniform"]}
        if known is not None:
            source = {"input": call["input"], "meaning": known.meaning, "space": known.space or None}
        embedded: EmbeddedExpressions = {}
        if emitted.embedded_calls:
            others = {name: calls[kind][index]["expression"] for name, calls in emitted.embedded_calls.items()}
            embedded = {"embedded_expressions": others}
        params.append(
            {"name": call["name"], "type": call["base"], **source, "expression": call["expression"], **embedded}
        )
    return params


def _shell(program: Program) -> ShellPart:
    """The function around the chain, with the values that it takes, where the text has it as a function."""
    if program.shell is None:
        return {}
    function, inputs = program.shell
    return {"shell": {"function": function.name, "inputs": list(inputs)}}


def _stage(program: Program) -> StageInterface:
    """The inputs and outputs of a whole shader; its uniforms are listed apart."""
    if program.stage is None:
        return {}
    return {"stage_inputs": _slots(program.stage.inputs), "stage_outputs": _slots(program.stage.outputs)}


def _slots(slots: Sequence[Slot]) -> list[SlotRecord]:
    return [
        {
            "name": slot.variable.name, "builtin": slot.variable.builtin or None,
            "path": list(slot.path), "type": spell(slot.type),
            "location": slot.location if slot.location >= 0 else None, "link": slot.link or None,
        }
        for slot in slots
    ]  # fmt: skip


def _compute(target: Target, program: Program) -> Kernel:
    """The workgroup of a compute shader, and storage buffers with the layout of their members."""
    module = program.module
    size: Kernel = {"workgroup_size": list(module.workgroup)} if module.workgroup else {}
    if not module.workgroup and not has_buffers(module):
        return {}
    printer = printer_for(target, module)
    buffers: list[BufferRecord] = []
    for variable in printer.buffers:
        assert isinstance(variable.type, Struct)
        places = zip(variable.type.fields, offsets(variable.type, variable.layout), strict=True)
        members: list[BufferMember] = [
            {
                "name": field.name, "type": spell(field.type), "offset": offset,
                "size": extent(field.type, variable.layout).size, "stride": extent(field.type, variable.layout).stride,
            }
            for field, offset in places
        ]  # fmt: skip
        buffers.append(
            {
                "name": variable.name, "block": variable.type.name, "access": variable.access or "read_write",
                "layout": variable.layout, "binding": {"binding": printer.buffer_binding(variable)},
                "least_size": extent(variable.type, variable.layout).size, "members": members,
            }
        )  # fmt: skip
    images: list[ImageRecord] = [
        {
            "name": variable.name, "type": spell(variable.type), "format": variable.layout,
            "access": variable.access or "read_write", "binding": {"binding": printer.image_binding(variable)},
        }
        for variable in printer.images
    ]  # fmt: skip
    return {**size, "storage_buffers": buffers, **({"storage_images": images} if images else {})}


def _conventions(target: Target) -> dict[str, str | list[float]]:
    """The conventions that the descriptor declares."""
    declared = {name: value for name, value in target.conventions._asdict().items() if value}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in declared.items()}


def as_text(data: Mapping[str, object]) -> str:
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


def _passes(program: Program) -> list[PassRecord]:
    """The passes of a material; plain GLSL has none."""
    records: list[PassRecord] = []
    for use in passes_of(program.module.uniforms):
        drawn = FRAME_PASSES[use.name]
        texture, *views = [program.source_names.get(one.name, one.name) for one in (use.texture, *use.views)]
        lights, size = [one and program.source_names.get(one.name, one.name) for one in (use.lights, use.size)]
        records.append(
            {
                "name": use.name, "of": drawn.of, "seen_from": drawn.seen_from, "layers": list(drawn.layers),
                "empty": drawn.empty, "texture": texture, "views": views, "lights": lights, "size": size,
            }
        )  # fmt: skip
    return records


def _declared(target: Target, program: Program, uniform: Uniform) -> DeclarationRecord:
    source = program.source_names.get(uniform.name, uniform.name)
    technique, own_name = program.owners.get(source, ("", source))
    names: NameRecord = {
        "name": uniform.name, "type": spell(uniform.type), "source_name": source,
        "technique": technique, "technique_name": own_name,
    }  # fmt: skip
    if target.properties.style != "plain":
        names["property"] = property_name(target, source)
    hints: dict[str, tuple[Any, ...]] = dict(uniform.hints)
    limits = hints.get("hint_range")
    return {
        **names,
        "range": list(limits) if limits else None,
        "unit": hints.get("unit", (None,))[0],
        "color": "source_color" in hints,
        "aliases": list(hints.get("alias", ())),
        "drawn": hints.get("drawn", (None,))[0],
        "doc": " ".join(uniform.doc.split()),
    }
