"""Imports optional packages; the error for a missing one names the extra that installs it."""

from __future__ import annotations

import contextlib
import importlib
import signal
import sys
import threading
from collections.abc import Iterator
from typing import Any

from sssgen.support.diagnostics import failure


def need(module: str, package: str = "", extra: str = "render") -> Any:
    """Imports a module of the distribution `package`, which an extra of sssgen installs.

    Raises SssgenError if it is missing.
    """
    try:
        with _delayed_interrupts():
            return importlib.import_module(module)
    except ImportError as error:
        from sssgen.support.installation import install_hint

        raise failure(f"the package '{package or module}' is missing: {error}", install_hint(extra)) from None


def missing_package(error: ModuleNotFoundError, extra: str) -> Exception:
    """The error for the user if a package is not installed; `error` itself if the module belongs to sssgen or Python.

    `extra` is the one that installs the packages of the command.
    """
    name = (error.name or "").partition(".")[0]
    if name in ("", "sssgen") or name in sys.stdlib_module_names:
        return error
    from sssgen.support.installation import install_hint

    return failure(f"the package '{name}' is missing", install_hint(extra))


@contextlib.contextmanager
def _delayed_interrupts() -> Iterator[None]:
    """Delays Ctrl-C until the import is done: some packages catch every exception while they import others."""
    foreign = signal.getsignal(signal.SIGINT) is None  # not set by Python, which cannot restore it
    if foreign or threading.current_thread() is not threading.main_thread():
        yield
        return
    pending: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, _: pending.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if pending:
            signal.raise_signal(pending[0])
