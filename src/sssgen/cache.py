"""The folder for what is cheap to make again: grammar tables, parsed techniques, compiled templates, emitted shaders.

`SSSGEN_CACHE` names another folder, or turns caching on disk off when it is empty. Losing the folder costs time only.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

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
        os.replace(temporary, path)
    except OSError:
        temporary.unlink(missing_ok=True)
