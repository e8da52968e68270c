"""Results as bytes, and the folder that keeps them: each is written whole or not at all, under its item's key.

What an interrupted run has finished is found here by the next one. Losing the folder costs time only.
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
"""Where in the cache folder the results lie."""


def encoded(value: Any) -> bytes:
    """A value as bytes that depend on what it says alone: not on which equal objects are one, nor on how an array lies
    in memory.

    The value is what pickle takes, without cycles (ValueError) and without sets, whose order differs between processes.
    """
    file = io.BytesIO()
    pickler = _Pickler(file, protocol=5)
    pickler.fast = True  # no references to what was written before
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
    """The value of `encoded` bytes: a new one each time."""
    return pickle.loads(data)


class Store:
    """Bytes by key: `store.put(key, data)`, `store.get(key)`; in a folder, or in memory where that is ''.

    `folder` is the cache's own by default, and '' where there is no cache folder.
    """

    def __init__(self, folder: str | None = None) -> None:
        if folder is None:
            folder = os.path.join(cache.folder(), FOLDER) if cache.folder() else ""
        self.folder = folder
        self.memory: dict[str, bytes] = {}

    def get(self, key: str) -> bytes | None:
        """What lies under the key; nothing where that is missing or damaged."""
        if not self.folder:
            return self.memory.get(key)
        try:
            with open(os.path.join(self.folder, self._name(key)), "rb") as file:
                seal, data = file.read(len(_seal(b""))), file.read()
        except OSError:
            return None
        return data if seal == _seal(data) else None

    def put(self, key: str, data: bytes) -> None:
        """Keeps the data. That they cannot be written is no error: the next run makes them again."""
        if not self.folder:
            self.memory[key] = data
            return
        with contextlib.suppress(SssgenError):
            write_files(self.folder, {self._name(key): _seal(data) + data})

    def _name(self, key: str) -> str:
        return f"{key[:2]}/{key}"


def _seal(data: bytes) -> bytes:
    """What stands before the data, so that a file cut short by a failing disk is known for one."""
    return cache.digest(data).encode()
