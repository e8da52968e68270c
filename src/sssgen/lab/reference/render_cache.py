"""A cache of renders, so that an interrupted render continues, and a render with more samples extends it.

An entry has the number of batches, their sum and the sum of their squares, which give mean and noise. The state after n
batches does not depend on the run, so caching does not change results.
"""

from __future__ import annotations

import contextlib
import io
import os
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.support import cache

Array = npt.NDArray[np.float64]


class Batches(NamedTuple):
    """The sum of equally large, independent batches of samples."""

    number: int
    total: Array
    """The sum of the batches' means"""
    squares: Array
    """The sum of their squares"""

    def with_batch(self, batch: Array) -> Batches:
        return Batches(self.number + 1, self.total + batch, self.squares + batch * batch)

    def mean(self) -> Array:
        return self.total / self.number

    def error(self) -> Array:
        """The standard error of the mean, from the batches' spread; at least two batches."""
        spread = np.maximum(self.squares / self.number - self.mean() ** 2, 0.0)
        error: Array = np.sqrt(spread / (self.number - 1))
        return error


def no_batches(shape: tuple[int, ...]) -> Batches:
    """The sum of no batches."""
    return Batches(0, np.zeros(shape), np.zeros(shape))


def read_batches(key: str, shape: tuple[int, ...], limit: int) -> Batches:
    """The largest cached state of a key with at most `limit` batches; no batches without a cache folder."""
    for count in sorted(_counts(key), reverse=True):
        if count <= limit:
            state = _read_entry(_name(key, count), shape)
            if state is not None and state.number == count:
                return state
    return no_batches(shape)


def store(key: str, batches: Batches, instead_of: int = 0) -> None:
    """Writes the state atomically, and deletes the key's state of `instead_of` batches."""
    if not cache.folder():
        return
    packed = io.BytesIO()
    np.savez(packed, count=batches.number, total=batches.total, squares=batches.squares)
    cache.write(_name(key, batches.number), packed.getvalue())
    if instead_of and instead_of != batches.number:
        with contextlib.suppress(OSError):
            os.unlink(os.path.join(cache.folder(), _name(key, instead_of)))


def _name(key: str, count: int) -> str:
    return f"reference-{key}-{count}.npz"


def _counts(key: str) -> list[int]:
    """The numbers of batches of a key's entries."""
    if not cache.folder():
        return []
    try:
        names = os.listdir(cache.folder())
    except OSError:
        return []
    head, tail = f"reference-{key}-", ".npz"
    parts = [name[len(head) : -len(tail)] for name in names if name.startswith(head) and name.endswith(tail)]
    return [int(part) for part in parts if part.isdecimal()]


def _read_entry(name: str, shape: tuple[int, ...]) -> Batches | None:
    """An entry; None for a damaged one."""
    try:
        with np.load(io.BytesIO(cache.read(name)), allow_pickle=False) as entry:
            state = Batches(int(entry["count"]), entry["total"], entry["squares"])
    except Exception:  # a damaged entry is rendered again
        return None
    valid = state.total.shape == state.squares.shape == shape and bool(np.isfinite(state.squares).all())
    return state if valid else None
