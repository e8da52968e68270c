"""Gives texture reads of a vertex shader the level that they have in GLSL: the lowest.

Why: a vertex has no neighbours to compare with. GLSL reads level 0 there; HLSL and WGSL need it written out.
Place: before `hoist`, which then finds nothing to move.
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Expr, Intrinsic, Literal, Module
from sssgen.ir.signatures import resolve
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import FLOAT


def with_levels(module: Module) -> Module:
    """The module with level 0 for every read that would choose its own, where there is such a builtin."""
    return rewrite_module(module, _with_level)


def _with_level(expr: Expr) -> Expr:
    row = BUILTINS[expr.name] if isinstance(expr, Intrinsic) else None
    if not isinstance(expr, Intrinsic) or row is None or row.with_level is None:
        return expr
    name, position, explicit = row.with_level
    level = (Literal(FLOAT, 0.0, expr.span),) if explicit else ()
    # a constant offset comes next; a bias, which comes last, has no meaning here
    args = (*expr.args[:position], *level, *expr.args[position : position + len(row.constant)])
    exists = resolve(name, [arg.type for arg in args]) == expr.type
    return Intrinsic(expr.type, name, args, expr.span) if exists else expr
