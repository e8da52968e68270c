"""Waits for other processes, without a time limit that a busy machine could exceed."""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Callable
from typing import Any

HANG = 300.0
"""The number of seconds after which a process counts as hanging."""


def wait_until(condition: Callable[[], Any], description: str) -> None:
    """Waits until the condition is true; fails after HANG seconds."""
    end = time.monotonic() + HANG
    while not condition():
        assert time.monotonic() < end, f"waited for {description}"
        time.sleep(0.01)


def wait_until_busy(process: subprocess.Popen[Any], seconds: float) -> None:
    """Waits until a process and its children have used that much processor time; fails if it ends before."""
    import psutil

    observed = psutil.Process(process.pid)

    def used() -> float:
        assert process.poll() is None, "the process ended before it was interrupted"
        times = [member.cpu_times() for member in (observed, *observed.children(recursive=True))]
        return sum(time.user + time.system for time in times)

    wait_until(lambda: used() >= seconds, f"{seconds} seconds of work")


def enable_interrupts() -> None:
    """A `preexec_fn` that enables interrupts, which background processes of a shell and their children ignore."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
