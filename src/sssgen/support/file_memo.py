"""Caches results in memory with the files that they depend on: a result is recomputed once one of them has changed.

A long-running program (an editor, a watcher, a test run) thus always sees the materials and techniques on disk; an
unchanged one costs a few calls of `stat`.
"""

from __future__ import annotations

import os
import time
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple, TypeVar

from sssgen.support import unsaved

_T = TypeVar("_T")

MAX_RESULTS = 1024
"""The number of results in one memory before the oldest is dropped."""

CLOCK_STEP = 20_000_000
"""Nanoseconds: two writes of a file within one step of the system's clock may have the same time."""


class FileState(NamedTuple):
    """What shows whether a file has changed: its time, size and number; of a missing file (0, -1, 0).

    A file that was written a moment ago may be written again at the same time, so it has a checksum of its content.
    """

    modified: int
    size: int
    inode: int
    checksum: int | None = None


MISSING = FileState(0, -1, 0)


class CachedResult(NamedTuple):
    """A result, and the files that it depends on, each with the state in which it was read."""

    files: dict[str, FileState]
    value: object


_watching: list[dict[str, FileState]] = []


def note(path: str | os.PathLike[str]) -> None:
    """Records that the results which are being computed depend on a file; to be called before it is read."""
    if _watching:
        full = os.path.abspath(path)
        state = file_state(full)
        for files in _watching:
            files.setdefault(full, state)


@contextmanager
def noted_files() -> Iterator[dict[str, FileState]]:
    """The files that are read or searched for in the block, also by what fails, each with its state before."""
    files: dict[str, FileState] = {}
    _watching.append(files)
    try:
        yield files
    finally:
        _watching[:] = [other for other in _watching if other is not files]


def remember(memory: dict[str, CachedResult], key: str, make: Callable[[], _T], most: int = MAX_RESULTS) -> _T:
    """The result of `make`, or the earlier one for this key if none of its files has changed.

    `most` is the number of results in this memory before the oldest is dropped.
    """
    cached = memory.get(key)
    if cached is not None and not changed_files(cached.files):
        for files in _watching:
            for path, state in cached.files.items():
                files.setdefault(path, state)
        return cached.value  # type: ignore[return-value]  # a memory has results of one type
    with noted_files() as read:
        value = make()
    memory.pop(key, None)
    while len(memory) >= most:
        del memory[next(iter(memory))]
    memory[key] = CachedResult(read, value)
    return value


def changed_files(files: Mapping[str, FileState]) -> dict[str, FileState]:
    """Those of the files whose state is another one now, with that state."""
    changed = {}
    for path, state in files.items():
        now = file_state(path, state.checksum is not None)
        if now[:3] != state[:3] or (state.checksum is not None and now.checksum != state.checksum):
            changed[path] = now
    return changed


def file_state(path: str, with_checksum: bool = False) -> FileState:
    """The state of a file. It has a checksum if that is requested, or if the file was written a moment ago.

    Of an editor's unsaved text it is (-1, N, 0) for the Nth.
    """
    if change := unsaved.change_of(path):
        return FileState(-1, change, 0)
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return MISSING
    checksum = None
    if with_checksum or status.st_mtime_ns > time.time_ns() - CLOCK_STEP:
        checksum = _checksum(path)
    return FileState(status.st_mtime_ns, status.st_size, status.st_ino, checksum)


def _checksum(path: str) -> int:
    """The checksum of a regular file's content; -1 where it cannot be read."""
    if not os.path.isfile(path):
        return -1
    try:
        with open(path, "rb") as file:
            return zlib.crc32(file.read())
    except OSError:
        return -1
