"""Results as bytes, and the folder that stores each atomically under its item's key.

A run continues with the results of an interrupted run. The folder may be deleted; results are then computed again.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
from typing import Any

from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_writer import write_files

FOLDER = os.path.join("lab", "results")
"""The subfolder of the cache folder."""


def encoded(value: Any) -> bytes:
    """A value as bytes that depend only on its content, not on shared objects or an array's memory layout.

    Pickle must accept the value. It has no cycles (ValueError) and no sets, whose order differs between processes.
    """
    file = io.BytesIO()
    pickler = _Pickler(file, protocol=5)
    pickler.fast = True  # fast mode writes no references to earlier objects
    pickler.dump(value)
    return file.getvalue()


class _Pickler(pickle.Pickler):
    def reducer_override(self, value: Any) -> Any:
        if type(value).__module__ == "numpy" and type(value).__name__ == "ndarray":
            import numpy as np

            if not (value.flags.c_contiguous and value.flags.writeable):
                return np.array(value, order="C").__reduce_ex__(5)
        return NotImplemented


def decoded(data: bytes) -> Any:
    """The value of `encoded` bytes, a new object."""
    return pickle.loads(data)


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
