"""Back ends, each in a process of its own that lasts as long as a run: a crash costs one answer, not the run."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from sssgen.harness.backends import Backend, CompilerMissing
from sssgen.harness.backends.isolated import Isolated, started
from sssgen.support.diagnostics import SssgenError


class Started:
    """Back ends by name, each started when it is first asked for. `close` ends them."""

    def __init__(self) -> None:
        self._found: dict[str, Callable[[], Backend]] = {}

    def get(self, name: str) -> Backend:
        """The back end. Raises CompilerMissing where this machine lacks it, SssgenError where it does not start."""
        if name not in self._found:
            self._found[name] = _start(name)
        return self._found[name]()

    def close(self) -> None:
        """Ends the processes."""
        for found in self._found.values():
            try:
                backend = found()
            except (CompilerMissing, SssgenError):
                continue
            if isinstance(backend, Isolated):
                backend.close()
        self._found.clear()


def _start(name: str) -> Callable[[], Backend]:
    """What gives the back end, or says again why there is none."""
    try:
        backend = started(name)
    except (CompilerMissing, SssgenError) as reason:
        return partial(_refuse, reason)
    return lambda: backend


def _refuse(reason: Exception) -> Backend:
    raise reason
