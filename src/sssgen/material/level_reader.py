"""Reads the levels of detail of a material's TOML: how many there are, and to which of them a stage belongs."""

from __future__ import annotations

from typing import Any, TypeGuard

from sssgen.material.model import MOST_LEVELS
from sssgen.support.toml_source import Document

LEVELED = ("coordinates", "thickness", "surface", "translucency")
"""The sections whose stages may belong to some levels of detail."""


def level_count(document: Document, table: Any) -> int:
    """The number of levels of detail in the [material] section."""
    value = table.get("levels", 1) if isinstance(table, dict) else 1
    if _is_number(value) and 1 <= value <= MOST_LEVELS:
        return int(value)
    message = f"'levels' takes a number of levels of detail, 1 to {MOST_LEVELS}"
    document.error(document.place("material", "levels").value, message, "write levels = 2")
    return MOST_LEVELS


def stage_levels(document: Document, path: tuple[str | int, ...], raw: object, count: int) -> tuple[int, ...]:
    """The levels of detail that a stage belongs to, sorted; () after an error. `path` begins with its section."""
    place, section = document.place(*path), path[0]
    numbers: list[object] = raw if isinstance(raw, list) else [raw]
    whole = [number for number in numbers if _is_number(number)]
    if section not in LEVELED:
        message = f"a [{section}] stage belongs to all levels of detail"
        document.error(place.key, message, f"omit level; sections that may have it: {', '.join(LEVELED)}")
    elif not whole or len(whole) < len(numbers):
        message = "'level' takes the number of a level of detail, or a list of numbers"
        document.error(place.value, message, "write level = 0, or level = [0, 1]")
    elif not all(0 <= number < count for number in whole):
        names = f"the levels are 0 to {count - 1}" if count > 1 else "the material has one level"
        fits = min(whole) >= 0 and max(whole) < MOST_LEVELS
        hint = f"write levels = {max(*whole, 1) + 1} in [material]" if fits else f"levels are 0 to {MOST_LEVELS - 1}"
        document.error(place.value, f"'level' is {raw}, but {names}", hint)
    else:
        return tuple(sorted(set(whole)))
    return ()


def _is_number(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)
