"""Gives texture reads of a vertex shader the level that they have in GLSL: the lowest.

Why: a vertex has no neighbours to compare with. GLSL reads level 0 there; HLSL and WGSL need it written out.
Place: before `hoist`, which then finds nothing to move.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Expr, Intrinsic, Literal, Module
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import FLOAT
from sssgen.passes.explicit_levels import at_level


def with_levels(module: Module) -> Module:
    """The module with level 0 for every read that would choose its own, where there is such a builtin."""
    return rewrite_module(module, _with_level)


def _with_level(expr: Expr) -> Expr:
    if not isinstance(expr, Intrinsic) or BUILTINS[expr.name].with_level is None:
        return expr
    return at_level(expr, Literal(FLOAT, 0.0, expr.span)) or expr
