"""The size of a texture in HLSL, where only a statement gives it: each type of texture gets a function.

The intrinsic table calls that function `texture_size`; the descriptor reserves the name.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import Sampler
from sssgen.ir.walk import all_expressions
from sssgen.targets.printers.printer import Line


def asked(function: ir.Function) -> list[str]:
    """The types, in HLSL, of the textures whose size a function reads, without duplicates."""
    found: dict[str, None] = {}
    for expr in all_expressions(function.body or ()):
        if isinstance(expr, ir.Intrinsic) and expr.name == "textureSize" and isinstance(expr.args[0].type, Sampler):
            found[_spelled(expr.args[0].type)] = None
    return list(found)


def definition(texture: str) -> list[Line]:
    """The function for a type of texture."""
    parts = ["width", "height"]
    parts += ["depth"] * texture.startswith("Texture3D") + ["layers"] * ("Array" in texture)
    listed = ", ".join(parts)
    return [
        Line(f"int{len(parts)} texture_size({texture} map, int level) {{"),
        Line(f"    uint {listed}, levels;"),
        Line(f"    map.GetDimensions(level, {listed}, levels);"),
        Line(f"    return int{len(parts)}({listed});"),
        Line("}"),
        Line(""),
    ]


def _spelled(type_: Sampler) -> str:
    texels = "" if type_.kind == "float" else f"<{type_.kind}4>"
    return f"Texture{type_.dim}{'Array' if type_.array else ''}{texels}"
