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


def texture_types(function: ir.Function) -> list[Sampler]:
    """The types of the textures whose size a function reads, without duplicates."""
    types: dict[Sampler, None] = {}
    for expr in all_expressions(function.body or ()):
        if isinstance(expr, ir.Intrinsic) and _NAME in BUILTINS[expr.name].texts.get("hlsl", ""):
            texture = expr.args[0].type
            assert isinstance(texture, Sampler)
            types[texture._replace(shadow=False)] = None  # HLSL compares with the sampler
    return list(types)


def definition(texture: Sampler) -> list[Line]:
    """The function for a type of texture."""
    sizes = ["width", "height", *["depth"] * (texture.dim == "3D"), *["layers"] * texture.array]
    outs = ", ".join(sizes)
    return [
        Line(f"int{len(sizes)} {_NAME}({_texture_type(texture)} map, int level) {{"),
        Line(f"    uint {outs}, levels;"),
        Line(f"    map.GetDimensions(level, {outs}, levels);"),
        Line(f"    return int{len(sizes)}({outs});"),
        Line("}"),
        Line(""),
    ]


def _texture_type(type_: Sampler) -> str:
    texels = "" if type_.kind == "float" else f"<{type_.kind}4>"
    return f"Texture{type_.dim}{'Array' if type_.array else ''}{texels}"
