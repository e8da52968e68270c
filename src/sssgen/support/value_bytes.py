"""Values as bytes that depend only on their content, for digests and for results in files."""

from __future__ import annotations

import io
import pickle
from typing import Any


def encode(value: Any) -> bytes:
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


def decode(data: bytes) -> Any:
    """The value of bytes that `encode` returned, a new object."""
    return pickle.loads(data)
