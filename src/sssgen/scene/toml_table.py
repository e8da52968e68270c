"""Reads the tables of a scene: checks each value and reports each error with its position."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from sssgen.support.diagnostics import did_you_mean
from sssgen.support.toml_source import Document, Path

Range = tuple[float, float]
ANY: Range = (-1e9, 1e9)
POSITIVE: Range = (1e-6, 1e9)
NOT_NEGATIVE: Range = (0.0, 1e9)


class Key(NamedTuple):
    """What a key takes."""

    kind: str
    """number, whole, vector, wholes, text; other: the reader checks it by itself."""
    within: Range = ANY
    size: int = 1
    """How many numbers a vector has."""
    choices: tuple[str, ...] = ()
    """The texts that it takes; none: any."""


def number(within: Range = ANY) -> Key:
    return Key("number", within)


def whole(low: int, high: int) -> Key:
    return Key("whole", (low, high))


def vector(size: int, within: Range = ANY) -> Key:
    return Key("vector", within, size)


def wholes(size: int, low: int, high: int) -> Key:
    return Key("wholes", (low, high), size)


def text(*choices: str) -> Key:
    return Key("text", choices=choices)


def other() -> Key:
    return Key("other")


class Table:
    """One table of a document. A wrong value is reported, and replaced by the default."""

    def __init__(self, document: Document, path: Path, content: Any, keys: Mapping[str, Key]) -> None:
        self.document, self.path, self.keys = document, path, keys
        self.content: dict[str, Any] = content if isinstance(content, dict) else {}
        name = ".".join(str(part) for part in path if isinstance(part, str))
        if not isinstance(content, dict):
            document.error(document.place(*path).value, f"'{name}' is a table", f"write [{name}] and its keys below")
        for key in self.content:
            if key not in keys:
                hint = did_you_mean(key, keys) or f"keys: {', '.join(keys)}"
                where = f" in [{name}]" if name else ""
                document.error(document.place(*path, key).key, f"unknown key '{key}'{where}", hint)

    def error(self, key: str, message: str, hint: str = "", index: int | None = None) -> None:
        """Reports an error at a key's value, at one element of it, or at the table if the key is missing."""
        path = (*self.path, key) if index is None else (*self.path, key, index)
        self.document.error(self.document.place(*path).value, message, hint)

    def number(self, key: str, default: float) -> float:
        raw = self.content.get(key, default)
        return float(raw) if self._is_number(key, raw) else default

    def whole(self, key: str, default: int) -> int:
        raw = self.content.get(key, default)
        return int(raw) if self._is_whole(key, raw) else default

    def vector(self, key: str, default: tuple[float, ...]) -> Any:
        """A vector of as many finite numbers as `default`."""
        raw = self.content.get(key, list(default))
        if not isinstance(raw, list) or len(raw) != len(default):
            example = ", ".join(f"{value:g}" for value in default)
            self.error(key, f"'{key}' takes {len(default)} numbers", f"write {key} = [{example}]")
            return default
        valid = [self._is_number(key, element, index) for index, element in enumerate(raw)]
        return tuple(map(float, raw)) if all(valid) else default

    def wholes(self, key: str, default: tuple[int, ...]) -> Any:
        raw = self.content.get(key, list(default))
        if not isinstance(raw, list) or len(raw) != len(default):
            self.error(key, f"'{key}' takes {len(default)} whole numbers", f"write {key} = {list(default)}")
            return default
        valid = [self._is_whole(key, element, index) for index, element in enumerate(raw)]
        return tuple(raw) if all(valid) else default

    def text(self, key: str, default: str, choices: Collection[str] = ()) -> str:
        """One line of text: one of `choices`, or of those of the key, where there are any."""
        choices = choices or self.keys[key].choices
        raw = self.content.get(key, default)
        if not isinstance(raw, str) or any(ord(character) < 32 for character in raw):
            self.error(key, f"'{key}' takes one line of text", f'write {key} = "…"')
            return default
        if choices and raw != default and raw not in choices:
            hint = did_you_mean(raw, choices) or f"one of: {', '.join(choices)}"
            self.error(key, f"unknown {key} '{raw}'", hint)
            return default
        return raw

    def _is_number(self, key: str, raw: object, index: int | None = None) -> bool:
        if isinstance(raw, bool) or not isinstance(raw, int | float):
            self.error(key, f"'{key}' takes {'numbers' if index is not None else 'a number'}", "", index)
            return False
        return self._is_within(key, raw, index)

    def _is_whole(self, key: str, raw: object, index: int | None = None) -> bool:
        if isinstance(raw, bool) or not isinstance(raw, int):
            self.error(key, f"'{key}' takes {'whole numbers' if index is not None else 'a whole number'}", "", index)
            return False
        return self._is_within(key, raw, index)

    def _is_within(self, key: str, raw: float, index: int | None) -> bool:
        within = self.keys[key].within
        if within[0] <= raw <= within[1]:  # also false for nan
            return True
        shown = f"{raw:g}" if abs(raw) < 1e300 or not math.isfinite(raw) else "so large"
        self.error(key, f"'{key}' cannot be {shown}", f"it must be from {within[0]:g} to {within[1]:g}", index)
        return False
