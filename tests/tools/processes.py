"""Waiting for other processes, without a bound on the clock that a busy machine could exceed."""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Callable
from typing import Any

HANG = 300.0
"""Seconds of the clock after which a process hangs."""


def wait_until(true: Callable[[], Any], what: str) -> None:
    """Returns as soon as `true` does; fails when it does not for HANG seconds."""
    end = time.monotonic() + HANG
    while not true():
        assert time.monotonic() < end, f"waited for {what}"
        time.sleep(0.01)


def wait_until_busy(process: subprocess.Popen[Any], seconds: float) -> None:
    """Returns once a process and its children have used that much processor time; fails where it ends before."""
    import psutil

    observed = psutil.Process(process.pid)

    def used() -> float:
        assert process.poll() is None, "it ended before it was interrupted"
        times = [one.cpu_times() for one in (observed, *observed.children(recursive=True))]
        return sum(time.user + time.system for time in times)

    wait_until(lambda: used() >= seconds, f"{seconds} seconds of work")


def heed_interrupts() -> None:
    """For `preexec_fn`: a process that a shell started in the background ignores interrupts, and so do its children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
