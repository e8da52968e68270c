"""The types that type names stand for."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir.types import BY_NAME, Array, Matrix, Sampler, Type, Void, spell
from sssgen.lang.check import quantities as q
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.wording import a_type, why_not
from sssgen.lang.syntax import tree as s


def named_type(context: CheckContext, name: s.TypeName) -> tuple[Type, str]:
    """The type and the quantity that a type name stands for."""
    type_: Type
    quantity = ""
    if name.name in BY_NAME:
        type_ = BY_NAME[name.name]
    elif (struct := context.find_struct(name.name)) is not None:
        type_ = struct
    elif name.name in q.QUANTITIES and not context.plain:
        type_, quantity = q.QUANTITIES[name.name], name.name
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
    if name.lengths:
        return array_type(context, type_, name.lengths), ""
    return type_, quantity


def array_type(context: CheckContext, element: Type, lengths: Sequence[s.Expression], items: int | None = None) -> Type:
    """`element` itself without a length, else an array of that constant length; `items` is the length of `[]`."""
    if not lengths:
        return element
    if len(lengths) > 1 or isinstance(element, Array | Sampler | Void):
        message = f"there are no arrays of {'arrays' if len(lengths) > 1 else spell(element)}"
        raise context.fail(lengths[0].span, message)
    length = lengths[0]
    count = items if isinstance(length, s.Unsized) else constant_int(context, length)
    if count is None or not 1 <= count <= 65536:
        raise context.fail(length.span, "the length of an array must be a constant from 1 to 65536")
    return Array(element, count)
