"""The types that type names stand for."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sssgen.ir.spans import Span
from sssgen.ir.types import (
    BY_NAME,
    IMAGES,
    LINES,
    Array,
    Matrix,
    Sampler,
    Struct,
    Type,
    Void,
    spell,
    unnested,
    with_article,
)
from sssgen.lang.check import quantities as q
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.wording import a_type, why_not
from sssgen.lang.syntax import tree as s


def named_type(context: CheckContext, name: s.TypeName) -> tuple[Type, str]:
    """The type and the quantity that a type name stands for, with its lengths."""
    type_, quantity = named_element(context, name)
    if name.lengths:
        return array_type(context, type_, name.lengths), ""
    return type_, quantity


def named_element(context: CheckContext, name: s.TypeName) -> tuple[Type, str]:
    """The type and the quantity that a type name stands for without its lengths."""
    type_: Type
    quantity = ""
    if name.name in BY_NAME:
        type_ = BY_NAME[name.name]
    elif context.plain and name.name in LINES:
        type_ = LINES[name.name]
        context.has_lines = True
    elif (struct := context.find_struct(name.name)) is not None:
        type_ = struct
    elif name.name in q.QUANTITIES and not context.plain:
        type_, quantity = q.QUANTITIES[name.name], name.name
    elif context.plain and name.name in IMAGES:
        hint = "declare it at file scope as a uniform, and name it where it is read or written"
        raise context.fail(name.span, f"{with_article(name.name)} is no parameter, variable or member here", hint)
    elif context.plain and (why := why_not(name.name)):
        raise context.fail(name.span, f"'{name.name}' cannot be translated: {why}")
    else:
        raise context.unknown(name.span, "type", name.name, [*BY_NAME, *context.structs, *q.QUANTITIES])
    if (
        isinstance(type_, Matrix)
        and type_.columns != type_.rows
        and not context.plain
        and not name.span.file.startswith("intrinsics/")
    ):
        hint = "some engines have no other matrices"
        raise context.fail(name.span, f"{a_type(type_)} is not square, as a technique's matrices must be", hint)
    return type_, quantity


def array_type(
    context: CheckContext, element: Type, lengths: Sequence[s.Expression], items: Sequence[int] = ()
) -> Type:
    """`element` itself without a length, else an array of these constant lengths, the outermost first.

    `items` are the lengths of `[]`, for each of the lengths.
    """
    if not lengths:
        return element
    is_nested = len(lengths) > 1 or isinstance(element, Array)
    if isinstance(element, Sampler | Void) or (is_nested and (not context.plain or 0 < context.es < 310)):
        message = f"there are no arrays of {'arrays' if is_nested else spell(element)}"
        message += " before GLSL ES 3.10" if is_nested and context.es else ""
        raise context.fail(lengths[0].span, message)
    total = math.prod(unnested(element)[1])
    for index, length in reversed([*enumerate(lengths)]):
        before = context.sequences
        count = constant_int(context, length) if not isinstance(length, s.Unsized) else None
        check_sequences(context, before, length.span)
        if isinstance(length, s.Unsized) and index < len(items):
            count = items[index]
        total *= count or 0
        if count is None or count < 1 or total > 65536:
            hint = "write it, as neither a value nor a constant index says it" if isinstance(length, s.Unsized) else ""
            raise context.fail(length.span, "the length of an array must be a constant from 1 to 65536", hint)
        element = Array(element, count)
    return element


def names_type(context: CheckContext, name: str) -> bool:
    """Whether a name is that of a type here."""
    return context.function.scopes.find(name) is None and (name in BY_NAME or context.find_struct(name) is not None)


def holds_array(type_: Type) -> bool:
    """Whether it is an array, or a struct with one in it."""
    if isinstance(type_, Struct):
        return any(holds_array(field.type) for field in type_.fields)
    return isinstance(type_, Array)


def check_sequences(context: CheckContext, before: int, span: Span) -> None:
    """Reports a comma operator in a constant expression of GLSL ES 3.00 and later: `before` is the number of those
    before it."""
    if context.es >= 300 and context.sequences > before:
        raise context.fail(span, "the value of ',' is not constant in GLSL ES", "leave the comma out")
