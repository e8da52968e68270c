"""Whether two stages that were transpiled apart agree on what the vertex shader passes to the fragment shader."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from sssgen.passes.capabilities import Capabilities
from sssgen.run.check.shader_files import Shader
from sssgen.targets import registry
from sssgen.targets.reflection_record import SlotRecord


def pairs(shaders: Sequence[Shader]) -> Iterator[tuple[Shader, Shader]]:
    """The vertex and fragment shaders of one program: those of one target with one name, up to the first dot, in one
    folder; or the only two of a target."""
    for target in dict.fromkeys(shader.reflection["target"] for shader in shaders if shader.reflection):
        own = [shader for shader in shaders if shader.reflection and shader.reflection["target"] == target]
        stages = [shader for shader in own if _kind(shader)]
        programs: dict[str, list[Shader]] = {}
        for shader in stages:
            folder, base = os.path.split(shader.name)
            programs.setdefault(os.path.join(folder, base.partition(".")[0]), []).append(shader)
        for program in [stages] if len(stages) == 2 else programs.values():
            both = sorted(program, key=_kind, reverse=True)
            if [_kind(shader) for shader in both] == ["vertex", "fragment"]:
                yield both[0], both[1]


def _kind(shader: Shader) -> str:
    """vertex or fragment; '' for a file that has not one of these stages alone."""
    form = shader.reflection.get("form", "") if shader.reflection else ""
    return form if form in ("vertex", "fragment") else ""


def disagreements(vertex: Shader, fragment: Shader) -> list[str]:
    """Where the fragment shader does not get what it expects."""
    assert vertex.reflection is not None and fragment.reflection is not None
    capabilities = registry.load(fragment.reflection["target"]).capabilities
    outputs = [slot for slot in vertex.reflection["stage_outputs"] if not slot["builtin"]]
    inputs = [slot for slot in fragment.reflection["stage_inputs"] if not slot["builtin"]]
    messages = [message for slot in inputs for message in _disagreements_of(slot, outputs, capabilities)]
    if not messages and not capabilities.subset_varyings and len(inputs) < len(outputs):
        messages.append(f"the inputs are fewer than the outputs of {vertex.name}: transpile this file --with the other")
    return messages


def _disagreements_of(input_: SlotRecord, outputs: Sequence[SlotRecord], capabilities: Capabilities) -> Iterator[str]:
    name = input_["name"] + "".join(f"[{index}]" for index in input_["path"])
    partner = next((output for output in outputs if _same(input_, output)), None)
    if partner is None:
        yield f"the vertex shader has no output '{name}'"
    elif partner["type"] != input_["type"]:
        yield f"'{name}' is {input_['type']} here, but {partner['type']} in the vertex shader"
    elif partner["location"] != input_["location"] and not capabilities.named_varyings:
        places = f"has location {input_['location']} here, but {partner['location']} in the vertex shader"
        yield f"'{name}' {places}: transpile this file --with the other"


def _same(input_: SlotRecord, output: SlotRecord) -> bool:
    """Whether these are matched in GLSL: by name, or by location where both state one."""
    if input_["link"] is None or output["link"] is None:
        return input_["link"] == output["link"] and input_["location"] == output["location"]
    return (input_["link"], input_["path"]) == (output["link"], output["path"])
