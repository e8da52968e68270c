"""Renders kept by their content, as far as they got: so an interrupted one goes on, and a finer one starts from it.

What is kept after n batches is their number, their sum and the sum of their squares: mean and noise follow from it.
The state after n batches is the same whichever run reached it, so a kept one changes no number.
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

    def and_another(self, batch: Array) -> Batches:
        return Batches(self.number + 1, self.total + batch, self.squares + batch * batch)

    def mean(self) -> Array:
        return self.total / self.number

    def error(self) -> Array:
        """The standard error of the mean, from the batches' spread; two batches at least."""
        spread = np.maximum(self.squares / self.number - self.mean() ** 2, 0.0)
        error: Array = np.sqrt(spread / (self.number - 1))
        return error


def nothing(shape: tuple[int, ...]) -> Batches:
    """No batch yet."""
    return Batches(0, np.zeros(shape), np.zeros(shape))


def kept(key: str, shape: tuple[int, ...], wanted: int) -> Batches:
    """The most batches, at most `wanted`, that are kept under a key; none where there is no cache folder."""
    for count in sorted(_counts(key), reverse=True):
        if count <= wanted:
            found = _read(_name(key, count), shape)
            if found is not None and found.number == count:
                return found
    return nothing(shape)


def keep(key: str, batches: Batches, instead_of: int = 0) -> None:
    """Writes the batches, whole or not at all, and drops those kept under the same key as `instead_of` batches."""
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
    """How many batches the entries of a key hold."""
    if not cache.folder():
        return []
    try:
        names = os.listdir(cache.folder())
    except OSError:
        return []
    head, tail = f"reference-{key}-", ".npz"
    parts = [name[len(head) : -len(tail)] for name in names if name.startswith(head) and name.endswith(tail)]
    return [int(part) for part in parts if part.isdecimal()]


def _read(name: str, shape: tuple[int, ...]) -> Batches | None:
    """An entry; None for a damaged one, whatever is wrong with it."""
    try:
        with np.load(io.BytesIO(cache.read(name)), allow_pickle=False) as entry:
            found = Batches(int(entry["count"]), entry["total"], entry["squares"])
    except Exception:  # it is made again
        return None
    sound = found.total.shape == found.squares.shape == shape and bool(np.isfinite(found.squares).all())
    return found if sound else None
