"""Processes that answer questions: what a killed one has started ends with it."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from sssgen.support.worker_process import LostError, Process


def serve(name: str) -> tuple[int, Callable[[str], int]]:
    """Answers with the id of a process of the same kind that it starts; 'wait' takes longer than any limit."""
    inner = Process(__name__, "")

    def answer(question: str) -> int:
        if question == "wait":
            time.sleep(600.0)
        return int(inner.start())

    return os.getpid(), answer


@pytest.mark.skipif(not Path(f"/proc/self/task/{os.getpid()}/children").exists(), reason="the system names no children")
def test_a_process_that_hangs_ends_with_what_it_started(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(Path(__file__).parent), *sys.path])
    process = Process(__name__.rpartition(".")[2], "", seconds=20.0)
    started = process.ask("start")
    os.kill(started, 0)
    process.seconds = 0.5
    with pytest.raises(LostError, match=r"did not finish within 0\.5 seconds"):
        process.ask("wait")
    for _ in range(100):
        if not is_running(started):
            return
        time.sleep(0.05)
    pytest.fail("it still runs")


def is_running(pid: int) -> bool:
    """Whether a process has not ended; one that nobody has waited for has ended."""
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()[0] != "Z"
    return False
