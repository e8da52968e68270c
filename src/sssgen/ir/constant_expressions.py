"""Constants as expressions: literals, and vectors and matrices of literals."""

from __future__ import annotations

from math import copysign

from sssgen.ir import constant_arithmetic as arithmetic
from sssgen.ir.constant_arithmetic import Number, Numbers
from sssgen.ir.nodes import Construct, Expr, Literal, Span
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, Vector, components, kind_of


def uniform_value(type: Type, numbers: tuple[float, ...], span: Span) -> Expr:
    """A uniform's components as an expression; a matrix column after column."""
    if components(type) != len(numbers) or not numbers:
        raise ValueError(f"{len(numbers)} components for {components(type)}")
    if isinstance(type, Array):
        size = components(type.element)
        parts = [numbers[start : start + size] for start in range(0, len(numbers), size)]
        return Construct(type, tuple([uniform_value(type.element, part, span) for part in parts]), span)
    kind = kind_of(type)
    values = tuple([{"float": float, "bool": bool}.get(kind, int)(number) for number in numbers])
    if isinstance(type, Matrix):
        return Construct(type, tuple([Literal(Scalar(kind), value, span) for value in values]), span)
    return literal(type, values, span)


def zero(type: Type, span: Span) -> Expr:
    """A value of this type whose components are all zero."""
    if isinstance(type, Scalar):
        return Literal(type, {"float": 0.0, "bool": False}.get(type.kind, 0), span)
    if isinstance(type, Vector | Matrix):
        return Construct(type, (zero(Scalar(type.kind), span),), span)
    if isinstance(type, Array):
        return Construct(type, (zero(type.element, span),) * type.length, span)
    assert isinstance(type, Struct)
    return Construct(type, tuple([zero(field.type, span) for field in type.fields]), span)


def literal(type: Type, values: Numbers, span: Span) -> Expr:
    """Scalars, a vector or a matrix as literals; `vec3(1.0)` where all are the same."""
    if isinstance(type, Scalar):
        return Literal(type, values[0], span)
    scalar = Scalar(kind_of(type))
    if isinstance(type, Vector) and all(same_number(value, values[0]) for value in values):
        values = values[:1]
    return Construct(type, tuple([Literal(scalar, value, span) for value in values]), span)


def same_number(first: Number, second: Number) -> bool:
    return first == second and copysign(1.0, first) == copysign(1.0, second)


def constant_numbers(expr: Expr) -> Numbers | None:
    """The components of a literal or of a vector of literals, floats as float32; else None."""
    if isinstance(expr, Literal):
        value = expr.value
        if type(value) is float:
            single = arithmetic.float32(value)
            return None if single is None else (single,)
        return (value,)
    if isinstance(expr, Construct) and isinstance(expr.type, Vector):
        values: Numbers = ()
        for arg in expr.args:
            part = constant_numbers(arg) if isinstance(arg, Literal) else None
            if part is None:
                return None
            values += part
        return values if len(values) == expr.type.size else values * expr.type.size
    return None


def placed_at(value: Expr, span: Span) -> Expr:
    """A constant with another place."""
    if isinstance(value, Literal):
        return Literal(value.type, value.value, span)
    assert isinstance(value, Construct)
    return Construct(value.type, tuple([placed_at(arg, span) for arg in value.args]), span)
