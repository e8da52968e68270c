"""Finds the control flow that is the same in all lanes, where Python's own `if` and loops can be used.

A condition is uniform if it consists of literals, module constants, and variables computed from these alone.
Inputs (parameters, uniforms, textures) may differ from lane to lane. Used by `predicate`.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, UINT, Scalar
from sssgen.ir.walk import expressions, root, statements, subexpressions
from sssgen.passes.lift_calls import Functions, out_arguments


class Count(NamedTuple):
    """A loop that counts: `name` goes from `start` by `step` while `name op stop`."""

    name: str
    start: ir.Expr
    stop: ir.Expr
    op: str
    step: int


class LoopFacts(NamedTuple):
    """How a loop is to be run."""

    counted: bool
    """As `for … in range(…)`."""
    masked: bool
    """As a `while` with a mask, because its condition differs from lane to lane, or because lanes leave it."""
    jumps: frozenset[str]
    """The kinds of jumps that only some lanes execute: break, continue, return (also for discard)."""

    @property
    def diverges(self) -> bool:
        """Whether the loop's body runs for some lanes only."""
        return self.masked or bool(self.jumps)


def count(loop: ir.For) -> Count | None:
    """The loop's counter if it has one that only the loop's own step changes, else None."""
    init, test, step = loop.init, loop.condition, loop.step
    if not isinstance(init, ir.Declare) or init.value is None or init.type not in (INT, UINT):
        return None
    if not isinstance(test, ir.Binary) or test.op not in ("<", "<=", ">", ">="):
        return None
    if not isinstance(step, ir.Assign) or step.op not in ("+", "-") or not isinstance(step.value, ir.Literal):
        return None
    if not isinstance(test.left, ir.Local) or test.left.name != init.name or root(step.target) != step.target:
        return None
    if any(isinstance(part, ir.Local) and part.name == init.name for part in subexpressions(test.right)):
        return None
    size = int(step.value.value) if step.op == "+" else -int(step.value.value)
    right_way = size > 0 if test.op[0] == "<" else size < 0
    own = isinstance(step.target, ir.Local) and step.target.name == init.name
    return Count(init.name, init.value, test.right, test.op, size) if own and right_way else None


def uniform_constants(constants: Sequence[ir.Constant]) -> frozenset[str]:
    """The constants that are one number in NumPy; a part of an array or vector has an axis of lanes."""
    names: set[str] = set()
    for constant in constants:  # each after those that it uses
        parts = list(subexpressions(constant.value))
        used = {part.name for part in parts if isinstance(part, ir.Global)}
        if all(isinstance(part.type, Scalar) for part in parts) and used <= names:
            names.add(constant.name)
    return frozenset(names)


class Uniformity:
    """What is uniform in one function whose calls are lifted."""

    def __init__(self, function: ir.Function, constants: Set[str], functions: Functions) -> None:
        self.constants, self.functions = constants, functions
        self.loops: dict[int, LoopFacts] = {}
        """The facts of each loop, by the id of its node."""
        body = function.body or ()
        self.names = {stmt.name for stmt in statements(body) if isinstance(stmt, ir.Declare)}
        self.names -= {param.name for param in function.params}
        while True:
            self.depths = {param.name: 0 for param in function.params}
            self.varying: set[str] = set()
            self.block(body, 0)
            if not self.varying & self.names:
                break
            self.names -= self.varying

    def is_uniform(self, expr: ir.Expr) -> bool:
        """Whether a scalar expression has one value for all lanes."""
        for part in subexpressions(expr):
            if not isinstance(part.type, Scalar):
                return False
            if isinstance(part, ir.Local):
                if part.name not in self.names:
                    return False
            elif isinstance(part, ir.Global):
                if part.name not in self.constants:
                    return False
            elif not isinstance(part, ir.Literal | ir.Unary | ir.Binary | ir.Select | ir.Construct):
                return False
        return True

    def block(self, block: ir.Block, depth: int) -> None:
        """Finds variables that vary. `depth` counts the enclosing statements that run for some lanes only."""
        for stmt in block:
            for expr in expressions(stmt):
                for name in out_arguments(expr, self.functions):
                    self.varying.add(name)
            if isinstance(stmt, ir.Declare):
                self.depths[stmt.name] = depth
                if stmt.value is not None and not self.is_uniform(stmt.value):
                    self.varying.add(stmt.name)
            elif isinstance(stmt, ir.Assign):
                target = root(stmt.target)
                assert target is not None
                if self.depths[target.name] < depth or not self.is_uniform(stmt.value):
                    self.varying.add(target.name)
            elif isinstance(stmt, ir.If):
                inner = depth if self.is_uniform(stmt.condition) else depth + 1
                self.block(stmt.then, inner)
                self.block(stmt.otherwise, inner)
            elif isinstance(stmt, ir.For | ir.While):
                self.loop(stmt, depth)

    def loop(self, loop: ir.For | ir.While, depth: int) -> None:
        facts = self.loops[id(loop)] = self.facts(loop, depth > 0)
        inner = depth + 1 if facts.diverges else depth
        if isinstance(loop, ir.For):
            if loop.init is not None:
                self.block((loop.init,), inner if isinstance(loop.init, ir.Declare) else depth)
            if loop.step is not None:
                self.block((loop.step,), inner)
            if isinstance(loop.init, ir.Declare):
                self.depths[loop.init.name] = depth  # the step runs for all lanes, what the body writes does not
        self.block(loop.body, inner)

    def facts(self, loop: ir.For | ir.While, inside: bool) -> LoopFacts:
        """How to run a loop; `inside`: only some lanes are active there."""
        body = loop.body
        counter = count(loop) if isinstance(loop, ir.For) else None
        counted = counter is not None and self.is_fixed(counter, body)
        jumps = self.jumps(body, False)
        own = _own_jumps(body)
        uniform = counted or (
            loop.condition is not None and self.is_uniform(loop.condition) and not jumps and "continue" not in own
        )
        if not uniform and "continue" in own:
            jumps.add("continue")
        if "continue" in jumps and "break" in own:
            jumps.add("break")
        if (inside or jumps or not uniform) and _returns(body):
            jumps.add("return")
        return LoopFacts(counted, not uniform or bool(jumps and not counted), frozenset(jumps))

    def is_fixed(self, counter: Count, body: ir.Block) -> bool:
        """Whether the counter and its bounds are uniform and the loop's body does not change them."""
        if not self.is_uniform(counter.start) or not self.is_uniform(counter.stop):
            return False
        watched = {part.name for part in subexpressions(counter.stop) if isinstance(part, ir.Local)} | {counter.name}
        for stmt in statements(body):
            target = root(stmt.target) if isinstance(stmt, ir.Assign) else None
            if target is not None and target.name in watched:
                return False
            for expr in expressions(stmt):
                if watched.intersection(out_arguments(expr, self.functions)):
                    return False
        return True

    def jumps(self, block: ir.Block, diverged: bool) -> set[str]:
        """The kinds of jumps by which only some lanes leave the loop with this body, or its iteration."""
        kinds: set[str] = set()
        for stmt in block:
            if isinstance(stmt, ir.Break | ir.Continue | ir.Return | ir.Discard):
                if diverged:
                    kinds.add(_kind(stmt))
            elif isinstance(stmt, ir.If):
                inner = diverged or not self.is_uniform(stmt.condition)
                kinds |= self.jumps(stmt.then, inner) | self.jumps(stmt.otherwise, inner)
            elif (
                isinstance(stmt, ir.For | ir.While)
                and _returns(stmt.body)
                and (diverged or self.facts(stmt, False).diverges)
            ):
                kinds.add("return")
        return kinds


def _kind(jump: ir.Break | ir.Continue | ir.Return | ir.Discard) -> str:
    if isinstance(jump, ir.Break):
        return "break"
    return "continue" if isinstance(jump, ir.Continue) else "return"


def _returns(block: ir.Block) -> bool:
    return any(isinstance(stmt, ir.Return | ir.Discard) for stmt in statements(block))


def _own_jumps(block: ir.Block) -> set[str]:
    """The breaks and continues of a loop with this body, without those of loops inside it."""
    kinds: set[str] = set()
    for stmt in block:
        if isinstance(stmt, ir.Break | ir.Continue):
            kinds.add(_kind(stmt))
        elif isinstance(stmt, ir.If):
            kinds |= _own_jumps(stmt.then) | _own_jumps(stmt.otherwise)
    return kinds
