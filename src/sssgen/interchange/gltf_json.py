"""Checked access to the JSON of a glTF file: every error names the element by its JSON path (RFC 6901)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from sssgen.interchange.mapping_report import short_text
from sssgen.support.diagnostics import SssgenError, failure


class JsonElement(NamedTuple):
    """A value of a glTF file, with its path."""

    value: Any
    path: str
    file: str

    def fault(self, message: str, hint: str = "") -> SssgenError:
        """The error of this element."""
        return failure(f"{self.path or '/'}: {message}", hint, self.file)

    def child(self, key: str) -> JsonElement | None:
        """The object of a key, or None without it. Raises SssgenError for another kind of value."""
        return self._of(key, dict, "an object")

    def require(self, key: str) -> JsonElement:
        """The value of a key that must be there. Raises SssgenError."""
        if key not in self.value:
            raise self.fault(f"'{key}' is missing")
        return self._child(key)

    def items(self, key: str) -> list[JsonElement]:
        """The elements of an array; none without the key. Raises SssgenError for another kind of value."""
        array = self._of(key, list, "an array")
        return (
            []
            if array is None
            else [JsonElement(value, f"{array.path}/{i}", self.file) for i, value in enumerate(array.value)]
        )

    def objects(self, key: str) -> list[JsonElement]:
        """The same for an array of objects. Raises SssgenError."""
        elements = self.items(key)
        for element in elements:
            if not isinstance(element.value, dict):
                raise element.fault(f"an object is needed, not {short_text(element.value)}")
        return elements

    def members(self, key: str) -> Iterator[JsonElement]:
        """The values of an object; none without the key."""
        parent = self.child(key)
        for name in parent.value if parent is not None else ():
            assert parent is not None
            yield parent._child(name)

    def text(self, key: str, default: str = "") -> str:
        """A string. Raises SssgenError for another kind of value."""
        element = self._of(key, str, "a string")
        return default if element is None else str(element.value)

    def flag(self, key: str) -> bool:
        """A truth value; false without it. Raises SssgenError for another kind of value."""
        element = self._of(key, bool, "true or false")
        return element is not None and bool(element.value)

    def number(self, key: str, default: float, low: float = -math.inf, high: float = math.inf) -> float:
        """A number in a range. Raises SssgenError for another value, such as NaN."""
        if key not in self.value:
            return default
        return self._child(key).as_number(low, high)

    def vector(
        self, key: str, default: Sequence[float], low: float = -math.inf, high: float = math.inf
    ) -> tuple[float, ...]:
        """Numbers, as many as the default has, in a range. Raises SssgenError for other values."""
        if key not in self.value:
            return tuple(default)
        elements = self.items(key)
        if len(elements) != len(default):
            raise self._child(key).fault(f"{len(default)} numbers are needed, not {len(elements)}")
        return tuple(element.as_number(low, high) for element in elements)

    def as_number(self, low: float = -math.inf, high: float = math.inf) -> float:
        """The element as a number in a range. Raises SssgenError."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.fault(f"a number is needed, not {short_text(self.value)}")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.fault("this is not a finite number", "export the file again")
        if not low <= number <= high:
            limits = f"at least {low:g}" if math.isinf(high) else f"{low:g} to {high:g}"
            raise self.fault(f"{number:g} is out of range", limits)
        return number

    def whole(self, key: str, default: int | None = None, low: int = 0, high: int = 2**31) -> int:
        """An integer in a range; `default` without the key. Raises SssgenError for another value."""
        if key not in self.value and default is not None:
            return default
        element = self.require(key)
        if isinstance(element.value, bool) or not isinstance(element.value, int):
            raise element.fault(f"an integer is needed, not {short_text(element.value)}")
        if not low <= element.value <= high:
            raise element.fault(f"{short_text(element.value)} is out of range", f"{low} to {high}")
        return element.value

    def reference(self, key: str, table: Sequence[JsonElement], kind: str) -> JsonElement:
        """The element of a table that a key names by its index. Raises SssgenError where there is none."""
        index = self.whole(key)
        if index >= len(table):
            raise self._child(key).fault(f"there is no {kind} {index}", f"the file has {len(table)}")
        return table[index]

    def has(self, key: str) -> bool:
        """Whether the object has a key."""
        return key in self.value

    def extension(self, name: str) -> JsonElement | None:
        """The object of an extension, or None without it."""
        extensions = self.child("extensions")
        return None if extensions is None else extensions.child(name)

    def _child(self, key: str) -> JsonElement:
        return JsonElement(self.value[key], f"{self.path}/{key.replace('~', '~0').replace('/', '~1')}", self.file)

    def _of(self, key: str, kind: type, words: str) -> JsonElement | None:
        if key not in self.value:
            return None
        element = self._child(key)
        if not isinstance(element.value, kind):
            raise element.fault(f"{words} is needed, not {short_text(element.value)}")
        return element
