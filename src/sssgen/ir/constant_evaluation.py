"""The value of a constant expression from those of its operands: one rule for the checker and the passes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir import nodes as ir
from sssgen.ir.constant_arithmetic import Number
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.types import BOOL, Array, Matrix, Struct, Type, Vector, components, kind_of
from sssgen.ir.walk import operands

_RELATIONS = {
    "<": "lessThan", "<=": "lessThanEqual", ">": "greaterThan", ">=": "greaterThanEqual", "==": "equal",
    "!=": "notEqual",
}  # fmt: skip

Value: TypeAlias = tuple[Any, ...]
"""The numbers of a scalar, vector or matrix (column after column); the values of an array's or struct's parts."""


def evaluate(expr: ir.Expr, named: Callable[[ir.Local | ir.Global], Value | None]) -> Value | None:
    """The value of a constant expression; None where it is not constant, or not defined.

    `named` gives the value of a variable or a constant, where it has one. A pass that rewrites the parts of an
    expression (`wide_constants.py`), or reports those without a value (`undefined_constants.py`), visits them itself.
    """
    if isinstance(expr, ir.Literal):
        return constant_numbers(expr)
    if isinstance(expr, ir.Local | ir.Global):
        return named(expr)
    if isinstance(expr, ir.Select):  # the other arm need not be defined
        condition = evaluate(expr.condition, named)
        return None if condition is None else evaluate(expr.yes if condition[0] else expr.no, named)
    values: list[Value] = []
    for operand in () if isinstance(expr, ir.Call) else operands(expr):
        value = evaluate(operand, named)
        if value is None:
            return None
        values.append(value)
    return combine(expr, values) if values else None


def combine(expr: ir.Expr, values: Sequence[Value]) -> Value | None:
    """The value of an expression of constants; None where it is not constant, or not defined."""
    if isinstance(expr, ir.Construct):
        return tuple(values) if isinstance(expr.type, Array | Struct) else _construct(expr, values)
    if isinstance(expr, ir.Unary):
        return arithmetic.unary(expr.op, values[0], kind_of(expr.type))
    if isinstance(expr, ir.Binary):
        left, right = expr.left.type, expr.right.type
        if expr.op in ("==", "!=") and expr.type == BOOL:
            return ((values[0] == values[1]) == (expr.op == "=="),)
        if expr.op == "*" and Matrix in (type(left), type(right)) and components(left) > 1 < components(right):
            return _product(left, right, values)
        if isinstance(expr.type, Vector) and expr.type.kind == "bool" and expr.op in _RELATIONS:  # in WGSL and HLSL
            return arithmetic.builtin(_RELATIONS[expr.op], values, [left, right], expr.type)
        return arithmetic.binary(expr.op, values[0], values[1], kind_of(left))
    if isinstance(expr, ir.Intrinsic):
        return arithmetic.builtin(expr.name, values, [arg.type for arg in expr.args], expr.type)
    if isinstance(expr, ir.Select):
        return values[1] if values[0][0] else values[2]
    return _part(expr, values)


def _product(left: Type, right: Type, values: Sequence[Value]) -> Value | None:
    """A product with a matrix, by its columns."""
    rows = left.rows if isinstance(left, Matrix) else 1
    inner = components(left) // rows
    numbers: list[Number] = []
    for column in range(components(right) // inner):
        for row in range(rows):
            total: Number = 0.0
            for index in range(inner):
                term = arithmetic.binary(
                    "*", (values[0][index * rows + row],), (values[1][column * inner + index],), "float"
                )
                added = None if term is None else arithmetic.binary("+", (total,), term, "float")
                if added is None:
                    return None
                total = added[0]
            numbers.append(total)
    return tuple(numbers)


def _part(expr: ir.Expr, values: Sequence[Value]) -> Value | None:
    """A part of a constant."""
    whole: Value = values[0]
    if isinstance(expr, ir.Swizzle):
        return tuple([whole["xyzw".index(letter)] for letter in expr.components])
    part: Value
    if isinstance(expr, ir.Member):
        assert isinstance(expr.value.type, Struct)
        part = whole[[field.name for field in expr.value.type.fields].index(expr.field)]
        return part
    if not isinstance(expr, ir.Index):
        return None
    index, type_ = int(values[1][0]), expr.value.type
    size = components(expr.type) if isinstance(type_, Vector | Matrix) else 1
    if not 0 <= index < len(whole) // size:
        return None
    part = whole[index] if isinstance(type_, Array) else whole[index * size : (index + 1) * size]
    return part


def _construct(construct: ir.Construct, values: Sequence[Value]) -> Value | None:
    """A scalar, vector or matrix made of these values."""
    type_, numbers = construct.type, [number for value in values for number in value]
    converted = [arithmetic.converted(number, kind_of(type_)) for number in numbers]
    if isinstance(type_, Matrix) and len(values) == 1:
        return _matrix(type_, construct.args[0].type, converted)
    if len(converted) == 1:
        converted *= components(type_)
    result: list[Number] = [number for number in converted[: components(type_)] if number is not None]
    return tuple(result) if len(result) == components(type_) else None


def _matrix(type_: Matrix, source: Type, numbers: list[Number | None]) -> Value | None:
    """A matrix of a number (its diagonal) or of another matrix, with the rest as in the identity matrix."""
    result: list[Number] = []
    for column in range(type_.columns):
        for row in range(type_.rows):
            number: Number | None = float(row == column)
            if isinstance(source, Matrix):
                if column < source.columns and row < source.rows:
                    number = numbers[column * source.rows + row]
            elif row == column:
                number = numbers[0]
            if number is None:
                return None
            result.append(number)
    return tuple(result)
