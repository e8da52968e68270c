"""Static cost: operations, transcendentals, texture fetches and distance evaluations of one call of an entry.

The operations of a builtin are in the intrinsic table. A loop counts its constant bound (or `UNKNOWN_TRIPS` where the
bound is a uniform without a default), a branch its more expensive arm, so the numbers are an upper estimate for one
fragment.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Matrix, Sampler, components
from sssgen.ir.walk import expressions, subexpressions

UNKNOWN_TRIPS = 16

WEIGHTS = {"operations": 1, "transcendentals": 8, "fetches": 16, "volume_fetches": 16}
"""What each adds to the static cost. `benchmarks/device_costs.py` prints how well they order chains on a GPU."""


class Cost(NamedTuple):
    """The operations of one evaluation."""

    operations: int = 0
    transcendentals: int = 0
    fetches: int = 0
    """Of pictures: 2-D and cube textures"""
    volume_fetches: int = 0
    """Of 3-D textures"""
    distance_evaluations: int = 0

    @property
    def weight(self) -> int:
        """One number: the counts times their WEIGHTS."""
        return sum(weight * getattr(self, kind) for kind, weight in WEIGHTS.items())

    @property
    def text(self) -> str:
        """Every kind that is there, as words."""
        kinds = (
            ("operation", "operations", self.operations),
            ("transcendental", "transcendentals", self.transcendentals),
            ("fetch", "fetches", self.fetches),
            ("volume fetch", "volume fetches", self.volume_fetches),
            ("distance evaluation", "distance evaluations", self.distance_evaluations),
        )
        return ", ".join(f"{n} {one if n == 1 else many}" for one, many, n in kinds if n or many == "operations")

    def plus(self, other: Cost, times: int = 1) -> Cost:
        return Cost(*[own + times * more for own, more in zip(self, other, strict=True)])


_NOTHING = Cost()


def cost_of(module: ir.Module, key: str, distance_functions: Collection[str] = ()) -> Cost:
    """The cost of one call of the function `key`; `distance_functions` are the keys counted as evaluations."""
    return _Counter(module, distance_functions).function(key)


class _Counter:
    def __init__(self, module: ir.Module, distance_functions: Collection[str]) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.defaults = {uniform.name: uniform.default for uniform in module.uniforms}
        self.defaults |= {
            constant.name: (float(constant.value.value),)
            for constant in module.constants
            if isinstance(constant.value, ir.Literal)
        }
        self.distance_functions = distance_functions
        self.costs: dict[str, Cost] = {}

    def function(self, key: str) -> Cost:
        if key not in self.costs:
            self.costs[key] = self.block(self.functions[key].body or ())
        return self.costs[key]

    def block(self, block: ir.Block) -> Cost:
        total = Cost()
        for stmt in block:
            total = total.plus(self.statement(stmt))
        return total

    def statement(self, stmt: ir.Stmt) -> Cost:
        total = Cost()
        for expr in expressions(stmt):
            for part in subexpressions(expr):
                cost = self.node(part)
                total = total.plus(cost) if cost is not _NOTHING else total
        if isinstance(stmt, ir.Assign) and stmt.op:
            total = total.plus(Cost(components(stmt.target.type)))
        if isinstance(stmt, ir.If):
            return total.plus(max(self.block(stmt.then), self.block(stmt.otherwise), key=lambda cost: cost.weight))
        if isinstance(stmt, ir.For):
            inner = self.block(stmt.body).plus(total)
            if stmt.step is not None:
                inner = inner.plus(self.statement(stmt.step))
            return Cost().plus(inner, self.trips(stmt))
        if isinstance(stmt, ir.While):
            return Cost().plus(self.block(stmt.body).plus(total), UNKNOWN_TRIPS)
        return total

    def trips(self, loop: ir.For) -> int:
        """The number of iterations that a loop's header shows; UNKNOWN_TRIPS if it does not."""
        condition = loop.condition
        while isinstance(condition, ir.Binary) and condition.op == "&&":
            condition = condition.left
        if not isinstance(condition, ir.Binary) or not isinstance(loop.init, ir.Declare):
            return UNKNOWN_TRIPS
        start, bound = loop.init.value, condition.right
        first = float(start.value) if isinstance(start, ir.Literal) else 0.0
        step = (
            float(loop.step.value.value)
            if isinstance(loop.step, ir.Assign) and isinstance(loop.step.value, ir.Literal)
            else 1.0
        )
        if isinstance(bound, ir.Literal):
            last = float(bound.value)
        elif isinstance(bound, ir.Global) and len(self.defaults.get(bound.name, ())) == 1:
            last = self.defaults[bound.name][0]
        else:
            return UNKNOWN_TRIPS
        return max(0, round(abs(last - first) / step) + (len(condition.op) == 2))

    def node(self, expr: ir.Expr) -> Cost:
        if isinstance(expr, ir.Call):
            inner = self.function(expr.function)
            return inner.plus(Cost(distance_evaluations=1)) if expr.function in self.distance_functions else inner
        if isinstance(expr, ir.Intrinsic):
            row = BUILTINS[expr.name]
            if row.kind == "fetch":
                volume = any(isinstance(arg.type, Sampler) and arg.type.dim == "3D" for arg in expr.args)
                return Cost(volume_fetches=1) if volume else Cost(fetches=1)
            size = max([components(expr.type)] + [components(arg.type) for arg in expr.args])
            roots = 1 if row.once else size
            return Cost(row.cost * size + row.once, roots if row.kind == "transcendental" else 0)
        if isinstance(expr, ir.Binary):
            left, right = expr.left.type, expr.right.type
            if expr.op == "*" and isinstance(left, Matrix):
                return Cost(2 * components(left) * (right.columns if isinstance(right, Matrix) else 1))
            return Cost(max(components(left), components(right)))
        if isinstance(expr, ir.Unary | ir.Select):
            return Cost(components(expr.type))
        return _NOTHING
