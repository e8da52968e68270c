"""Places of a random program's variables: reading and storing a whole variable or a part of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from glsl_values import Undefined, Value

Place = tuple[list[Any], int, tuple[Any, ...]]
"""A frame, a slot of it, and the indices of the part; a tuple of indices is a swizzle."""


class Unset:
    """The value of a variable that has none yet."""


UNSET = Unset()


def each(function: Callable[[Any], Any], value: Value) -> Value:
    if isinstance(value, tuple):
        return tuple([each(function, part) for part in value])
    return function(value)


def require_defined(value: Value) -> Value:
    """A value that has no unset part."""
    if value is UNSET:
        raise Undefined("a variable without a value")
    if isinstance(value, tuple):
        for part in value:
            require_defined(part)
    return value


def element_at(value: Value, index: int) -> Value:
    if not 0 <= index < len(value):
        raise Undefined("index")
    return value[index]


def inside(place: Place, part: Any) -> Place:
    frame, slot, path = place
    if path and isinstance(path[-1], tuple):  # a part of a swizzle is a component of what the swizzle selects
        selected = path[-1]
        last: Any = tuple(selected[i] for i in part) if isinstance(part, tuple) else element_at(selected, part)
        return frame, slot, (*path[:-1], last)
    return frame, slot, (*path, part)


def load(place: Place) -> Value:
    frame, slot, path = place
    value = frame[slot]
    for part in path:
        value = part_of(value, part)
    return require_defined(value)


def part_of(value: Value, part: Any) -> Value:
    if value is UNSET:
        raise Undefined("a variable without a value")
    if isinstance(part, tuple):
        return tuple([value[i] for i in part])
    return element_at(value, part)


def store(place: Place, value: Value) -> Value:
    frame, slot, path = place
    frame[slot] = replaced(frame[slot], path, value)
    return value


def replaced(old: Value, path: tuple[Any, ...], value: Value) -> Value:
    if not path:
        return value
    part, rest = path[0], path[1:]
    if old is UNSET:
        raise Undefined("a part of a variable without a value")
    new = list(old)
    if isinstance(part, tuple):
        for index, number in zip(part, value, strict=True):
            new[index] = number
    else:
        new[part] = replaced(element_at(old, part), rest, value)
    return tuple(new)
