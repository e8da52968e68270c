"""The values of constants at file scope that a language cannot compute there, as it can call no function before main.

Why: `const int K = bitCount(7);` needs a polyfill in GLSL 3.30, and naga computes only some builtins in a constant.
Used by `legalise`, which writes the number in place of such a value. A builtin that the table does not fold is computed
by its polyfill, whose statements are executed here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.constant_evaluation import Value, combine
from sssgen.ir.constant_expressions import constant_numbers, literal
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, Vector, components, kind_of
from sssgen.ir.walk import operands
from sssgen.passes.legal.builtin_forms import Polyfill


class _NotConstant(Exception):
    """The value is not known before the program runs."""


class ConstantCalls:
    """The values of a module's constants, and of expressions of them."""

    def __init__(self, module: ir.Module, polyfill: Polyfill) -> None:
        self.polyfill = polyfill
        self.globals: dict[str, Value] = {}
        for constant in module.constants:
            value = self.value(constant.value)
            if value is not None:
                self.globals[constant.name] = value

    def value(self, expr: ir.Expr) -> Value | None:
        """The value of an expression; None where it is not constant."""
        try:
            return self.evaluate(expr, {}, {})
        except (_NotConstant, KeyError):
            return None

    def literals(self, expr: ir.Expr) -> ir.Expr | None:
        """The value of an expression as literals and constructors; None where it is not constant."""
        value = self.value(expr)
        return None if value is None else _as_literals(expr.type, value, expr.span)

    def evaluate(self, expr: ir.Expr, local: Mapping[str, Value], functions: Mapping[str, ir.Function]) -> Value:
        """The value with these values of variables and these functions. Raises _NotConstant, KeyError."""
        if isinstance(expr, ir.Literal):
            return _require(constant_numbers(expr))
        if isinstance(expr, ir.Local):
            return local[expr.name]
        if isinstance(expr, ir.Global):
            return self.globals[expr.name]
        if isinstance(expr, ir.Select):
            condition = self.evaluate(expr.condition, local, functions)
            return self.evaluate(expr.yes if condition[0] else expr.no, local, functions)
        values = [self.evaluate(operand, local, functions) for operand in operands(expr)]
        if isinstance(expr, ir.Call):
            return self.call(functions[expr.function], values, functions)
        if isinstance(expr, ir.Intrinsic) and BUILTINS[expr.name].fold is None:
            module = self.polyfill(expr.name, [arg.type for arg in expr.args])
            helpers = {function.key: function for function in module.functions}
            return self.call(module.functions[-1], values, helpers)
        return _require(combine(expr, values))

    def call(self, function: ir.Function, values: Sequence[Value], functions: Mapping[str, ir.Function]) -> Value:
        local = {param.name: value for param, value in zip(function.params, values, strict=True)}
        return _require(self.execute(function.body or (), local, functions))

    def execute(self, block: ir.Block, local: dict[str, Value], functions: Mapping[str, ir.Function]) -> Value | None:
        """The returned value; None where the statements end without one."""
        for stmt in block:
            if isinstance(stmt, ir.Return) and stmt.value is not None:
                return self.evaluate(stmt.value, local, functions)
            if isinstance(stmt, ir.If):
                chosen = stmt.then if self.evaluate(stmt.condition, local, functions)[0] else stmt.otherwise
                returned = self.execute(chosen, local, functions)
                if returned is not None:
                    return returned
            elif isinstance(stmt, ir.Declare) and stmt.value is not None:
                local[stmt.name] = self.evaluate(stmt.value, local, functions)
            elif isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Local):
                value = stmt.value
                if stmt.op:
                    value = ir.Binary(stmt.target.type, stmt.op, stmt.target, value, stmt.span)
                local[stmt.target.name] = self.evaluate(value, local, functions)
            else:
                raise _NotConstant
        return None


def _as_literals(type_: Type, value: Value, span: ir.Span) -> ir.Expr:
    """A value as literals and constructors."""
    if isinstance(type_, Struct):
        parts = [_as_literals(field.type, part, span) for field, part in zip(type_.fields, value, strict=True)]
        return ir.Construct(type_, tuple(parts), span)
    if isinstance(type_, Array):
        return ir.Construct(type_, tuple([_as_literals(type_.element, part, span) for part in value]), span)
    if isinstance(type_, Matrix):
        return ir.Construct(type_, tuple([ir.Literal(Scalar("float"), number, span) for number in value]), span)
    assert isinstance(type_, Scalar | Vector) and len(value) == components(type_)
    numbers = tuple([float(number) if kind_of(type_) == "float" else number for number in value])
    return literal(type_, numbers, span)


def _require(value: Value | None) -> Value:
    if value is None:
        raise _NotConstant
    return value
