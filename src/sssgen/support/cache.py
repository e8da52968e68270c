"""The folder for what is cheap to make again: grammar tables, parsed techniques, compiled templates, emitted
shaders.

`SSSGEN_CACHE` names another folder, or turns caching on disk off when it is empty. Losing the folder costs time only.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import sys
from collections.abc import Callable
from typing import Any

_folder = ""
_known = False


def folder() -> str:
    """The cache folder, made if need be; '' where there is none to write to."""
    global _folder, _known
    if not _known:
        _folder, _known = _find(), True
    return _folder


def _find() -> str:
    path = os.environ.get("SSSGEN_CACHE")
    if path is None and sys.platform == "win32":
        path = os.path.join(os.environ.get("LOCALAPPDATA") or os.path.expanduser("~"), "sssgen", "cache")
    elif path is None:
        path = os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "sssgen")
    if path == "" or path.startswith("~"):  # turned off, or there is no home
        return ""
    try:
        os.makedirs(path, mode=0o700, exist_ok=True)
    except OSError:
        return ""
    return path if os.access(path, os.W_OK) else ""


def read(name: str) -> bytes:
    """A cache entry, or nothing."""
    if folder():
        with contextlib.suppress(OSError), open(os.path.join(folder(), name), "rb") as file:
            return file.read()
    return b""


def write(name: str, data: bytes) -> None:
    """Writes a cache entry whole or not at all; a full disk or a race with another process is no error."""
    if not folder():
        return
    path = os.path.join(folder(), name)
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "wb") as file:
            file.write(data)
        os.replace(temporary, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(temporary)


def kept(name: str, stamp: object, make: Callable[[], Any]) -> Any:
    """What `make` gives, from the entry `name` if that was made under the same stamp. It is something to pickle."""
    entry = unpickled(read(name))
    if isinstance(entry, tuple) and entry[0] == stamp:
        return entry[1]
    value = make()
    write(name, pickled((stamp, value)))
    return value


def unpickled(data: bytes) -> Any:
    """What a cache entry holds; None for a damaged one."""
    if not data:
        return None
    try:
        return pickle.loads(data)
    except Exception:  # it is made again, whatever is wrong with it
        return None


def pickled(value: object) -> bytes:
    """A value as a cache entry."""
    return pickle.dumps(value, protocol=5)


def stamp(place: str) -> list[tuple[str, int, int]]:
    """Tells one state of a folder's files from another; empty where there is no such folder."""
    found: list[tuple[str, int, int]] = []
    try:
        entries = sorted(os.scandir(place), key=lambda entry: entry.name)
    except OSError:
        return found
    for entry in entries:
        if entry.is_dir():
            found += stamp(entry.path) if entry.name != "__pycache__" else ()
        else:
            status = entry.stat()
            found.append((entry.path, status.st_size, status.st_mtime_ns))
    return found


def digest(data: str | bytes) -> str:
    """A short name for a content."""
    raw = data.encode("utf-8", "surrogatepass") if isinstance(data, str) else data
    return hashlib.blake2b(raw, digest_size=16).hexdigest()
