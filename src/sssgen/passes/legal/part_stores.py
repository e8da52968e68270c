"""Rewrites a store into a part of a vector or matrix as a store of the whole.

Why: naga refuses `v.xz = a`, and FXC an index that is not constant on the left, as in `m[i] = a`. Both become a
construction of the whole from its old parts and the new ones. Used by `legalise`.
"""

from __future__ import annotations

from collections.abc import Callable

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, Matrix, Scalar, Vector, components, kind_of, vector_of

Keep = Callable[[ir.Expr, str], ir.Expr]
"""Gives an expression that is cheap to repeat: the argument itself, or a variable with about this name."""


def whole_store(
    place: ir.Expr, value: ir.Expr, lacks_store: Callable[[ir.Expr], bool], keep: Keep
) -> tuple[ir.Expr, ir.Expr]:
    """The place and the value of a store that means `place = value` and of which no part is refused."""
    place = _pin(place, keep)
    while any(lacks_store(part) for part in parts_of(place)):
        place, value = _widen(place, value, keep)
    return place, value


def component_stores(
    place: ir.Expr, value: ir.Expr, lacks_store: Callable[[ir.Expr], bool], keep: Keep
) -> list[ir.Stmt]:
    """Stores that mean `place = value` in memory of several invocations: each of one component or column.

    A store of the whole would also write the components that other invocations write.
    """
    return _stores(_pin(place, keep), keep(value, f"{base_name(place)}_new"), lacks_store)


def _stores(place: ir.Expr, value: ir.Expr, lacks_store: Callable[[ir.Expr], bool]) -> list[ir.Stmt]:
    if not any(map(lacks_store, parts_of(place))):
        return [ir.Assign(place, "", value, place.span)]
    if isinstance(place, ir.Swizzle) and len(place.components) > 1:
        stores: list[ir.Stmt] = []
        for number, letter in enumerate(place.components):
            part = _part(place.value, "xyzw".index(letter), place.span)
            stores += _stores(part, _part(value, number, value.span), lacks_store)
        return stores
    if isinstance(place, ir.Index) and _in_registers(place):
        if isinstance(place.index, ir.Literal):
            return _stores(_part(place.value, int(place.index.value), place.span), value, lacks_store)
        type_ = place.value.type
        assert isinstance(type_, Vector | Matrix)
        stores = []
        for number in range(type_.columns if isinstance(type_, Matrix) else type_.size):
            chosen = ir.Literal(place.index.type, number, place.span)
            selected = ir.Binary(BOOL, "==", place.index, chosen, place.span)
            inner = _stores(_part(place.value, number, place.span), value, lacks_store)
            stores.append(ir.If(selected, tuple(inner), (), place.span))
        return stores
    assert isinstance(place, ir.Swizzle)  # one component of what has a part that is refused
    if isinstance(place.value, ir.Swizzle):
        return _stores(_part(place.value, "xyzw".index(place.components), place.span), value, lacks_store)
    stores = []
    for stmt in _stores(place.value, place.value, lacks_store):
        stores.append(_narrow(stmt, place, value))
    return stores


def _narrow(stmt: ir.Stmt, place: ir.Swizzle, value: ir.Expr) -> ir.Stmt:
    """A store of a whole column as the store of its component."""
    if isinstance(stmt, ir.If):
        return stmt._replace(then=tuple([_narrow(inner, place, value) for inner in stmt.then]))
    assert isinstance(stmt, ir.Assign)
    return stmt._replace(target=place._replace(value=stmt.target), value=value)


def _part(whole: ir.Expr, number: int, span: ir.Span) -> ir.Expr:
    """A component of a vector, or a column of a matrix; a scalar itself."""
    type_ = whole.type
    if isinstance(type_, Scalar):
        return whole
    if isinstance(type_, Matrix):
        return ir.Index(Vector("float", type_.rows), whole, ir.Literal(Scalar("int"), number, span), span)
    if isinstance(whole, ir.Swizzle):
        return whole._replace(type=Scalar(kind_of(type_)), components=whole.components[number])
    return ir.Swizzle(Scalar(kind_of(type_)), whole, "xyzw"[number], span)


def is_swizzle_store(part: ir.Expr) -> bool:
    """Whether several components would be stored at once."""
    return isinstance(part, ir.Swizzle) and len(part.components) > 1


def is_dynamic_store(part: ir.Expr) -> bool:
    """Whether the stored component or column depends on a value."""
    return isinstance(part, ir.Index) and _in_registers(part) and not isinstance(part.index, ir.Literal)


def base_name(place: ir.Expr) -> str:
    """The name of the variable or member that contains a place; names of temporaries are formed from it."""
    while isinstance(place, ir.Swizzle | ir.Index):
        place = place.value
    if isinstance(place, ir.Member):
        return place.field
    return place.name if isinstance(place, ir.Local | ir.Global) else "value"


def parts_of(place: ir.Expr) -> list[ir.Expr]:
    """A place and the values that contain it, up to an array's element or a whole variable."""
    parts: list[ir.Expr] = []
    while isinstance(place, ir.Swizzle) or (isinstance(place, ir.Index) and _in_registers(place)):
        parts.append(place)
        place = place.value
    return parts


def _in_registers(index: ir.Index) -> bool:
    return isinstance(index.value.type, Vector | Matrix)


def _pin(place: ir.Expr, keep: Keep) -> ir.Expr:
    """The place with its indices computed once."""
    if isinstance(place, ir.Swizzle | ir.Member):
        return place._replace(value=_pin(place.value, keep))
    if isinstance(place, ir.Index):
        return place._replace(value=_pin(place.value, keep), index=keep(place.index, "place"))
    return place


def _widen(place: ir.Expr, value: ir.Expr, keep: Keep) -> tuple[ir.Expr, ir.Expr]:
    """The store one step further out: of the vector or matrix that `place` is a part of."""
    assert isinstance(place, ir.Swizzle | ir.Index)
    vector, span = place.value, place.span
    type_ = vector.type
    assert isinstance(type_, Vector | Matrix)
    count = type_.columns if isinstance(type_, Matrix) else type_.size

    parts = [_part(vector, number, span) for number in range(count)]
    if isinstance(place, ir.Swizzle):
        if len(place.components) > 1:
            value = keep(value, f"{base_name(vector)}_{place.components}")
        for number, letter in enumerate(place.components):
            parts["xyzw".index(letter)] = _part(value, number, value.span)
    elif isinstance(place.index, ir.Literal):
        parts[int(place.index.value)] = value
    else:
        value = keep(value, f"{base_name(vector)}_new")
        for number in range(count):
            selected = ir.Binary(BOOL, "==", place.index, ir.Literal(place.index.type, number, span), span)
            parts[number] = ir.Select(parts[number].type, selected, value, parts[number], span)
    return vector, ir.Construct(type_, tuple(_join(parts)), span)


def _join(parts: list[ir.Expr]) -> list[ir.Expr]:
    """The components of a vector, with neighbours of one vector taken together: `v.x, v.y, w.z` as `v, w.z`."""
    joined: list[ir.Expr] = []
    for part in parts:
        last = joined[-1] if joined else None
        if not isinstance(part, ir.Swizzle) or not isinstance(last, ir.Swizzle) or part.value is not last.value:
            joined.append(part)
            continue
        letters = last.components + part.components
        joined[-1] = part._replace(type=vector_of(kind_of(part.type), len(letters)), components=letters)
    return [_whole(part) for part in joined]


def _whole(part: ir.Expr) -> ir.Expr:
    """A vector itself where all of its components are named in their order."""
    if not isinstance(part, ir.Swizzle) or part.type != part.value.type:
        return part
    return part.value if part.components == "xyzw"[: components(part.type)] else part
