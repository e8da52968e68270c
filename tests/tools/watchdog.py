"""Limits on the processor time and the memory of one input; an input that exceeds them is reported."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

try:
    import resource
except ImportError:  # on Windows
    resource = None  # type: ignore[assignment]  # a module's name holds None

SECONDS = 30
"""The limit of processor time for an input: ten times that of the slowest input."""
HANG = 600
"""The number of seconds after which an input counts as hanging, for instance in a read of an unused pipe."""


class TooSlow(BaseException):
    """An input exceeded its time. Not an Exception, so that the code under test cannot catch it."""


@contextlib.contextmanager
def bounded(seconds: int = SECONDS, what: str = "the input") -> Iterator[None]:
    """Raises TooSlow in the block if it uses `seconds` of processor time (on systems with signals)."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def too_slow(number: int, frame: FrameType | None) -> None:
        raise TooSlow(f"{what} took more than {seconds} seconds of processor time, or {HANG} seconds in all")

    timers = ((signal.SIGPROF, signal.ITIMER_PROF, seconds), (signal.SIGALRM, signal.ITIMER_REAL, HANG))
    handlers = [signal.signal(number, too_slow) for number, _, _ in timers]
    for _, timer, limit in timers:
        signal.setitimer(timer, limit)
    try:
        yield
    finally:
        for (number, timer, _), handler in zip(timers, handlers, strict=True):
            signal.setitimer(timer, 0)
            signal.signal(number, handler)


@contextlib.contextmanager
def roomy(mebibytes: int) -> Iterator[None]:
    """Limits the additional memory of the process in the block; more gives a MemoryError."""
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
    """The current size of the address space in bytes; 0 if the system does not report it."""
    try:
        return int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
    except OSError:
        return 1 << 40
