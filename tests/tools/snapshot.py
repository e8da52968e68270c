"""Compares a text with a file of tests/snapshots; UPDATE_SNAPSHOTS=1 writes the file instead."""

from __future__ import annotations

import os

from folders import SNAPSHOTS


def check_snapshot(name: str, text: str) -> None:
    """Fails if `text` is not the content of tests/snapshots/NAME."""
    path = SNAPSHOTS / name
    if os.environ.get("UPDATE_SNAPSHOTS"):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    assert path.is_file(), f"no snapshot {name}: review the text, then set UPDATE_SNAPSHOTS=1\n{text}"
    assert text == path.read_text(encoding="utf-8"), f"{name} changed; UPDATE_SNAPSHOTS=1 stores the new text"
