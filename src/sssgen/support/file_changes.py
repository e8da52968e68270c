"""Waits until files change: for programs that make a result again after every save.

What counts is the state of the files, compared with the state in which they were read (`file_memo.noted_files`). The
system's messages only tell when to look, so a lost message delays a change by a second, and no save is missed.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Protocol

from sssgen.support.extras import need
from sssgen.support.file_memo import FileState, changed_files

QUIET_MS, LONGEST_MS = 10, 60
"""Messages are collected until none came for QUIET_MS, for at most LONGEST_MS."""

LOOK_MS, UNHEARD_MS = 1000, 200
"""Without a message the files are looked at after this time: network drives send none. The second is for a system that
refuses to send any."""

PATIENCE = 0.3
"""Seconds for which a missing or empty file is taken as one that an editor is just writing."""


class Stop(Protocol):
    """What ends the waiting: a `threading.Event`."""

    def is_set(self) -> bool: ...


class Messages(Protocol):
    """The system's messages about folders."""

    def follow(self, folders: list[str]) -> bool:
        """Listens to these folders from now on. True if it did not listen to all of them before."""

    def wait(self, milliseconds: int) -> bool:
        """Waits for messages, at most that long. False if the waiting has been ended."""

    def close(self) -> None: ...


def changes(
    files: Callable[[], Mapping[str, FileState]],
    stop: Stop | None = None,
    messages: Messages | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[set[str]]:
    """The files that have changed, each time that some have; ends when `stop` is set.

    `files` gives the files that the newest result depends on, with the states in which they were read. It is called
    before each wait, so the receiver makes its new result before it requests the next change. Saves in the meantime
    count as one. Raises KeyboardInterrupt on Ctrl-C.
    """
    messages = messages or FolderMessages(stop)
    read: Mapping[str, FileState] | None = None
    known: dict[str, FileState] = {}
    try:
        while True:
            newest = files()
            if newest is not read:  # otherwise the receiver made no new result: it gets no change a second time
                read, known = newest, {**newest}
            changed = _next_change(known, messages, clock)
            if not changed:
                return
            known |= changed
            yield set(changed)
    finally:
        messages.close()


def _next_change(
    known: Mapping[str, FileState], messages: Messages, clock: Callable[[], float]
) -> dict[str, FileState]:
    """Waits until files have another state than the known one. Nothing where the waiting was ended."""
    folders = _folders(known)
    patient_until: float | None = None
    while True:
        unheard = messages.follow(folders)
        changed = changed_files(known)
        if not changed:
            patient_until = None
            going = unheard or messages.wait(LOOK_MS)
        elif all(map(_complete, changed.values())) or (patient_until is not None and clock() >= patient_until):
            return changed
        else:
            patient_until = clock() + PATIENCE if patient_until is None else patient_until
            going = messages.wait(QUIET_MS)
        if not going:
            return {}


def _complete(state: FileState) -> bool:
    """Whether the file is there and not empty: an editor may empty or remove it before it writes the new text."""
    return state.size > 0


def _folders(files: Iterable[str]) -> list[str]:
    """The files' folders, and the folders of these, which tell that one was renamed."""
    own = {os.path.dirname(path) for path in files}
    return sorted(own | {os.path.dirname(folder) for folder in own})


class FolderMessages:
    """The messages of the operating system, by the package `watchfiles`."""

    def __init__(self, stop: Stop | None = None) -> None:
        self._notify: Any = need("watchfiles._rust_notify", "watchfiles", "preview").RustNotify
        self._stop = stop
        self._watcher: Any = None
        self._followed: dict[str, tuple[int, int]] = {}

    def follow(self, folders: list[str]) -> bool:
        numbers = dict(_numbers(folders))
        if numbers == self._followed:
            return False
        self.close()
        self._followed = numbers
        with contextlib.suppress(OSError):  # a folder vanished, or the system has no more watches: `wait` only waits
            self._watcher = self._notify([*numbers], False, False, 0, False, True)
        return True

    def wait(self, milliseconds: int) -> bool:
        if self._watcher is None:
            time.sleep(min(milliseconds, UNHEARD_MS) / 1000)
            return not (self._stop and self._stop.is_set())
        heard = self._watcher.watch(LONGEST_MS, QUIET_MS, milliseconds, self._stop)
        if heard == "signal":
            raise KeyboardInterrupt
        return bool(heard != "stop")

    def close(self) -> None:
        if self._watcher is not None:
            self._watcher.close()
        self._watcher, self._followed = None, {}


def _numbers(folders: Iterable[str]) -> Iterator[tuple[str, tuple[int, int]]]:
    """The folders that exist, each with what identifies it: a new folder may get the name of an old one."""
    for folder in folders:
        with contextlib.suppress(OSError, ValueError):
            status = os.stat(folder)
            yield folder, (status.st_dev, status.st_ino)
