"""Finds where the pixels of a quad may take different branches, and the operations not allowed there. Used by `hoist`.

A texture read that chooses its own level, or a derivative, compares a pixel with its neighbours, so all must
reach it: control flow must be *uniform*. The analysis is a conservative simplification of that of WGSL, section 15.2.
A value that depends on an entry's parameters, a module variable or a texture varies; uniforms and constants do not.
After a branch in which some pixels return, break, continue or discard, flow is non-uniform to the end of the function
or loop.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.walk import callees, inner_parts, operands, root, statements
from sssgen.passes.scopes import out_positions
from sssgen.passes.variable_effects import NONE, Effects, effects


@cache
def implicit() -> frozenset[str]:
    """The builtins that need uniform control flow, by the intrinsic table."""
    return frozenset(name for name, row in BUILTINS.items() if row.uniform_flow)


@cache
def varying_builtins() -> frozenset[str]:
    """The builtins whose results differ from pixel to pixel for all arguments."""
    rows = BUILTINS.items()
    return frozenset(name for name, row in rows if row.reads_neighbours_or_textures and not row.size_query)


class Summary(NamedTuple):
    """What a call of a function may do."""

    compares: bool
    """The function or one of its callees has a builtin that needs uniform flow."""
    varies: bool
    """The result may vary even where the arguments do not."""
    discards: bool
    outs: tuple[int, ...]
    """The positions of its out and inout parameters."""
    callees: tuple[str, ...]
    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()
    """The module variables that the function and its callees read and write."""

    @property
    def pure(self) -> bool:
        """Whether a call has no effect apart from its result."""
        return not self.outs and not self.discards and not self.writes


_UNKNOWN = Summary(False, True, True, (), ())


def summaries(module: ir.Module) -> dict[str, Summary]:
    """A summary of each function of a module."""
    functions = {function.key: function for function in module.functions}
    result: dict[str, Summary] = {}
    shared = effects(module)

    def visit(key: str) -> Summary:
        summary = result.get(key)
        if summary is None:
            function = functions.get(key)
            if function is None:
                return _UNKNOWN
            result[key] = _UNKNOWN
            summary = result[key] = _summary(function, visit, shared.get(key, NONE))
        return summary

    for key in functions:
        visit(key)
    return result


def _summary(function: ir.Function, visit: Callable[[str], Summary], shared: Effects) -> Summary:
    body, keys = function.body or (), callees(function)
    names = {part.name for part in inner_parts(body, ir.Intrinsic)}
    discards = function.body is None or any(type(stmt) is ir.Discard for stmt in statements(body))
    called = [visit(key) for key in keys]
    return Summary(
        not names.isdisjoint(implicit()) or any(callee.compares for callee in called),
        bool(shared.reads) or not names.isdisjoint(varying_builtins()) or any(callee.varies for callee in called),
        discards or any(callee.discards for callee in called),
        out_positions(function),
        tuple(keys),
        *shared,
    )


class CallContext(NamedTuple):
    """How a function is called, all its calls taken together."""

    uniform: bool
    varying: frozenset[str]
    """The parameters that vary."""


def join(first: CallContext | None, second: CallContext) -> CallContext:
    """Both sites taken together."""
    return second if first is None else CallContext(first.uniform and second.uniform, first.varying | second.varying)


class Divergence:
    """Where flow is not uniform in one function, called as `site` describes."""

    def __init__(
        self,
        function: ir.Function,
        site: CallContext,
        summaries: Mapping[str, Summary],
        functions: Mapping[str, ir.Function],
    ) -> None:
        self.summaries, self.functions = summaries, functions
        self.misplaced: set[int] = set()
        """The expressions, by id, that need uniform flow and may not have it."""
        self.inside: set[int] = set()
        """The statements, by id, that are reached uniformly and in which flow diverges."""
        self.after: set[int] = set()
        """The statements, by id, that are reached uniformly and not left so."""
        self.sites: dict[str, CallContext] = {}
        """How the functions are called that need uniform flow."""
        self.shared = summaries.get(function.key, _UNKNOWN).reads
        self.flow = site.uniform
        self.varying = set(site.varying)
        self.hits = 0
        """How often a misplaced operation was found."""
        self.escapes = 0
        """Returns and discards found so far in non-uniform flow."""
        self.jumps = 0
        """Breaks and continues found so far in non-uniform flow, of the current loop."""
        self.left: set[str] = set()
        """What varied at some break or continue of the current loop."""
        self.block(function.body or ())

    # Statements

    def block(self, block: ir.Block) -> None:
        for stmt in block:
            self.statement(stmt)

    def statement(self, stmt: ir.Stmt) -> None:
        uniform_before = self.flow
        diverges = False
        hits = self.hits
        if isinstance(stmt, ir.Declare):
            varies = stmt.value is not None and self.varies(stmt.value)
            self.store(stmt.name, varies, True)
        elif isinstance(stmt, ir.Assign):
            varies = self.varies(stmt.value)
            target = root(stmt.target)
            for index in operands(stmt.target):
                varies = self.varies(index) or varies
            if target is not None:
                self.store(target.name, varies, not stmt.op and stmt.target is target)
        elif isinstance(stmt, ir.If):
            diverges = self.choice(stmt)
        elif isinstance(stmt, ir.For | ir.While):
            diverges = self.loop(stmt)
        elif isinstance(stmt, ir.Break | ir.Continue):
            self.jumps += not self.flow
            self.left |= self.varying
        elif isinstance(stmt, ir.Return):
            if stmt.value is not None:
                self.varies(stmt.value)
            self.escapes += not self.flow
        elif isinstance(stmt, ir.Discard):
            self.escapes += not self.flow
        elif isinstance(stmt, ir.Evaluate):
            self.varies(stmt.call)
        if uniform_before:
            if diverges or (self.hits > hits and not isinstance(stmt, ir.If | ir.For | ir.While)):
                self.inside.add(id(stmt))
            if not self.flow:
                self.after.add(id(stmt))

    def store(self, name: str, varies: bool, complete: bool) -> None:
        if varies or not self.flow:
            self.varying.add(name)
        elif complete:
            self.varying.discard(name)

    def choice(self, stmt: ir.If) -> bool:
        """Follows both arms; whether flow diverges."""
        hits = self.hits
        condition = self.varies(stmt.condition)
        apart = condition or self.hits > hits or not self.flow
        before, left = self.flow, self.escapes + self.jumps
        varying = set(self.varying)
        self.flow = before and not condition
        self.block(stmt.then)
        flow, after = self.flow, self.varying
        self.flow, self.varying = before and not condition, varying
        self.block(stmt.otherwise)
        self.varying = self.varying | after
        if condition:
            self.flow = before and self.escapes + self.jumps == left
        else:
            self.flow = self.flow and flow
        return apart

    def loop(self, stmt: ir.For | ir.While) -> bool:
        """Follows a loop until nothing new is found; whether flow diverges in it."""
        hits = self.hits
        if isinstance(stmt, ir.For) and stmt.init is not None:
            self.statement(stmt.init)
        apart = self.hits > hits
        before, jumps, left, escapes = self.flow, self.jumps, self.left, self.escapes
        uniform = before
        while True:
            start = set(self.varying)
            self.flow, self.jumps, self.left, self.escapes = uniform, 0, set(), escapes
            condition = stmt.condition is not None and self.varies(stmt.condition)
            self.flow = uniform and not condition
            self.block(stmt.body)
            hits = self.hits
            if isinstance(stmt, ir.For) and stmt.step is not None:
                self.statement(stmt.step)
            apart = apart or self.hits > hits
            again = self.flow and not self.jumps and self.escapes == escapes
            self.varying |= start | self.left
            if self.varying == start and uniform == (uniform and again):
                break
            uniform = uniform and again
        self.jumps, self.left = jumps, left
        self.flow = before and self.escapes == escapes
        return apart or not uniform

    # Expressions

    def varies(self, expr: ir.Expr) -> bool:
        """Whether a value may differ from pixel to pixel. Records every misplaced operation."""
        if isinstance(expr, ir.Local):
            return expr.name in self.varying
        if isinstance(expr, ir.Global):
            return expr.name in self.shared
        if isinstance(expr, ir.Binary) and expr.op in ("&&", "||"):
            left = self.varies(expr.left)
            return self.visit_arms(left, (expr.right,)) or left
        if isinstance(expr, ir.Select):
            condition = self.varies(expr.condition)
            return self.visit_arms(condition, (expr.yes, expr.no)) or condition
        parts = [self.varies(operand) for operand in operands(expr)]
        if isinstance(expr, ir.Intrinsic):
            if expr.name in implicit():
                self.compare(expr)
            return expr.name in varying_builtins() or any(parts)
        if isinstance(expr, ir.Call):
            return self.call(expr, parts)
        return any(parts)

    def compare(self, expr: ir.Intrinsic | ir.Call) -> None:
        """Records an operation that needs uniform flow."""
        if not self.flow:
            self.misplaced.add(id(expr))
            self.hits += 1

    def visit_arms(self, condition: bool, exprs: Iterable[ir.Expr]) -> bool:
        """Looks at expressions that are evaluated on a condition."""
        before, escapes = self.flow, self.escapes
        self.flow = before and not condition
        varies = [self.varies(expr) for expr in exprs]
        self.flow = before and self.escapes == escapes
        return any(varies)

    def call(self, expr: ir.Call, args: list[bool]) -> bool:
        summary = self.summaries.get(expr.function, _UNKNOWN)
        varies = summary.varies or any(args)
        if summary.compares:
            self.compare(expr)
            params = self.functions[expr.function].params
            site = CallContext(self.flow, frozenset(param.name for param, arg in zip(params, args, strict=True) if arg))
            self.sites[expr.function] = join(self.sites.get(expr.function), site)
        for index in summary.outs:
            target = root(expr.args[index])
            if target is not None:
                self.store(target.name, varies, False)
        if summary.discards:
            # it may discard for some pixels only
            self.flow = False
            self.escapes += 1
        return varies
