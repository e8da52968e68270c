"""The values of constant expressions: array lengths, indices, case labels, locations (GLSL 4.60, section 4.3.3).

A constant is a literal, a const variable with a constant value, or an operator, constructor, builtin, element, member
or swizzle of constants.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir import nodes as ir
from sssgen.ir.constant_arithmetic import Number
from sssgen.ir.types import INT, UINT, Array, Matrix, Struct, Type, Vector, components, kind_of
from sssgen.lang.check.context import CheckContext
from sssgen.lang.syntax import tree as s

Value: TypeAlias = tuple[Any, ...]
"""The numbers of a scalar, vector or matrix (column after column); the values of an array's or struct's parts."""


def constant_int(context: CheckContext, expression: s.Expression) -> int | None:
    """The value of a constant integer expression, or None."""
    return integer(context, context.check_expression(expression).expr)


def integer(context: CheckContext, expr: ir.Expr) -> int | None:
    """The value of a checked constant integer expression, or None."""
    value = constant_value(context, expr) if expr.type in (INT, UINT) else None
    return None if value is None else int(value[0])


def constant_value(context: CheckContext, expr: ir.Expr) -> Value | None:
    """The value of a checked constant expression; None where it is not constant, or not defined."""
    if isinstance(expr, ir.Literal):
        return (expr.value,)
    if isinstance(expr, ir.Local):
        return context.function.scopes.visible[expr.name].value
    if isinstance(expr, ir.Global):
        return context.globals[expr.name].value
    if isinstance(expr, ir.Swizzle | ir.Member | ir.Index):
        return _part(context, expr)
    if isinstance(expr, ir.Select):
        condition = constant_value(context, expr.condition)
        return None if condition is None else constant_value(context, expr.yes if condition[0] else expr.no)
    operands: tuple[ir.Expr, ...]
    if isinstance(expr, ir.Binary):
        operands = expr.left, expr.right
    elif isinstance(expr, ir.Unary):
        operands = (expr.operand,)
    else:
        operands = () if isinstance(expr, ir.Call) else expr.args
    values: list[Value] = []
    for operand in operands:
        value = constant_value(context, operand)
        if value is None:
            return None
        values.append(value)
    return _computed(expr, values)


def _part(context: CheckContext, expr: ir.Swizzle | ir.Member | ir.Index) -> Value | None:
    """A part of a constant."""
    whole, type_ = constant_value(context, expr.value), expr.value.type
    if whole is None:
        return None
    if isinstance(expr, ir.Swizzle):
        return tuple([whole["xyzw".index(letter)] for letter in expr.components])
    if isinstance(expr, ir.Member):
        assert isinstance(type_, Struct)
        part: Value = whole[[field.name for field in type_.fields].index(expr.field)]
        return part
    index = integer(context, expr.index)
    size = components(expr.type) if isinstance(type_, Vector | Matrix) else 1
    if index is None or not 0 <= index < len(whole) // size:
        return None
    if isinstance(type_, Array):
        element: Value = whole[index]
        return element
    return whole[index * size : (index + 1) * size]


def _computed(expr: ir.Expr, values: list[Value]) -> Value | None:
    """The value of an operator, constructor or builtin of these constants."""
    if isinstance(expr, ir.Construct):
        return tuple(values) if isinstance(expr.type, Array | Struct) else _constructed(expr, values)
    if isinstance(expr, ir.Unary):
        return arithmetic.unary(expr.op, values[0], kind_of(expr.type))
    if isinstance(expr, ir.Binary):
        left, right = expr.left.type, expr.right.type
        if expr.op in ("==", "!="):
            return ((values[0] == values[1]) == (expr.op == "=="),)
        is_product = expr.op == "*" and Matrix in (type(left), type(right)) and components(left) > 1 < components(right)
        return None if is_product else arithmetic.binary(expr.op, values[0], values[1], kind_of(left))
    if isinstance(expr, ir.Intrinsic):
        return arithmetic.builtin(expr.name, values, [arg.type for arg in expr.args], expr.type)
    return None


def _constructed(construct: ir.Construct, values: list[Value]) -> Value | None:
    """A scalar, vector or matrix made of these values."""
    type_, numbers = construct.type, [number for value in values for number in value]
    converted = [arithmetic.converted(number, kind_of(type_)) for number in numbers]
    if isinstance(type_, Matrix) and len(values) == 1:
        return _matrix(type_.size, construct.args[0].type, converted)
    if len(converted) == 1:
        converted *= components(type_)
    result: list[Number] = [number for number in converted[: components(type_)] if number is not None]
    return tuple(result) if len(result) == components(type_) else None


def _matrix(size: int, source: Type, numbers: list[Number | None]) -> Value | None:
    """A matrix of a number (its diagonal) or of another matrix, with the rest as in the identity matrix."""
    given = source.size if isinstance(source, Matrix) else 0
    result: list[Number] = []
    for column in range(size):
        for row in range(size):
            number: Number | None = float(row == column)
            if max(row, column) < given:
                number = numbers[column * given + row]
            elif not given and row == column:
                number = numbers[0]
            if number is None:
                return None
            result.append(number)
    return tuple(result)


def integer_value(text: str) -> int | None:
    """The value of an integer literal; None for an invalid octal literal. Absurdly long literals are truncated."""
    digits = text.rstrip("uU")[:40]
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if len(digits) > 1 and digits[0] == "0":
        return int(digits, 8) if set(digits) <= set("01234567") else None
    return int(digits)
