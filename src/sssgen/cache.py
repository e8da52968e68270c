"""The folder for what is cheap to make again: grammar tables, descriptors, parsed techniques, translated templates.

`SSSGEN_CACHE` names another folder, or turns caching on disk off when it is empty. Losing the folder costs time only.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

from .ir.typed import Any

_folder: Path | None = None
_known = False


def folder() -> Path | None:
    """The cache folder, made if need be; None where there is none to write to."""
    global _folder, _known
    if not _known:
        _folder, _known = _find(), True
    return _folder


def _find() -> Path | None:
    named = os.environ.get("SSSGEN_CACHE")
    if named is not None:
        path = Path(named) if named else None
    elif sys.platform == "win32":
        path = Path(os.environ.get("LOCALAPPDATA", Path.home())) / "sssgen" / "cache"
    else:
        path = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "sssgen"
    if path is None:
        return None
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        return None
    return path if os.access(path, os.W_OK) else None


def write(path: Path, data: bytes) -> None:
    """Writes a cache entry whole or not at all; a full disk or a race with another process is no error."""
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(data)
        temporary.replace(path)
    except OSError:
        temporary.unlink(missing_ok=True)


def kept(name: str, stamp: object, make: Callable[[], Any]) -> Any:
    """What `make` gives: plain data or code, from the entry `name` if that was made under the same stamp."""
    import marshal

    place = folder()
    if place is None:
        return make()
    path = place / name
    try:
        known, value = marshal.loads(path.read_bytes())
        if known == stamp:
            return value
    except (OSError, ValueError, EOFError, TypeError):  # none yet, or a damaged one
        pass
    value = make()
    write(path, marshal.dumps((stamp, value)))
    return value


def stamp(place: str) -> list[tuple[str, int, int]]:
    """Tells one state of a folder's files from another; empty where there is no such folder."""
    found: list[tuple[str, int, int]] = []
    try:
        entries = sorted(os.scandir(place), key=lambda entry: entry.name)
    except OSError:
        return found
    for entry in entries:
        if entry.is_dir():
            found += stamp(entry.path)
        else:
            status = entry.stat()
            found.append((entry.path, status.st_size, status.st_mtime_ns))
    return found


def digest(text: str) -> str:
    """A short name for a text."""
    from hashlib import blake2b

    return blake2b(text.encode(), digest_size=16).hexdigest()
