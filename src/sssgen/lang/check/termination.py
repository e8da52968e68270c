"""Whether loops end: a GPU stops a program that runs too long."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, UINT
from sssgen.ir.walk import all_expressions, root, statements, subexpressions
from sssgen.lang.check.evaluation_order import OutArguments


def ends(condition: ir.Expr, steps: ir.Block, body: ir.Block, out_args: OutArguments) -> bool:
    """Whether the condition must become false: every iteration steps an integer counter once, towards a constant bound.

    `steps` are the statements that run in every iteration, `body` the others.
    """
    return _fails(condition, steps, writes((*steps, *body, ir.Return(condition, condition.span)), out_args))


def endless(function: ir.Function) -> bool:
    """Whether a function has a loop that is not proven to end; every argument of a call counts as written."""
    for stmt in statements(function.body or ()):
        if isinstance(stmt, ir.For):
            steps = (stmt.step,) if stmt.step is not None else ()
            if stmt.condition is None or not ends(stmt.condition, steps, stmt.body, lambda call: call.args):
                return True
        elif isinstance(stmt, ir.While) and (
            skips(stmt.body) or not ends(stmt.condition, stmt.body, (), lambda call: call.args)
        ):
            return True
    return False


def _fails(condition: ir.Expr, steps: ir.Block, written: list[str]) -> bool:
    """Whether a condition must become false in a loop that writes `written`."""
    if not isinstance(condition, ir.Binary):
        return False
    if condition.op == "&&":
        return _fails(condition.left, steps, written) or _fails(condition.right, steps, written)
    return any(
        _approaches(counter, op, bound, steps, written)
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


def _approaches(counter: ir.Expr, op: str, bound: ir.Expr, steps: ir.Block, written: list[str]) -> bool:
    """Whether `counter op bound` must become false."""
    if not isinstance(counter, ir.Local) or counter.type not in (INT, UINT) or written.count(counter.name) != 1:
        return False
    if any(isinstance(part, ir.Call) or _is_written(part, written) for part in subexpressions(bound)):
        return False
    step = next((size for stmt in steps if (size := _step(stmt, counter.name)) is not None), 0)
    limit = bound.value if isinstance(bound, ir.Literal) else None
    if step > 0:
        return op == "<" or (op == "<=" and limit not in (2**31 - 1, 2**32 - 1)) or (op == "!=" and step == 1)
    if counter.type == UINT:  # below 0 it wraps around
        return step == -1 and (op in (">", "!=") or (op == ">=" and limit is not None and limit > 0))
    return step < 0 and (op == ">" or (op == ">=" and limit != -(2**31)) or (op == "!=" and step == -1))


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
