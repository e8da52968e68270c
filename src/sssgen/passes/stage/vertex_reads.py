"""Gives texture reads of a vertex shader the level that they have in GLSL: the lowest.

Why: a vertex has no neighbours to compare with. GLSL reads level 0 there; HLSL and WGSL want it said.
Place: before `hoist`, which then finds nothing to move.
"""

from __future__ import annotations

from sssgen.ir.nodes import Expr, Intrinsic, Literal, Module
from sssgen.ir.signatures import resolve
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import FLOAT


def with_levels(module: Module) -> Module:
    """The module with level 0 for every read that would choose its own, where there is such a builtin."""
    return rewrite_module(module, _with_level)


def _with_level(expr: Expr) -> Expr:
    if not isinstance(expr, Intrinsic) or expr.name not in _LEVEL_AT:
        return expr
    name, place, after = _LEVEL_AT[expr.name]
    level = (Literal(FLOAT, 0.0, expr.span),) if name != "textureCompareLod" else ()
    # a bias, which comes last, is of no meaning here
    args = (*expr.args[:place], *level, *expr.args[place : place + after])
    known = resolve(name, [arg.type for arg in args]) == expr.type
    return Intrinsic(expr.type, name, args, expr.span) if known else expr


_LEVEL_AT = {
    "texture": ("textureLod", 2, 0),
    "textureOffset": ("textureLodOffset", 2, 1),
    "textureLayer": ("textureLayerLod", 3, 0),
    "textureCompare": ("textureCompareLod", 3, 0),
}
"""A read → the one with a level, behind how many arguments that stands, and how many are behind it."""
