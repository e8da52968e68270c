"""Places that statements write to, such as `a[i].v.xy`: whether two of them may share a component."""

from __future__ import annotations

from collections.abc import Set

from sssgen.ir.nodes import Expr, Global, Index, Literal, Member, Swizzle
from sssgen.ir.walk import written_root

_LETTERS = "xyzw"

_Step = Set[int | str] | None
"""The parts that one step of a place selects: components, elements, a field; None: any of them."""


def may_overlap(first: Expr, second: Expr) -> bool:
    """Whether an assignment to one place may change the other; an index that is not a literal may be any."""
    first_root, second_root = written_root(first), written_root(second)
    if first_root is None or second_root is None or first_root.name != second_root.name:
        return False
    if isinstance(first_root, Global) != isinstance(second_root, Global):
        return False
    pairs = zip(_steps(first), _steps(second), strict=False)
    return not any(left is not None and right is not None and left.isdisjoint(right) for left, right in pairs)


def _steps(place: Expr) -> list[_Step]:
    """What each step from the variable to the place selects; the steps inside a vector are one."""
    if isinstance(place, Member):
        return [*_steps(place.value), {place.field}]
    if not isinstance(place, Index | Swizzle):
        return []
    before = _steps(place.value)
    step: _Step = None
    if isinstance(place, Swizzle):
        step = set(map(_LETTERS.index, place.components))
    elif isinstance(place.index, Literal):
        step = {int(place.index.value)}
    if isinstance(place.value, Swizzle):  # a part of a part
        inner, letters = before.pop(), place.value.components
        step = inner if step is None else {_LETTERS.index(letters[int(number)]) for number in step}
    return [*before, step]
