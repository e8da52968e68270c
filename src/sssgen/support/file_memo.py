"""Caches results in memory with the files that they depend on: a result is recomputed once one of them has changed.

A long-running program (an editor, a watcher, a test run) thus always sees the materials and techniques on disk; an
unchanged one costs a few calls of `stat`.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from sssgen.support import unsaved

_T = TypeVar("_T")

MAX_RESULTS = 1024
"""The number of results in one memory before it is emptied."""


class CachedResult(NamedTuple):
    """A result, the files that it depends on, and their state."""

    files: tuple[str, ...]
    state: list[tuple[int, int]]
    value: object


_watching: list[set[str]] = []


def note(path: str | os.PathLike[str]) -> None:
    """Records that the results which are being computed depend on a file."""
    if _watching:
        full = os.path.abspath(path)
        for files in _watching:
            files.add(full)


def watched(make: Callable[[], _T]) -> tuple[_T, list[str]]:
    """The result of `make`, and the files that it read or searched for."""
    files: set[str] = set()
    _watching.append(files)
    try:
        return make(), sorted(files)
    finally:
        _watching.pop()


def remembered(memory: dict[str, CachedResult], key: str, make: Callable[[], _T]) -> _T:
    """The result of `make`, or the earlier one for this key if none of its files has changed."""
    cached = memory.get(key)
    if cached is not None and _state(cached.files) == cached.state:
        for path in cached.files:
            note(path)
        return cached.value  # type: ignore[return-value]  # a memory has results of one type
    value, files = watched(make)
    names = tuple(files)
    if len(memory) >= MAX_RESULTS:
        memory.clear()
    memory[key] = CachedResult(names, _state(names), value)
    return value


def _state(files: tuple[str, ...]) -> list[tuple[int, int]]:
    """Each file's time and size; (0, -1) for a missing one, (-1, N) for the Nth text that is not saved."""
    state = []
    for path in files:
        if change := unsaved.change_of(path):
            state.append((-1, change))
            continue
        try:
            status = os.stat(path)
        except OSError:
            state.append((0, -1))
        else:
            state.append((status.st_mtime_ns, status.st_size))
    return state
