"""Back ends, each in its own process for the duration of a run: after a crash the run continues."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from sssgen.run.backends import Backend, CompilerMissing
from sssgen.run.backends.backend_process import BackendProcess, start_backend
from sssgen.support.diagnostics import SssgenError


class BackendPool:
    """Back ends by name, each started when it is first used. `close` ends them."""

    def __init__(self) -> None:
        self._backends: dict[str, Callable[[], Backend]] = {}

    def get(self, name: str) -> Backend:
        """The back end. Raises CompilerMissing where this machine lacks it, SssgenError where it does not start."""
        if name not in self._backends:
            self._backends[name] = _start(name)
        return self._backends[name]()

    def close(self) -> None:
        """Ends the processes."""
        for get in self._backends.values():
            try:
                backend = get()
            except (CompilerMissing, SssgenError):
                continue
            if isinstance(backend, BackendProcess):
                backend.close()
        self._backends.clear()


def _start(name: str) -> Callable[[], Backend]:
    """A function that returns the back end, or raises the same error at every call."""
    try:
        backend = start_backend(name)
    except (CompilerMissing, SssgenError) as reason:
        return partial(_refuse, reason)
    return lambda: backend


def _refuse(reason: Exception) -> Backend:
    raise reason
