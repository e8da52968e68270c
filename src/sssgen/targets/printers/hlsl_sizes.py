"""The size of a texture in HLSL, where only a statement gives it: each type of texture gets a function.

The rows of builtins call that function `texture_size`; the descriptor reserves the name.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Sampler
from sssgen.ir.walk import all_expressions
from sssgen.targets.printers.printed_lines import Line

_NAME = "texture_size"


def texture_types(function: ir.Function) -> list[str]:
    """The types, in HLSL, of the textures whose size a function reads, without duplicates."""
    types: dict[str, None] = {}
    for expr in all_expressions(function.body or ()):
        if isinstance(expr, ir.Intrinsic) and _NAME in BUILTINS[expr.name].texts.get("hlsl", ""):
            texture = expr.args[0].type
            assert isinstance(texture, Sampler)
            types[_spelled(texture)] = None
    return list(types)


def definition(texture: str) -> list[Line]:
    """The function for a type of texture."""
    sizes = ["width", "height"]
    sizes += ["depth"] * texture.startswith("Texture3D") + ["layers"] * ("Array" in texture)
    outs = ", ".join(sizes)
    return [
        Line(f"int{len(sizes)} {_NAME}({texture} map, int level) {{"),
        Line(f"    uint {outs}, levels;"),
        Line(f"    map.GetDimensions(level, {outs}, levels);"),
        Line(f"    return int{len(sizes)}({outs});"),
        Line("}"),
        Line(""),
    ]


def _spelled(type_: Sampler) -> str:
    texels = "" if type_.kind == "float" else f"<{type_.kind}4>"
    return f"Texture{type_.dim}{'Array' if type_.array else ''}{texels}"
