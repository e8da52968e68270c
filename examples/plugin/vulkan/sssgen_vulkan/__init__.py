"""Vulkan's GLSL as a target of sssgen: GLSL's printer, but for where uniforms and textures are bound."""

from __future__ import annotations

from pathlib import Path

from sssgen.ir import nodes as ir
from sssgen.targets.printers.glsl import GlslPrinter
from sssgen.targets.printers.printed_lines import Line, with_doc
from sssgen.targets.uniform_layout import Member

DESCRIPTOR = Path(__file__).with_name("vulkan.toml")
"""What the entry point names. The templates lie beside it."""


class VulkanPrinter(GlslPrinter):
    """Vulkan knows no uniform outside of a block; each block and each texture has its set and binding."""

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The material's block. std140 gives the offsets that the reflection tells."""
        if not members:
            return []
        lines = [Line("layout(std140, set = 1, binding = 0) uniform Material {")]
        for member in members:
            text = f"    {self.variable(member.uniform.type, member.uniform.name)};"
            lines.append(with_doc(text, member.uniform))
        return [*lines, Line("};")]

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The textures, at the bindings after the block's."""
        lines = []
        for index, texture in enumerate(textures):
            place = f"layout(set = 1, binding = {self.binding(index)['texture']})"
            lines.append(Line(f"{place} uniform {self.type(texture.type)} {texture.name};", texture.span))
        return lines

    def binding(self, index: int) -> dict[str, int | str]:
        """Where the texture of that number is, for the reflection."""
        return {"group": 1, "texture": 1 + index}
