"""Prints GLSL: 3.30 core and ES 3.00, the language that the IR is closest to."""

from __future__ import annotations

from ..ir import nodes as ir
from .layout import Member
from .printer import Line, Printer, documented


class GlslPrinter(Printer):
    """Uniforms stand in the default block; everything else is as in the IR."""

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The uniform declarations, one a line."""
        return [
            documented(f"uniform {self.variable(member.uniform.type, member.uniform.name)};", member.uniform)
            for member in members
        ]

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The samplers, one a line; ES has no default precision for all of them."""
        precision = self.target.table.get("sampler_precision", {})
        lines = []
        for texture in textures:
            type_ = self.type(texture.type)
            lines.append(documented(f"uniform {precision.get(type_, '')}{type_} {texture.name};", texture))
        return lines
