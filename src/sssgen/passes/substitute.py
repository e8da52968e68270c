"""Replaces the call of a short function of the intrinsic table (a polyfill, a guard) by its expression."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite
from sssgen.ir.walk import subexpressions

_OF_THE_TABLE = ("intrinsics/", "guards/")


def is_cheap(expr: ir.Expr) -> bool:
    """Whether evaluating an expression twice costs nothing."""
    if isinstance(expr, ir.Swizzle | ir.Member):
        return is_cheap(expr.value)
    if isinstance(expr, ir.Construct) and len(expr.args) == 1:
        return is_cheap(expr.args[0])
    return isinstance(expr, ir.Local | ir.Global | ir.Literal)


def return_expression(module: ir.Module) -> ir.Expr | None:
    """The expression that the module's only function returns; None where it is not a single expression."""
    body = module.functions[-1].body or ()
    if len(module.functions) != 1 or len(body) != 1 or not isinstance(body[0], ir.Return):
        return None
    return body[0].value


def inline(module: ir.Module, args: Sequence[ir.Expr], span: ir.Span, may_repeat: bool = True) -> ir.Expr | None:
    """The expression that the module's only function returns for these arguments; None where a call is better.

    A call is better if the function is not a single expression, or if it would repeat an argument: an expensive one,
    or, unless `may_repeat`, any.
    """
    function, value = module.functions[-1], return_expression(module)
    if value is None:
        return None
    uses: dict[str, int] = {}
    for part in subexpressions(value):
        if isinstance(part, ir.Local):
            uses[part.name] = uses.get(part.name, 0) + 1
    arguments = {param.name: arg for param, arg in zip(function.params, args, strict=True)}
    if any(uses.get(name, 0) > 1 and not (may_repeat and is_cheap(arg)) for name, arg in arguments.items()):
        return None
    result = rewrite(value, lambda part: arguments[part.name] if isinstance(part, ir.Local) else part)
    # in the source it is the call
    return rewrite(result, lambda part: part._replace(span=span) if part.span.file.startswith(_OF_THE_TABLE) else part)


def with_larger_bound(module: ir.Module, args: Sequence[ir.Expr]) -> ir.Expr | None:
    """`max(x, bound)` of a `max` or `clamp`: that with the larger bound; of a `min`: a `clamp`; otherwise None."""
    body = module.functions[-1].body or ()
    value = body[0].value if len(body) == 1 and isinstance(body[0], ir.Return) else None
    if not isinstance(value, ir.Intrinsic) or value.name != "max" or not isinstance(value.args[1], ir.Literal):
        return None
    (inner,) = args
    if not isinstance(inner, ir.Intrinsic) or inner.name not in ("min", "max", "clamp"):
        return None
    new, bounds = value.args[1], inner.args[1:]
    lower, upper = (new, *bounds) if inner.name == "min" else (*bounds, new)[:2]
    if not isinstance(lower, ir.Literal) or lower.value > new.value:
        return None
    if not isinstance(upper, ir.Literal) or upper.value < new.value:  # it would undo the larger bound
        return None
    args = inner.args[0], new._replace(span=inner.args[1].span), *(bounds[-1:] if inner.name != "max" else ())
    return inner._replace(name="max" if inner.name == "max" else "clamp", args=args)
