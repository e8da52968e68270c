"""Pauses Python's cycle collector: trees of tuples have no cycles, and its repeated passes over all objects would make
a text of ten times the length take some 18 times as long (`bench_transpile --speed`).
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def pause_gc() -> Iterator[None]:
    """No cycle collection inside the block."""
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
