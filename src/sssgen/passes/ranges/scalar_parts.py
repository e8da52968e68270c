"""The scalars of a value, in a fixed order; each has a range."""

from __future__ import annotations

from sssgen.ir.intervals import ANY, Range, widened
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, components, kind_of


def scalars(type_: Type) -> int:
    """How many ranges a value of this type has: all elements of an array share those of one."""
    if isinstance(type_, Array):
        return scalars(type_.element)
    if isinstance(type_, Struct):
        return sum(scalars(field.type) for field in type_.fields)
    return components(type_)


def scalar_kinds(type_: Type) -> list[str]:
    """The kind of each of these scalars."""
    if isinstance(type_, Array):
        return scalar_kinds(type_.element)
    if isinstance(type_, Struct):
        return [kind for field in type_.fields for kind in scalar_kinds(field.type)]
    return [kind_of(type_)] * components(type_)


def innermost(type_: Type) -> Type:
    """The element type of an array (of arrays); any other type unchanged."""
    while isinstance(type_, Array):
        type_ = type_.element
    return type_


def field_at(type_: Struct, name: str) -> tuple[int, int]:
    """The index of a field's first scalar in its struct, and how many scalars it has."""
    start = 0
    for field in type_.fields:
        count = scalars(field.type)
        if field.name == name:
            return start, count
        start += count
    raise KeyError(name)


def matrix_product(
    left: Type, a: tuple[Range, ...], right: Type, b: tuple[Range, ...], slack: float, largest: float
) -> list[Range] | None:
    """The components of a matrix product, whose sums round by `slack` of their terms; None if a factor is a scalar.

    A sum whose terms may together exceed `largest` can be any number, as one part of them may overflow.
    """
    if isinstance(left, Scalar) or isinstance(right, Scalar):
        return None
    rows = [list(a[row :: left.rows]) for row in range(left.rows)] if isinstance(left, Matrix) else [list(a)]
    inner = len(rows[0])
    columns = [list(b[start : start + inner]) for start in range(0, len(b), inner)]
    parts = []
    for column in columns:
        for row in rows:
            products = [x * y for x, y in zip(row, column, strict=True)]
            total, terms = Range(0.0, 0.0), 0.0
            for product in products:
                total, terms = total + product, terms + product.size
            exact = total
            total = widened(total, 0.0, slack * terms) if terms * (1.0 + slack) <= largest else ANY
            if all(product.low >= 0.0 for product in products):  # rounding gives no sum a sign that no term has
                total = Range(0.0, total.high, exact.gap * (1.0 - slack))
            parts.append(total)
    return parts


def hull_of(parts: tuple[Range, ...]) -> Range:
    """The smallest range that contains all of these."""
    hull = parts[0] if parts else ANY
    for part in parts[1:]:
        hull = hull.joined(part)
    return hull
