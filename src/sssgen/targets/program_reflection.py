"""The reflection of a program of two stages: one JSON for its attributes, uniforms, textures, samplers and outputs."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence, Set
from typing import NamedTuple, TypeVar

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Array, Matrix, Sampler, Type, components, kind_of, spell
from sssgen.passes.stage.stage_interface import Slot, interpolation
from sssgen.passes.stage.uniform_structs import members
from sssgen.support.diagnostics import failure
from sssgen.targets.assemble import Program
from sssgen.targets.block_places import Member, place_in_block
from sssgen.targets.descriptor import Target
from sssgen.targets.reflection_record import (
    AttributeRecord,
    BufferRecord,
    ImageRecord,
    MemoryUse,
    OutputRecord,
    ProgramMemory,
    ProgramPlace,
    ProgramReflection,
    ProgramTexture,
    ProgramUniform,
    Reflection,
    SourcePlace,
    StageFile,
    TextureBinding,
    UniformBlock,
    VaryingRecord,
)
from sssgen.targets.uniform_layout import place

VERSION = 1
"""The format's version; it is increased when a reader of older files would misread newer ones."""

ROWS = ("bottom-first", "top-first")
"""Where the first row of a picture is: at the bottom, as in OpenGL and WebGL, or at the top, as in WebGPU and D3D."""

_Record = TypeVar("_Record", BufferRecord, ImageRecord)

_ARRAY = re.compile(r"\[(\d+)\]")


class StageFacts(NamedTuple):
    """One stage of a program, translated."""

    program: Program
    reflection: Reflection
    names: Mapping[str, str]
    """A variable's name → its name in the source."""
    uniforms: Sequence[Uniform]
    """Those of the program, under this stage's names, in the order of the program's."""
    own: Set[str]
    """Those of them that the stage itself reads."""
    sampled: Set[str]
    """The textures that it reads with a sampler."""
    passed: Set[str]
    """Those that it gives to functions."""
    blocks: Mapping[tuple[str, str], Member]
    """The members of its uniform blocks."""


def reflect_program(
    name: str, target: Target, rows: str, vertex: StageFacts, fragment: StageFacts
) -> ProgramReflection:
    """What a renderer needs to draw with the program; docs/reflection.md describes it."""
    stages = {"vertex": vertex, "fragment": fragment}
    block, uniforms, textures = _bindings(target, stages)
    return {
        "format": VERSION,
        "program": name,
        "target": target.name,
        "rows": rows if target.conventions.framebuffer_y == "down" else ROWS[0],
        "stages": {kind: _file(facts) for kind, facts in stages.items()},
        "attributes": _attributes(vertex),
        "varyings": _varyings(vertex),
        "outputs": _outputs(fragment),
        "uniform_block": block,
        "uniforms": uniforms,
        "textures": textures,
        **_memory(stages),
        "renames": {kind: facts.reflection["renames"] for kind, facts in stages.items()},
        "warnings": list(dict.fromkeys(text for facts in stages.values() for text in facts.reflection["warnings"])),
    }


def _memory(stages: Mapping[str, StageFacts]) -> ProgramMemory:
    """The storage buffers and images of the program. Raises SssgenError where the stages bind one differently."""
    reflections = {kind: facts.reflection for kind, facts in stages.items()}
    buffers = {kind: reflection.get("storage_buffers", []) for kind, reflection in reflections.items()}
    images = {kind: reflection.get("storage_images", []) for kind, reflection in reflections.items()}
    memory: ProgramMemory = {}
    if any(buffers.values()):
        memory["storage_buffers"] = [{**record, **use} for record, use in _joined(stages, "buffer", buffers)]
    if any(images.values()):
        memory["storage_images"] = [{**record, **use} for record, use in _joined(stages, "image", images)]
    return memory


def _joined(
    stages: Mapping[str, StageFacts], storage: str, records: Mapping[str, Sequence[_Record]]
) -> list[tuple[_Record, MemoryUse]]:
    """Each buffer, or each image, of the program: its record in a stage, its name in the source, and its stages."""
    joined: dict[int, tuple[_Record, MemoryUse]] = {}
    for kind, facts in stages.items():
        declared = [variable for variable in facts.program.module.variables if variable.storage == storage]
        for variable, record in zip(declared, records[kind], strict=True):
            name = facts.names.get(variable.name, variable.name)
            first, use = joined.setdefault(variable.order, (record, {"name": name, "stages": []}))
            use["stages"].append(kind)
            if first["binding"] != record["binding"]:
                places = [each["binding"]["binding"] for each in (first, record)]
                message = f"'{name}' has the binding {places[0]} in one stage, and {places[1]} in the other"
                raise failure(message, "write another binding for it in both stages")
    return [joined[order] for order in sorted(joined)]


def exceeded_limits(program: ProgramReflection, target: Target) -> list[str]:
    """Where a program needs more than every device of the target has."""
    limits, counts = target.limits, list[tuple[str, int, int]]()
    for stage in program["stages"]:
        textures = [texture for texture in program["textures"] if stage in texture["stages"]]
        samplers = [texture for texture in textures if texture["sampler"]]
        counts.append((f"textures in the {stage} shader", len(textures), limits.textures))
        counts.append((f"samplers in the {stage} shader", len(samplers), limits.samplers))
    places = sum(attribute["locations"] for attribute in program["attributes"])
    counts.append(("locations of attributes", places, limits.attributes))
    counts.append(("values between the stages", len(program["varyings"]), limits.varyings))
    block = program["uniform_block"]
    counts.append(("bytes of uniforms", block["size"] if block else 0, limits.uniform_block))
    return [
        f"the program has {count} {what}: devices of {target.title} have at least {least}, and some no more"
        for what, count, least in counts
        if least and count > least
    ]


def _file(facts: StageFacts) -> StageFile:
    (file,) = facts.reflection["files"]
    (entry,) = file["stages"].values()
    return {"file": file["name"], "entry": entry}


def _attributes(vertex: StageFacts) -> list[AttributeRecord]:
    """The inputs of the vertex shader; a matrix has one location a column, an array one an element."""
    assert vertex.program.stage is not None
    slots: dict[str, list[Slot]] = {}
    for slot in vertex.program.stage.inputs:
        if slot.location >= 0:
            slots.setdefault(slot.variable.name, []).append(slot)
    return [
        {
            "name": vertex.names.get(name, name),
            "type": spell(parts[0].variable.type),
            "location": parts[0].location,
            "locations": len(parts),
            "format": _vertex_format(parts[0].type),
        }
        for name, parts in slots.items()
    ]


def _vertex_format(type_: Type) -> str:
    """WebGPU's format of one location, for values that are as precise as the shader's."""
    kind = {"float": "float32", "int": "sint32", "uint": "uint32"}[kind_of(type_)]
    count = components(type_)
    return f"{kind}x{count}" if count > 1 else kind


def _varyings(vertex: StageFacts) -> list[VaryingRecord]:
    """What the vertex shader passes to the fragment shader."""
    assert vertex.program.stage is not None
    return [
        {
            "name": slot.link or vertex.names.get(slot.variable.name, slot.variable.name), "path": list(slot.path),
            "type": spell(slot.type), "location": slot.location,
            "interpolation": interpolation(slot.variable) or "smooth",
        }
        for slot in vertex.program.stage.outputs
        if slot.location >= 0
    ]  # fmt: skip


def _outputs(fragment: StageFacts) -> list[OutputRecord]:
    outputs: list[OutputRecord] = []
    for slot in fragment.reflection["stage_outputs"]:
        name = fragment.names.get(slot["name"], slot["name"])
        output: OutputRecord = {"name": name, "path": slot["path"], "type": slot["type"]}
        if slot["location"] is None:
            output["builtin"] = slot["builtin"]
        else:
            output["location"] = slot["location"]
        outputs.append(output)
    return outputs


def _bindings(
    target: Target, stages: Mapping[str, StageFacts]
) -> tuple[UniformBlock | None, list[ProgramUniform], list[ProgramTexture]]:
    """The block of the uniforms, the uniforms, and the textures with their samplers."""
    first = next(iter(stages.values()))
    placed, size = place(first.uniforms, target.layout)
    offsets = {member.uniform.name: (member.offset, member.size) for member in placed}
    uniforms: list[ProgramUniform] = []
    textures: list[ProgramTexture] = []
    bindings = [texture.get("binding") for texture in first.reflection["textures"]] if target.layout else []
    for index, declared in enumerate(first.uniforms):
        readers = {kind: facts for kind, facts in stages.items() if facts.uniforms[index].name in facts.own}
        reader = next(iter(readers.values()))
        uniform = reader.uniforms[index]
        if isinstance(uniform.type, Sampler):
            names = [(facts.uniforms[index].name, facts) for facts in readers.values()]
            sampled = any(name in facts.sampled for name, facts in names)
            passed = any(name in facts.passed for name, facts in names)
            binding = bindings[len(textures)] if bindings else None
            textures.append(_texture(uniform, list(readers), sampled, passed, binding))
        else:
            own: ProgramPlace = _in_block(uniform.type, *offsets[declared.name]) if target.layout else {}
            source = place_in_block(uniform, reader.blocks)
            uniforms += [_uniform(member, list(readers), source, own) for member in members(uniform)]
    block: UniformBlock | None = None
    if target.layout and uniforms:
        block = {"size": size, "group": target.material_group, "binding": target.bindings.first}
    return block, uniforms, textures


def _uniform(uniform: Uniform, readers: list[str], source: SourcePlace, block: ProgramPlace) -> ProgramUniform:
    """A uniform with the type of an element, and the lengths of the arrays around it, the outermost first.

    Each `[]` in the name takes one of the lengths; one that is left is the length of the uniform itself.
    """
    element = uniform.type.element if isinstance(uniform.type, Array) else uniform.type
    lengths = [int(length) for length in _ARRAY.findall(uniform.path)]
    if isinstance(uniform.type, Array) and not lengths:
        lengths = [uniform.type.length]
    name = _ARRAY.sub("[]", uniform.source).removesuffix("[]")
    return {"name": name, "stages": readers, "type": spell(element), "lengths": lengths, **source, **block}


def _in_block(type_: Type, offset: int, size: int) -> ProgramPlace:
    element = type_.element if isinstance(type_, Array) else type_
    matrix_stride = 16 if isinstance(element, Matrix) else 0
    array_stride = (16 * element.columns if isinstance(element, Matrix) else 16) if isinstance(type_, Array) else 0
    return {"offset": offset, "size": size, "array_stride": array_stride, "matrix_stride": matrix_stride}


def _texture(
    uniform: Uniform, readers: list[str], sampled: bool, passed: bool, binding: TextureBinding | None
) -> ProgramTexture:
    type_ = uniform.type
    assert isinstance(type_, Sampler)
    dimension = type_.dim.removesuffix("MS").lower() + ("-array" if type_.array else "")
    sample = "depth" if type_.shadow else {"int": "sint", "uint": "uint"}.get(type_.kind, "float")
    sampler = "comparison" if type_.shadow else "filtering" if sample == "float" and sampled else "non-filtering"
    return {
        "name": uniform.source,
        "stages": readers,
        "dimension": dimension,
        "sample_type": sample,
        "filterable": sampled and sample == "float",
        "sampler": sampler if sampled or passed else "",
        "multisampled": type_.dim == "2DMS",
        "binding": binding,
    }
