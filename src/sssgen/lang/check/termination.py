"""Whether loops end: a GPU stops a program that runs too long."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.contracts import INTEGERS, of_uniform
from sssgen.ir.types import INT, UINT, kind_of
from sssgen.ir.walk import all_expressions, root, statements, subexpressions
from sssgen.lang.check.evaluation_order import OutArguments

Extent: TypeAlias = tuple[float, float]
"""The least and the largest value that an integer can have."""
Extents: TypeAlias = Callable[[str], Extent]
"""Gives the extent of a global value; what is unknown is infinite."""

UNKNOWN: Extent = (float("-inf"), float("inf"))


def ends(
    condition: ir.Expr, steps: ir.Block, body: ir.Block, out_args: OutArguments, extents: Extents = lambda _: UNKNOWN
) -> bool:
    """Whether the condition must become false: every iteration steps an integer counter once, towards a constant bound,
    and the condition is false before the counter passes the last integer, where it wraps around.

    `steps` are the statements that run in every iteration, `body` the others.
    """
    return _fails(condition, steps, writes((*steps, *body, ir.Return(condition, condition.span)), out_args), extents)


def endless(module: ir.Module) -> bool:
    """Whether a module has a loop that is not proven to end; every argument of a call counts as written."""
    extents = {uniform.name: of_uniform(uniform)[:2] for uniform in module.uniforms}
    for constant in module.constants:
        if numbers := constant_numbers(constant.value):
            extents[constant.name] = numbers[0], numbers[0]

    def unproven(stmt: ir.Stmt) -> bool:
        if isinstance(stmt, ir.For):
            steps: ir.Block = (stmt.step,) if stmt.step is not None else ()
            condition, body = stmt.condition, stmt.body
        elif isinstance(stmt, ir.While):
            condition, steps, body = None if skips(stmt.body) else stmt.condition, stmt.body, ()
        else:
            return False
        args: OutArguments = lambda call: call.args  # noqa: E731
        return condition is None or not ends(condition, steps, body, args, lambda name: extents.get(name, UNKNOWN))

    return any(unproven(stmt) for function in module.functions for stmt in statements(function.body or ()))


def _fails(condition: ir.Expr, steps: ir.Block, written: list[str], extents: Extents) -> bool:
    """Whether a condition must become false in a loop that writes `written`."""
    if not isinstance(condition, ir.Binary):
        return False
    if condition.op == "&&":
        return any(_fails(part, steps, written, extents) for part in (condition.left, condition.right))
    return any(
        _approaches(counter, op, bound, steps, written, extents)
        for counter, op, bound in (
            (condition.left, condition.op, condition.right),
            (condition.right, condition.op.translate(str.maketrans("<>", "><")), condition.left),
        )
    )


def skips(block: ir.Block, jumps: tuple[type[ir.Stmt], ...] = (ir.Continue,)) -> bool:
    """Whether a block may `continue` the loop that it is in, or have another jump of that loop."""
    return any(
        isinstance(stmt, jumps)
        or (isinstance(stmt, ir.If) and (skips(stmt.then, jumps) or skips(stmt.otherwise, jumps)))
        for stmt in block
    )


def writes(block: ir.Block, out_args: OutArguments) -> list[str]:
    """The variables that a block writes, with an entry for each write."""
    targets = [stmt.target for stmt in statements(block) if isinstance(stmt, ir.Assign)]
    for expr in all_expressions(block):
        if type(expr) is ir.Call:
            targets.extend(out_args(expr))
    return [variable.name for target in targets if (variable := root(target)) is not None]


def _approaches(
    counter: ir.Expr, op: str, bound: ir.Expr, steps: ir.Block, written: list[str], extents: Extents
) -> bool:
    """Whether `counter op bound` must become false."""
    if not isinstance(counter, ir.Local) or counter.type not in (INT, UINT) or written.count(counter.name) != 1:
        return False
    if any(isinstance(part, ir.Call) or _is_written(part, written) for part in subexpressions(bound)):
        return False
    step = next((size for stmt in steps if (size := _step(stmt, counter.name)) is not None), 0)
    if op == "!=":
        return abs(step) == 1
    (low, high), (first, last) = INTEGERS[kind_of(counter.type)], _extent(bound, extents)
    # the counter after its last step, from the last value for which the condition holds
    if step > 0:
        return op in ("<", "<=") and last - (op == "<") + step <= high
    return step < 0 and op in (">", ">=") and first + (op == ">") + step >= low


def _extent(expr: ir.Expr, extents: Extents) -> Extent:
    """The least and the largest value of an integer expression."""
    low, high = INTEGERS[kind_of(expr.type)]
    first, last = low, high
    if isinstance(expr, ir.Literal):
        return int(expr.value), int(expr.value)
    if isinstance(expr, ir.Global):
        first, last = extents(expr.name)
    elif isinstance(expr, ir.Intrinsic) and expr.name in ("min", "max", "clamp"):
        (first, last), *others = [_extent(arg, extents) for arg in expr.args]
        for choose, (least, largest) in zip(_CHOICES[expr.name], others, strict=True):
            first, last = choose(first, least), choose(last, largest)
    elif isinstance(expr, ir.Binary) and expr.op in ("+", "-"):
        (first, last), (least, largest) = _extent(expr.left, extents), _extent(expr.right, extents)
        first, last = (first + least, last + largest) if expr.op == "+" else (first - largest, last - least)
        if first < low or last > high:  # it may wrap around
            return low, high
    return max(first, low), min(last, high)


_CHOICES: dict[str, tuple[Callable[[float, float], float], ...]] = {"min": (min,), "max": (max,), "clamp": (max, min)}


def _is_written(part: ir.Expr, written: list[str]) -> bool:
    return isinstance(part, ir.Local) and part.name in written


def _step(stmt: ir.Stmt, counter: str) -> int | None:
    """The amount by which a statement steps the counter (`i++`, `i -= 2`, `i = i + 1`), or None."""
    if not isinstance(stmt, ir.Assign) or not _is_written(stmt.target, [counter]):
        return None
    op, value = stmt.op, stmt.value
    if not op and isinstance(value, ir.Binary) and _is_written(value.left, [counter]):
        op, value = value.op, value.right
    if op not in ("+", "-") or not isinstance(value, ir.Literal):
        return None
    return int(value.value) if op == "+" else -int(value.value)
