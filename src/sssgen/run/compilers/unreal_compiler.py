"""Unreal's texts: the include file and the Custom node, compiled by DXC behind a stand-in for the engine.

The stand-in declares the names that the text uses, and `unreal_node` makes a function of the Custom node as the engine
does.
"""

from __future__ import annotations

import re
from dataclasses import replace

from sssgen.run.compilers import dxc, unreal_node
from sssgen.run.compilers.calling_entry import hlsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, Message, Source
from sssgen.run.compilers.glslang import LIBRARY_ENTRY


class Unreal(Compiler):
    """Compiles an include file, each function called once, or the Custom node of a text with the file it includes."""

    name = "unreal"

    def __init__(self) -> None:
        self._dxc = dxc.find()

    def version(self) -> str:
        return f"the project's stand-in for Unreal, {self._dxc.version()}"

    def check(self, source: Source) -> list[Message]:
        if not source.text.startswith("Begin Object"):
            return self._compile(unreal_node.before(hlsl_entry(source.text)), LIBRARY_ENTRY)
        try:
            text, node = unreal_node.program(source.text, source.companion)
        except unreal_node.NodeError as error:
            return [Message("error", 0, 0, str(error))]
        textures = unreal_node.textures_of(source.companion)
        return self._compile(text + entry(node.parameters(textures)), LIBRARY_ENTRY)

    def _compile(self, text: str, entry: str) -> list[Message]:
        return [_locate(message) for message in self._dxc.check_hlsl(text, "fragment", entry)]


def _locate(message: Message) -> Message:
    """A message with its line in the included file; another place becomes part of the message."""
    if message.file in ("", unreal_node.INCLUDED):
        return replace(message, file="")
    return Message(message.severity, 0, 0, f"{message.file}:{message.line}: {message.text}")


def entry(parameters: list[tuple[str, str]]) -> str:
    """A fragment entry that calls the node's function with values that are not constants, and returns all outputs."""
    declared, body, results = [], [], []
    arguments = ["(FMaterialPixelParameters)0"]
    for number, (type_, _) in enumerate(parameters):
        variable = f"sssgen_check_{number}"
        if re.match("Texture|Sampler", type_):
            declared.append(f"{type_} {variable};")
        else:
            body.append(f"    {type_.removeprefix('inout ')} {variable} = sssgen_check_position.{_parts(type_)};")
        if type_.startswith("inout "):
            results.append(f"dot({variable}, {variable})" if type_[-1].isdigit() else variable)
        arguments.append(variable)
    call = f"    float3 sssgen_check_color = {unreal_node.FUNCTION}({', '.join(arguments)});"
    head = f"float4 {LIBRARY_ENTRY}(float4 sssgen_check_position : SV_Position) : SV_Target0 {{"
    total = " + ".join(results or ["0.0"])
    return "\n".join([*declared, head, *body, call, f"    return float4(sssgen_check_color, {total});", "}", ""])


def _parts(type_: str) -> str:
    return "xyzw"[: int(type_[-1])] if type_[-1].isdigit() else "x"


def find() -> Unreal:
    """DXC. Raises CompilerMissing."""
    return Unreal()
