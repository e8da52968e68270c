"""The lengths that arrays without one get from their use, in desktop GLSL (GLSL 4.60, section 4.1.9).

`float a[]; a[3] = 1.0;` has 4 elements, as does `float a[]; float a[4];`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from sssgen.ir.spans import Span
from sssgen.lang.check.constant_values import integer_value
from sssgen.lang.syntax import tree as s


def length_by_use(file: s.File, name: str) -> int:
    """The least length that suits all numbers by which the file indexes variables of a name, and with which it declares
    them again; 0 where there are none. It does not tell variables of one name apart."""
    return max(_lengths(file, name), default=0)


def _lengths(node: object, name: str) -> Iterator[int]:
    if isinstance(node, s.IndexOf) and isinstance(node.value, s.Name) and node.value.text == name:
        yield _number(node.index) + 1
    if isinstance(node, s.Declarator) and node.name.text == name and node.lengths:
        yield _number(node.lengths[0])
    if isinstance(node, tuple) and not isinstance(node, Span):
        for part in node:
            yield from _lengths(part, name)
    elif is_dataclass(node):
        for field in fields(node):
            yield from _lengths(getattr(node, field.name), name)


def _number(expression: s.Expression) -> int:
    """The value of an integer literal, or -1."""
    if not isinstance(expression, s.Number) or expression.is_float:
        return -1
    number = integer_value(expression.text)
    return -1 if number is None else number
