"""A limit on the time and the memory of one input; what exceeds it is reported with the input."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]  # a module's name holds None

SECONDS = 10
"""How long one input may take: ten times what the slowest takes on a machine that does nothing else."""


class TooSlow(BaseException):
    """An input took longer than it may. No `except Exception` on the way up swallows it."""


@contextlib.contextmanager
def bounded(seconds: int = SECONDS, what: str = "the input") -> Iterator[None]:
    """Raises TooSlow in the block, where the system has signals, once `seconds` of the clock have gone by.

    A system call that waits (a pipe that nobody writes to) is interrupted, too.
    """
    if not hasattr(signal, "SIGALRM"):
        yield
        return

    def ring(number: int, frame: FrameType | None) -> None:
        raise TooSlow(f"{what} took longer than {seconds} seconds")

    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


@contextlib.contextmanager
def roomy(mebibytes: int) -> Iterator[None]:
    """Lets the process have this much more memory in the block than it has at its start; more is a MemoryError."""
    if resource is None or not hasattr(resource, "RLIMIT_AS"):
        yield
        return
    before = resource.getrlimit(resource.RLIMIT_AS)
    limit = _used() + (mebibytes << 20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _used() -> int:
    """The bytes of address space that the process has now; 0 where the system does not tell."""
    try:
        return int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
    except OSError:
        return 1 << 40
