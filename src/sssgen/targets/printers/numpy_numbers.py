"""Which values may be plain Python numbers when the code printed for NumPy runs.

Plain numbers adapt to the element type of the arrays that they are combined with, so literals stay short. But a plain
int does not wrap at 32 bits, a plain division by 0 raises an error, and a plain uint is not distinguishable from an
int. Where all operands are plain numbers, the printer therefore calls the runtime; this module finds these places. The
arguments of calls from outside the module are assumed to be arrays; uniforms may be plain floats and ints.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import INT, UINT, Scalar, kind_of
from sssgen.ir.walk import expressions, statements, subexpressions
from sssgen.passes.numpy.uniformity import count


class Numbers:
    """The plain numbers of one module; `enter` selects the function."""

    def __init__(self, module: ir.Module) -> None:
        self.constants = {constant.name: constant.value for constant in module.constants}
        self.functions = {function.key: function for function in module.functions}
        self.plain_params: set[tuple[str, str]] = set()
        self.plain_results: set[str] = set()
        self.locals: dict[str, set[str]] = {function.key: set() for function in module.functions}
        self.counters: dict[str, dict[str, int | None]] = {}
        """For each function its loop counters and similar variables, and their largest magnitude."""
        self.ranges: dict[str, set[str]] = {function.key: set() for function in module.functions}
        """For each function the counters that run through a Python range."""
        self.key = ""
        for function in module.functions:
            self.enter(function)
            self.find_counters(function)
        while sum(self.look(function) for function in module.functions):
            pass

    def enter(self, function: ir.Function) -> None:
        self.key = function.key

    def find_counters(self, function: ir.Function) -> None:
        counters: dict[str, int | None] = dict.fromkeys(_steppers(function), _STEPPED)
        self.counters[self.key] = counters
        for stmt in statements(function.body or ()):
            counter = count(stmt) if isinstance(stmt, ir.For) else None
            if counter is not None:
                bounds = [self.bound(counter.start), self.bound(counter.stop)]
                constant_bounds = [bound for bound in bounds if bound is not None]
                counters[counter.name] = max(constant_bounds) if len(constant_bounds) == 2 else None
                self.locals[self.key].add(counter.name)
                self.ranges[self.key].add(counter.name)

    def look(self, function: ir.Function) -> bool:
        """Visits a function once; returns whether that found something new."""
        self.enter(function)
        names = self.locals[self.key]
        before = len(names), len(self.plain_params), len(self.plain_results)
        names.update(name for key, name in self.plain_params if key == self.key)
        for stmt in statements(function.body or ()):
            if isinstance(stmt, ir.Declare) and stmt.value is not None and self.plain(stmt.value):
                names.add(stmt.name)
            elif isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Local) and self.plain(stmt.value):
                names.add(stmt.target.name)
            elif isinstance(stmt, ir.Return) and stmt.value is not None and self.plain(stmt.value):
                self.plain_results.add(self.key)
            for expr in expressions(stmt):
                for part in subexpressions(expr):
                    if isinstance(part, ir.Call):
                        self.pass_on(part, names)
        return before != (len(names), len(self.plain_params), len(self.plain_results))

    def pass_on(self, call: ir.Call, names: set[str]) -> None:
        for arg, param in zip(call.args, self.functions[call.function].params, strict=True):
            if param.direction != "out" and self.plain(arg):
                self.plain_params.add((call.function, param.name))
            if param.direction != "in" and isinstance(arg, ir.Local) and kind_of(arg.type) in ("float", "int"):
                names.add(arg.name)

    def plain(self, expr: ir.Expr) -> bool:
        """Whether the printed form of an expression may be a plain number."""
        if not isinstance(expr.type, Scalar):
            return False
        kind = expr.type.kind
        if isinstance(expr, ir.Literal):
            return True
        if isinstance(expr, ir.Local):
            names = self.locals[self.key] if kind != "uint" else self.ranges[self.key]
            return expr.name in names
        if kind in ("uint", "bool"):
            return False
        if isinstance(expr, ir.Global):
            return expr.name not in self.constants or self.plain(self.constants[expr.name])
        if isinstance(expr, ir.Unary):
            return self.plain(expr.operand) and (kind == "float" or expr.op == "~" or not self.may_wrap(expr))
        if isinstance(expr, ir.Binary):
            if not self.plain(expr.left) or not self.plain(expr.right):
                return False
            if kind == "float":
                return expr.op != "/" or nonzero(expr.right)
            return expr.op in ("&", "|", "^") or (expr.op in ("+", "-", "*") and not self.may_wrap(expr))
        if isinstance(expr, ir.Construct):
            return kind == "float" and self.plain(expr.args[0])
        if isinstance(expr, ir.Call):
            return expr.function in self.plain_results
        return isinstance(expr, ir.Member)

    def may_wrap(self, expr: ir.Expr) -> bool:
        """Whether integer arithmetic on plain numbers may exceed the range of an int."""
        bound = self.bound(expr)
        return bound is None or bound > 0x7FFFFFFF

    def bound(self, expr: ir.Expr) -> int | None:
        """An upper bound of the magnitude of an integer computed from literals and loop counters, or None."""
        if isinstance(expr, ir.Literal):
            return abs(int(expr.value))
        if isinstance(expr, ir.Local):
            return self.counters[self.key].get(expr.name)
        if isinstance(expr, ir.Global) and expr.name in self.constants:
            return self.bound(self.constants[expr.name])
        if isinstance(expr, ir.Unary) and expr.op == "-" and expr.type == INT:
            return self.bound(expr.operand)
        if isinstance(expr, ir.Binary) and expr.op in ("+", "-", "*") and expr.type != UINT:
            left, right = self.bound(expr.left), self.bound(expr.right)
            if left is not None and right is not None:
                return left * right if expr.op == "*" else left + right
        return None


_STEPPED = 1 << 30
"""The bound of a variable that only changes by small steps: to exceed it takes millions of steps."""


def _steppers(function: ir.Function) -> set[str]:
    """The int variables that start from small literals and only change by small ones."""
    names = {stmt.name for stmt in statements(function.body or ()) if isinstance(stmt, ir.Declare) and stmt.type == INT}

    def small(expr: ir.Expr, name: str, largest: int) -> bool:
        if isinstance(expr, ir.Select):
            return small(expr.yes, name, largest) and small(expr.no, name, largest)
        if isinstance(expr, ir.Binary) and expr.op in ("+", "-") and isinstance(expr.left, ir.Local):
            return expr.left.name == name and small(expr.right, "", 256)
        if isinstance(expr, ir.Literal):
            return abs(int(expr.value)) <= largest
        return isinstance(expr, ir.Local) and expr.name == name

    for stmt in statements(function.body or ()):
        if isinstance(stmt, ir.Declare) and stmt.value is not None and not small(stmt.value, stmt.name, 1 << 20):
            names.discard(stmt.name)
        elif isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Local):
            name = stmt.target.name
            if stmt.op not in ("", "+", "-") or not small(stmt.value, name, 256 if stmt.op else 1 << 20):
                names.discard(name)
        for expr in expressions(stmt):
            if isinstance(expr, ir.Call):
                names -= {arg.name for arg in expr.args if isinstance(arg, ir.Local)}
    return names


def nonzero(expr: ir.Expr) -> bool:
    """Whether an expression is a literal other than 0."""
    return isinstance(expr, ir.Literal) and expr.value != 0
