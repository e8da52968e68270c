"""Packages that only some commands need: imported where they are used, so that a missing one can say how to get it."""

from __future__ import annotations

import contextlib
import importlib
import signal
import threading
from collections.abc import Iterator
from typing import Any

from sssgen.support.diagnostics import failure


def need(module: str, package: str = "", extra: str = "render") -> Any:
    """The module of that name; `package` is what it is installed as, `extra` the extra of sssgen's that brings it.

    Raises SssgenError where it is missing.
    """
    try:
        with _interrupts_wait():
            return importlib.import_module(module)
    except ImportError as error:
        message = f"the package '{package or module}' is missing: {error}"
        raise failure(message, f"pip install 'sssgen[{extra}]'") from None


@contextlib.contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Interrupts are raised afterwards: some packages catch whatever is raised while they import others."""
    unknown = signal.getsignal(signal.SIGINT) is None  # not set by Python: it could not be set again
    if unknown or threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: held.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if held:
            signal.raise_signal(held[0])
