"""Remembers results together with the files that they were made from: a result is made again once one has changed.

A program that stays up (an editor, a watcher, a test run) so sees its materials and techniques as they are on disk, and
what has not changed costs a few calls of `stat`.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import NamedTuple, TypeVar

_T = TypeVar("_T")

KEPT = 1024
"""How many results one memory holds before it is emptied."""


class Kept(NamedTuple):
    """A result, the files read while it was made, and the state they were in."""

    files: tuple[str, ...]
    state: list[tuple[int, int]]
    value: object


_watching: list[set[str]] = []


def note(path: str | os.PathLike[str]) -> None:
    """Says that a file is being read for whatever is being made just now."""
    if _watching:
        full = os.path.abspath(path)
        for files in _watching:
            files.add(full)


def watched(make: Callable[[], _T]) -> tuple[_T, list[str]]:
    """What `make` gives, and the files that it read or looked for."""
    files: set[str] = set()
    _watching.append(files)
    try:
        return make(), sorted(files)
    finally:
        _watching.pop()


def remembered(memory: dict[str, Kept], key: str, make: Callable[[], _T]) -> _T:
    """What `make` gives, or what it gave before for this key, if no file that it read has changed since."""
    kept = memory.get(key)
    if kept is not None and _state(kept.files) == kept.state:
        for path in kept.files:
            note(path)
        return kept.value  # type: ignore[return-value]  # a memory holds what its own `make` gave
    value, files = watched(make)
    names = tuple(files)
    if len(memory) >= KEPT:
        memory.clear()
    memory[key] = Kept(names, _state(names), value)
    return value


def _state(files: tuple[str, ...]) -> list[tuple[int, int]]:
    """Each file's time and size; (0, -1) for one that is gone."""
    found = []
    for path in files:
        try:
            status = os.stat(path)
        except OSError:
            found.append((0, -1))
        else:
            found.append((status.st_mtime_ns, status.st_size))
    return found
