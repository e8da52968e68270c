"""The cache folder. It contains results that another process can use; if it is lost, they are computed again.

It contains four things, each for a measured gain of time (docs/architecture.md, Speed): the
checked IR of each source file, the program of each material before its values are filled in, the files of each
`sssgen emit` command, and the triangles of the preview's bodies. Jinja keeps its compiled templates in the same folder.

`SSSGEN_CACHE` names another folder; an empty value turns the cache off. Entries are pickled, so an entry that somebody
else writes could run code here: a folder that other users own or can write to is not used, and an entry is unpickled
only after its checksum was compared.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import sys
from collections.abc import Callable
from typing import Any

DIGEST_SIZE = 16

_folder: str | None = None


def folder() -> str:
    """The cache folder, created on demand; '' where there is none to write to."""
    global _folder
    if _folder is None:
        _folder = _usable_folder()
    return _folder


def _usable_folder() -> str:
    path = os.environ.get("SSSGEN_CACHE")
    if path is None and sys.platform == "win32":
        path = os.path.join(os.environ.get("LOCALAPPDATA") or os.path.expanduser("~"), "sssgen", "cache")
    elif path is None:
        path = os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "sssgen")
    if path == "" or path.startswith("~"):  # turned off, or there is no home folder
        return ""
    try:
        os.makedirs(path, mode=0o700, exist_ok=True)
        status = os.stat(path)
    except OSError:
        return ""
    if hasattr(os, "geteuid") and (status.st_uid != os.geteuid() or status.st_mode & 0o022):
        return ""  # another user could put entries there
    return path if os.access(path, os.W_OK) else ""


def read(name: str) -> bytes:
    """The bytes of an entry; nothing where there is none, or where its checksum does not fit."""
    if folder():
        with contextlib.suppress(OSError), open(os.path.join(folder(), name), "rb") as file:
            entry = file.read()
            checksum, data = entry[:DIGEST_SIZE], entry[DIGEST_SIZE:]
            return data if _checksum(data) == checksum else b""
    return b""


def write(name: str, data: bytes) -> None:
    """Writes an entry atomically. A full disk, or another process that writes the same entry, is no error."""
    if not folder():
        return
    path = os.path.join(folder(), name)
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "wb") as file:
            file.write(_checksum(data) + data)
        os.replace(temporary, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(temporary)


def _checksum(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=DIGEST_SIZE).digest()


def load_or_make(name: str, stamp: object, make: Callable[[], Any]) -> Any:
    """The value of the entry `name` if it was written under an equal stamp; else that of `make`, which is written.

    The value must be picklable.
    """
    entry = unpickle(read(name))
    if isinstance(entry, tuple) and entry[0] == stamp:
        return entry[1]
    value = make()
    write(name, to_pickle((stamp, value)))
    return value


def unpickle(data: bytes) -> Any:
    """The value of an entry that `read` returned; None where it cannot be read."""
    if not data:
        return None
    try:
        return pickle.loads(data)
    except Exception:  # written by another version of Python or of a class: it is made again
        return None


def to_pickle(value: object) -> bytes:
    """A value as the bytes of an entry."""
    return pickle.dumps(value, protocol=5)


def stamp(path: str) -> list[tuple[str, int, int]]:
    """Path, size and time of each file below a folder, to notice a change; empty where there is no such folder."""
    rows: list[tuple[str, int, int]] = []
    try:
        entries = sorted(os.scandir(path), key=lambda entry: entry.name)
    except OSError:
        return rows
    for entry in entries:
        if entry.is_dir():
            rows += stamp(entry.path) if entry.name != "__pycache__" else ()
        else:
            status = entry.stat()
            rows.append((entry.path, status.st_size, status.st_mtime_ns))
    return rows


def digest(data: str | bytes) -> str:
    """A short name for a content."""
    raw = data.encode("utf-8", "surrogatepass") if isinstance(data, str) else data
    return hashlib.blake2b(raw, digest_size=DIGEST_SIZE).hexdigest()
