"""Puts a short function of the intrinsic table (a polyfill, a guard) in the place of its call."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite
from sssgen.ir.walk import subexpressions

_OURS = ("intrinsics/", "guards/")


def is_cheap(expr: ir.Expr) -> bool:
    """Whether writing an expression twice costs nothing."""
    if isinstance(expr, ir.Swizzle | ir.Member):
        return is_cheap(expr.value)
    if isinstance(expr, ir.Construct) and len(expr.args) == 1:
        return is_cheap(expr.args[0])
    return isinstance(expr, ir.Local | ir.Global | ir.Literal)


def in_place(module: ir.Module, args: Sequence[ir.Expr], span: ir.Span, twice: bool = True) -> ir.Expr | None:
    """The expression that the module's only function returns, of these arguments; None where a call is better.

    It is one where an argument would stand in it `twice` that is dear, or any if that is not wanted, and where the
    function is no single expression.
    """
    function = module.functions[-1]
    body = function.body or ()
    if len(module.functions) != 1 or len(body) != 1 or not isinstance(body[0], ir.Return) or body[0].value is None:
        return None
    value = body[0].value
    uses: dict[str, int] = {}
    for part in subexpressions(value):
        if isinstance(part, ir.Local):
            uses[part.name] = uses.get(part.name, 0) + 1
    given = {param.name: arg for param, arg in zip(function.params, args, strict=True)}
    if any(uses.get(name, 0) > 1 and not (twice and is_cheap(arg)) for name, arg in given.items()):
        return None
    placed = rewrite(value, lambda part: given[part.name] if isinstance(part, ir.Local) else part)
    # what it computes stems from its call
    return rewrite(placed, lambda part: part._replace(span=span) if part.span.file.startswith(_OURS) else part)


def widened_bound(module: ir.Module, args: Sequence[ir.Expr]) -> ir.Expr | None:
    """`max(x, bound)` of what has a lower bound already, with the larger one in its place; None for anything else."""
    body = module.functions[-1].body or ()
    value = body[0].value if len(body) == 1 and isinstance(body[0], ir.Return) else None
    if not isinstance(value, ir.Intrinsic) or value.name != "max" or not isinstance(value.args[1], ir.Literal):
        return None
    (inner,) = args
    if not isinstance(inner, ir.Intrinsic) or inner.name not in ("max", "clamp"):
        return None
    old, new = inner.args[1], value.args[1]
    if not isinstance(old, ir.Literal) or old.value > new.value:
        return None
    return inner._replace(args=(inner.args[0], new._replace(span=old.span), *inner.args[2:]))
