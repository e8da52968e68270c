"""The folder that stores results as bytes, each atomically under its item's key.

A run continues with the results of an interrupted run. The folder may be deleted; results are then computed again.
"""

from __future__ import annotations

import contextlib
import os

from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_writer import write_files

FOLDER = os.path.join("lab", "results")
"""The subfolder of the cache folder."""


class Store:
    """Bytes by key: `store.put(key, data)`, `store.get(key)`; in a folder, or in memory if it is ''.

    The default folder is in the cache folder; it is '' without a cache folder.
    """

    def __init__(self, folder: str | None = None) -> None:
        if folder is None:
            folder = os.path.join(cache.folder(), FOLDER) if cache.folder() else ""
        self.folder = folder
        self.memory: dict[str, bytes] = {}

    def get(self, key: str) -> bytes | None:
        """The data of a key; None if it is missing or damaged."""
        if not self.folder:
            return self.memory.get(key)
        try:
            with open(os.path.join(self.folder, self._name(key)), "rb") as file:
                seal, data = file.read(len(_seal(b""))), file.read()
        except OSError:
            return None
        return data if seal == _seal(data) else None

    def put(self, key: str, data: bytes) -> None:
        """Stores the data. A failed write is no error: the next run computes the data again."""
        if not self.folder:
            self.memory[key] = data
            return
        with contextlib.suppress(SssgenError):
            write_files(self.folder, {self._name(key): _seal(data) + data})

    def _name(self, key: str) -> str:
        return f"{key[:2]}/{key}"


def _seal(data: bytes) -> bytes:
    """The digest before the data, which detects truncated files."""
    return cache.digest(data).encode()
