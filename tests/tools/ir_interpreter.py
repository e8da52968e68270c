"""Runs checked IR for one lane with plain Python values, independently of the NumPy target.

It follows the text statement by statement, with Python's own control flow, and shares no code with the passes, the
printer or the runtime. Values: float, int and bool; a vector is a tuple of these, a matrix a tuple of columns, an
array or struct a tuple of its elements. `BUILTINS` below has the supported builtins, which need no rounding rule.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, TypeAlias

from sssgen.ir import nodes as ir
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, Vector, components, kind_of

Value: TypeAlias = Any


class Discarded(Exception):
    """The lane is discarded."""


class _Break(Exception):
    pass


class _Continue(Exception):
    pass


class Returned(Exception):
    def __init__(self, value: Value) -> None:
        super().__init__()
        self.value = value


class Interpreter:
    """Runs the functions of a module. `uniforms` has the values of its uniforms."""

    def __init__(self, module: ir.Module, uniforms: dict[str, Value] | None = None) -> None:
        self.functions = {function.key: function for function in module.functions}
        self.globals = dict(uniforms or {})
        self.frame: dict[str, Value] = {}
        for constant in module.constants:
            self.globals[constant.name] = self.value(constant.value)
        for variable in module.variables:
            begin = zero(variable.type) if variable.value is None else self.value(variable.value)
            self.globals.setdefault(variable.name, begin)

    def call(self, key: str, *args: Value) -> tuple[Value, ...]:
        """Calls a function with its in and inout arguments; returns its result (if any), then its out parameters."""
        function = self.functions[key]
        inputs = iter(args)
        outer, self.frame = self.frame, {}
        for param in function.params:
            self.frame[param.name] = zero(param.type) if param.direction == "out" else next(inputs)
        result: tuple[Value, ...] = ()
        try:
            self.block(function.body or ())
        except Returned as returned:
            result = () if returned.value is None else (returned.value,)
        outs = tuple(self.frame[param.name] for param in function.params if param.direction != "in")
        self.frame = outer
        return result + outs

    # Statements

    def block(self, block: ir.Block) -> None:
        for stmt in block:
            self.statement(stmt)

    def statement(self, stmt: ir.Stmt) -> None:
        if isinstance(stmt, ir.Declare):
            self.frame[stmt.name] = zero(stmt.type) if stmt.value is None else self.value(stmt.value)
        elif isinstance(stmt, ir.Assign):
            place = self.pinned(stmt.target)
            old = self.value(place) if stmt.op else None
            value = self.value(stmt.value)
            if stmt.op:
                value = binary(stmt.op, place.type, place.type, stmt.value.type, old, value)
            self.store(place, value)
        elif isinstance(stmt, ir.Evaluate):
            self.value(stmt.call)
        elif isinstance(stmt, ir.If):
            self.block(stmt.then if self.value(stmt.condition) else stmt.otherwise)
        elif isinstance(stmt, ir.For):
            if stmt.init is not None:
                self.statement(stmt.init)
            self.loop(stmt.condition, stmt.body, stmt.step)
        elif isinstance(stmt, ir.While):
            self.loop(stmt.condition, stmt.body, None)
        elif isinstance(stmt, ir.Return):
            raise Returned(None if stmt.value is None else self.value(stmt.value))
        elif isinstance(stmt, ir.Discard):
            raise Discarded
        elif isinstance(stmt, ir.Break):
            raise _Break
        else:
            raise _Continue

    def loop(self, condition: ir.Expr | None, body: ir.Block, step: ir.Stmt | None) -> None:
        while condition is None or self.value(condition):
            try:
                self.block(body)
            except _Break:
                return
            except _Continue:
                pass
            if step is not None:
                self.statement(step)

    def store(self, target: ir.Expr, value: Value) -> None:
        """Assigns to a variable or to a part of a variable."""
        if isinstance(target, ir.Local | ir.Global):
            variables = self.frame if isinstance(target, ir.Local) else self.globals
            variables[target.name] = value
            return
        assert isinstance(target, ir.Swizzle | ir.Index | ir.Member)
        whole = list(self.value(target.value))
        if isinstance(target, ir.Swizzle):
            parts = value if len(target.components) > 1 else (value,)
            for letter, part in zip(target.components, parts, strict=True):
                whole["xyzw".index(letter)] = part
        elif isinstance(target, ir.Index):
            place = self.value(target.index)
            if 0 <= place < len(whole):
                whole[place] = value
        else:
            whole[field_index(target)] = value
        self.store(target.value, tuple(whole))

    # Expressions

    def value(self, expr: ir.Expr) -> Value:
        if isinstance(expr, ir.Literal):
            return expr.value
        if isinstance(expr, ir.Local):
            return self.frame[expr.name]
        if isinstance(expr, ir.Global):
            return self.globals[expr.name]
        if isinstance(expr, ir.Unary):
            return unary(expr.op, expr.type, self.value(expr.operand))
        if isinstance(expr, ir.Binary):
            return self.binary(expr)
        if isinstance(expr, ir.Select):
            return self.value(expr.yes if self.value(expr.condition) else expr.no)
        if isinstance(expr, ir.Call):
            return self.called(expr)
        if isinstance(expr, ir.Intrinsic):
            return BUILTINS[expr.name](*[self.value(arg) for arg in expr.args])
        if isinstance(expr, ir.Construct):
            return construct(expr.type, [arg.type for arg in expr.args], [self.value(arg) for arg in expr.args])
        value = self.value(expr.value)
        if isinstance(expr, ir.Swizzle):
            parts = tuple(value["xyzw".index(letter)] for letter in expr.components)
            return parts if len(parts) > 1 else parts[0]
        if isinstance(expr, ir.Index):
            return value[min(max(self.value(expr.index), 0), len(value) - 1)]
        return value[field_index(expr)]

    def binary(self, expr: ir.Binary) -> Value:
        left = self.value(expr.left)
        if expr.op in ("&&", "||") and left == (expr.op == "||"):
            return left
        return binary(expr.op, expr.type, expr.left.type, expr.right.type, left, self.value(expr.right))

    def called(self, call: ir.Call) -> Value:
        function = self.functions[call.function]
        directions = [param.direction for param in function.params]
        parts = [  # from left to right: values, and places, which are read at the call
            self.value(arg) if direction == "in" else self.pinned(arg)
            for arg, direction in zip(call.args, directions, strict=True)
        ]
        arguments = [
            self.value(part) if direction == "inout" else part
            for part, direction in zip(parts, directions, strict=True)
            if direction != "out"
        ]
        outs = [part for part, direction in zip(parts, directions, strict=True) if direction != "in"]
        results = self.call(call.function, *arguments)
        for place, value in zip(outs, results[len(results) - len(outs) :], strict=True):
            self.store(place, value)
        return results[0] if len(results) > len(outs) else None

    def pinned(self, place: ir.Expr) -> ir.Expr:
        """The target of an assignment, with its indices evaluated."""
        if isinstance(place, ir.Index):
            index = ir.Literal(place.index.type, self.value(place.index), place.span)
            return place._replace(value=self.pinned(place.value), index=index)
        if isinstance(place, ir.Swizzle | ir.Member):
            return place._replace(value=self.pinned(place.value))
        return place


def zero(type_: Type) -> Value:
    if isinstance(type_, Scalar):
        return {"float": 0.0, "bool": False}.get(type_.kind, 0)
    if isinstance(type_, Vector):
        return (zero(Scalar(type_.kind)),) * type_.size
    if isinstance(type_, Matrix):
        return ((0.0,) * type_.rows,) * type_.columns
    if isinstance(type_, Array):
        return (zero(type_.element),) * type_.length
    assert isinstance(type_, Struct)
    return tuple(zero(field.type) for field in type_.fields)


def field_index(member: ir.Member) -> int:
    struct = member.value.type
    assert isinstance(struct, Struct)
    return [field.name for field in struct.fields].index(member.field)


def flat(value: Value) -> list[Any]:
    """The scalars of a value in order."""
    return [scalar for part in value for scalar in flat(part)] if isinstance(value, tuple) else [value]


def convert(kind: str, value: Value) -> Value:
    """A scalar converted to another kind."""
    if kind == "float":
        return float(value)
    if kind == "bool":
        return bool(value)
    low, high = (0, 2**32 - 1) if kind == "uint" else (-(2**31), 2**31 - 1)
    if isinstance(value, float):
        return 0 if math.isnan(value) else int(min(max(value, low), high))
    return wrapped(kind, int(value))


def wrapped(kind: str, value: int) -> int:
    """An integer wrapped to 32 bits."""
    value &= 0xFFFFFFFF
    return value - (1 << 32) if kind == "int" and value >= 1 << 31 else value


def construct(type_: Type, types: list[Type], values: list[Value]) -> Value:
    if isinstance(type_, Array | Struct):
        return tuple(values)
    kind, count = kind_of(type_), components(type_)
    scalars = [convert(kind, scalar) for value in values for scalar in flat(value)]
    if isinstance(type_, Scalar):
        return scalars[0]
    if isinstance(type_, Vector):
        return tuple(scalars * count if len(scalars) == 1 else scalars[:count])
    assert isinstance(type_, Matrix)
    columns, rows = range(type_.columns), range(type_.rows)
    if len(values) == 1 and isinstance(types[0], Scalar):
        return tuple(tuple(scalars[0] if i == j else 0.0 for j in rows) for i in columns)
    if len(values) == 1:
        old = values[0]
        return tuple(
            tuple(old[i][j] if i < len(old) and j < len(old[0]) else float(i == j) for j in rows) for i in columns
        )
    return tuple(tuple(scalars[i * len(rows) : (i + 1) * len(rows)]) for i in columns)


# Operators

_COMPARE = {"<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge, "==": operator.eq}


def unary(op: str, type_: Type, value: Value) -> Value:
    if isinstance(value, tuple):
        return tuple(unary(op, type_, part) for part in value)
    if op == "!":
        return not value
    if kind_of(type_) == "float":
        return -value
    return wrapped(kind_of(type_), -value if op == "-" else ~value)


def binary(op: str, type_: Type, left_type: Type, right_type: Type, left: Value, right: Value) -> Value:
    if op == "!=":
        return left != right
    if op in _COMPARE:
        return _COMPARE[op](left, right)
    if op in ("&&", "||", "^^"):
        return {"&&": left and right, "||": left or right, "^^": left != right}[op]
    if op == "*" and isinstance(left_type, Matrix) and not isinstance(right_type, Scalar):
        if isinstance(right_type, Matrix):
            return tuple(product(left, column) for column in right)
        return product(left, right)
    if op == "*" and isinstance(right_type, Matrix) and isinstance(left_type, Vector):
        return tuple(dot(left, column) for column in right)
    return componentwise(lambda x, y: arithmetic(op, kind_of(type_), x, y), left, right)


def product(matrix: Value, vector: Value) -> Value:
    size = len(vector)
    return tuple(
        sum((matrix[i][row] * vector[i] for i in range(1, size)), matrix[0][row] * vector[0])
        for row in range(len(matrix[0]))
    )


def dot(x: Value, y: Value) -> Value:
    return sum((a * b for a, b in zip(x[1:], y[1:], strict=True)), x[0] * y[0])


def componentwise(function: Callable[..., Value], *values: Value) -> Value:
    """Applies a function of scalars to vectors and matrices, component by component; scalars are repeated."""
    sizes = [len(value) for value in values if isinstance(value, tuple)]
    if not sizes:
        return function(*values)
    wide = [value if isinstance(value, tuple) else (value,) * sizes[0] for value in values]
    return tuple(componentwise(function, *parts) for parts in zip(*wide, strict=True))


def arithmetic(op: str, kind: str, x: Value, y: Value) -> Value:
    if kind == "float":
        if op == "/":
            return divided(x, y)
        return {"+": operator.add, "-": operator.sub, "*": operator.mul}[op](x, y)
    if op == "/":
        quotient = x if y == 0 else abs(x) // abs(y) * (1 if (x < 0) == (y < 0) else -1)
        return wrapped(kind, quotient)
    if op == "%":
        return 0 if y == 0 else int(math.copysign(1, x)) * (abs(x) % abs(y))
    if op in ("<<", ">>"):
        return wrapped(kind, x << (y & 31) if op == "<<" else x >> (y & 31))
    table = {
        "+": operator.add,
        "-": operator.sub,
        "*": operator.mul,
        "&": operator.and_,
        "|": operator.or_,
        "^": operator.xor,
    }
    return wrapped(kind, table[op](x, y))


def divided(x: float, y: float) -> float:
    if y != 0.0:
        return x / y
    return math.nan if x == 0.0 or math.isnan(x) else math.copysign(math.inf, x) * math.copysign(1.0, y)


def _componentwise(function: Callable[..., Value]) -> Callable[..., Value]:
    return lambda *values: componentwise(function, *values)


def _compare(op: str) -> Callable[..., Value]:
    return _componentwise(_COMPARE[op])


BUILTINS: dict[str, Callable[..., Value]] = {
    "abs": _componentwise(abs),
    "floor": _componentwise(lambda x: x if math.isinf(x) or math.isnan(x) else float(math.floor(x))),
    "sqrt": _componentwise(lambda x: math.sqrt(x) if x >= 0.0 else math.nan),
    "min": _componentwise(lambda x, y: y if y < x else x),
    "max": _componentwise(lambda x, y: y if x < y else x),
    "clamp": _componentwise(lambda x, low, high: min(max(x, low), high)),
    "step": _componentwise(lambda edge, x: 0.0 if x < edge else 1.0),
    "mix": _componentwise(lambda x, y, a: (y if a else x) if isinstance(a, bool) else x * (1.0 - a) + y * a),
    "dot": dot,
    "lessThan": _compare("<"),
    "greaterThan": _compare(">"),
    "equal": _compare("=="),
    "not": _componentwise(lambda x: not x),
    "any": any,
    "all": all,
    "transpose": lambda x: tuple(zip(*x, strict=True)),
}
