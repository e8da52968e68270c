"""Python's collector of cycles, paused: trees of tuples have none, and looking for them makes a pass over all there is
again and again, so that a text of ten times the length would take some 18 times as long (`bench_transpile --speed`).
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def paused() -> Iterator[None]:
    """No collection inside, unless there was none before either."""
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
