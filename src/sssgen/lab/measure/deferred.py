"""Values by their names, of which those that take long are computed when one is read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, TypeVar

V = TypeVar("V")


class Deferred(Mapping[str, V]):
    """Values, and functions that compute others once. To list the names computes nothing."""

    def __init__(self, values: Mapping[str, V], computed: Mapping[str, Callable[[], V]]) -> None:
        self._values = dict(values)
        self._computed = dict(computed)

    def __getitem__(self, name: str) -> V:
        if name not in self._values:
            self._values[name] = self._computed[name]()
        return self._values[name]

    def get(self, name: str, default: Any = None) -> Any:
        """The value of a name, or the default; an error in a computation is not a missing name."""
        if name not in self:
            return default
        return self[name]

    def __contains__(self, name: object) -> bool:
        return name in self._values or name in self._computed

    def __iter__(self) -> Iterator[str]:
        return iter({**self._values, **self._computed})

    def __len__(self) -> int:
        return len({**self._values, **self._computed})

    def __or__(self, other: Mapping[str, V]) -> Deferred[V]:
        """Both, of equal names those of `other`; what is computed is computed once for all."""
        return Deferred({}, {**_reads(self), **_reads(other)})


def _reads(values: Mapping[str, V]) -> dict[str, Callable[[], V]]:
    return {name: partial(values.__getitem__, name) for name in values}
