"""The size of a texture and its levels in HLSL, where only a statement gives them: each type of texture has a function.

The rows of builtins call these functions `texture_size` and `texture_levels`; the descriptor reserves the names.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Sampler
from sssgen.ir.walk import all_expressions
from sssgen.targets.printers.printed_lines import Line

_NAMES = ("texture_size", "texture_levels")


class SizeFunction(NamedTuple):
    """A function that the text needs."""

    name: str
    texture: Sampler


def size_functions(function: ir.Function) -> list[SizeFunction]:
    """The functions for the textures whose size or levels a function reads, without duplicates."""
    needed: dict[SizeFunction, None] = {}
    for expr in all_expressions(function.body or ()):
        name = BUILTINS[expr.name].texts.get("hlsl", "").partition("(")[0] if isinstance(expr, ir.Intrinsic) else ""
        if isinstance(expr, ir.Intrinsic) and name in _NAMES:
            texture = expr.args[0].type
            assert isinstance(texture, Sampler)
            needed[SizeFunction(name, texture._replace(shadow=False))] = None  # HLSL compares with the sampler
    return list(needed)


def definition(needed: SizeFunction) -> list[Line]:
    """The lines of such a function."""
    name, texture = needed
    sizes = ["width", "height", *["depth"] * (texture.dim == "3D"), *["layers"] * texture.array]
    outs = ", ".join(sizes)
    if name == "texture_levels":
        return [
            Line(f"int {name}({_texture_type(texture)} map) {{"),
            Line(f"    uint {outs}, levels;"),
            Line(f"    map.GetDimensions(0, {outs}, levels);"),
            Line("    return int(levels);"),
            Line("}"),
            Line(""),
        ]
    if texture.dim == "2DMS":
        return [
            Line(f"int2 {name}({_texture_type(texture)} map) {{"),
            Line("    uint width, height, samples;"),
            Line("    map.GetDimensions(width, height, samples);"),
            Line("    return int2(width, height);"),
            Line("}"),
            Line(""),
        ]
    return [
        Line(f"int{len(sizes)} {name}({_texture_type(texture)} map, int level) {{"),
        Line(f"    uint {outs}, levels;"),
        Line(f"    map.GetDimensions(level, {outs}, levels);"),
        Line(f"    return int{len(sizes)}({outs});"),
        Line("}"),
        Line(""),
    ]


def _texture_type(type_: Sampler) -> str:
    texels = "" if type_.kind == "float" and type_.dim != "2DMS" else f"<{type_.kind}4>"
    return f"Texture{type_.dim}{'Array' if type_.array else ''}{texels}"
