"""What the page wrote into files, so that it can be taken back."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text

MOST = 100
"""The number of changes that are kept."""


class _Change(NamedTuple):
    path: str
    before: str
    after: str


class FileHistory:
    """The changes of files, the last one at the end."""

    def __init__(self) -> None:
        self._changes: list[list[_Change]] = []

    @contextmanager
    def recorded(self, paths: Iterable[str]) -> Iterator[None]:
        """Records what the block changes in the files, also where it fails."""
        before = {path: _text(path) for path in map(os.path.abspath, paths)}
        try:
            yield
        finally:
            after = {path: _text(path) for path in before}
            changes = [_Change(path, text, after[path]) for path, text in before.items() if text != after[path]]
            self._changes = [*self._changes, changes][-MOST:] if changes else self._changes

    def last(self) -> str:
        """The names of the files of the last change, or ''."""
        return ", ".join(os.path.basename(change.path) for change in self._changes[-1]) if self._changes else ""

    def undo(self) -> str:
        """Takes the last change back; says what it did. Raises SssgenError where a file was changed since."""
        if not self._changes:
            raise failure("there is nothing to undo")
        changes = self._changes[-1]
        for change in changes:
            if _text(change.path) != change.after:
                hint = "undo it in your editor"
                raise failure("the file was changed since, and stays as it is", hint, posix(change.path))
        for change in changes:
            write_files(os.path.dirname(change.path), {os.path.basename(change.path): change.before})
        self._changes.pop()
        return f"{', '.join(posix(os.path.relpath(change.path)) for change in changes)} is as it was before."


def _text(path: str) -> str:
    """The text of a file; '' where it cannot be read."""
    try:
        return read_text(path, posix(path))
    except SssgenError:
        return ""
