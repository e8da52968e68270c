"""The texts that an editor has open and has not saved: files are read with them in place of what is on disk."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

_texts: dict[str, tuple[int, str]] = {}
_changes = 0


def keep(path: str | os.PathLike[str], text: str) -> None:
    """Reads the text, from now on, wherever the file is read."""
    global _changes
    _changes += 1
    _texts[os.path.realpath(path)] = (_changes, text)


def drop(path: str | os.PathLike[str]) -> None:
    """Reads the file itself again."""
    _texts.pop(os.path.realpath(path), None)


@contextmanager
def kept(texts: Mapping[str, str]) -> Iterator[None]:
    """Reads the texts, by their paths, in place of the files in the block."""
    for path, text in texts.items():
        keep(path, text)
    try:
        yield
    finally:
        for path in texts:
            drop(path)


def text_of(path: str | os.PathLike[str]) -> str | None:
    """The text that is kept for a file."""
    kept = _texts.get(os.path.realpath(path)) if _texts else None
    return kept[1] if kept else None


def change_of(path: str) -> int:
    """A number that differs for each text kept for a file; 0 where the file itself is read."""
    kept = _texts.get(os.path.realpath(path)) if _texts else None
    return kept[0] if kept else 0


def any_kept() -> bool:
    """Whether any text is kept: results are then those of a moment, and not worth a place in the cache folder."""
    return bool(_texts)
