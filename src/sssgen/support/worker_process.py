"""A Python process that answers questions: if a driver crashes or hangs there, only one answer is lost.

    process = Process("sssgen.run.compilers.compiler_process", "tint", seconds=60.0)
    version = process.start()
    messages = process.ask(source)

The module must have a function `serve(name)` that returns the first answer and a function from questions to answers.
Both are pickled over the process's standard input and output; the output of drivers is discarded.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

ENDING = 10.0
"""How many seconds are waited for a killed process: one inside a driver that hangs may never end."""


class LostError(Exception):
    """The process has ended; the message states how: `crashed (SIGSEGV)`, `did not answer within 60 seconds`."""


class Process:
    """Starts at the first question, and again after it was lost. Exceptions of the process are raised here."""

    def __init__(
        self, module: str, name: str, environment: Mapping[str, str] | None = None, seconds: float = 60.0
    ) -> None:
        self.command = [sys.executable, "-m", __name__, module, name]
        self.environment = dict(environment or {})
        self.seconds = seconds
        self.process: subprocess.Popen[bytes] | None = None

    def start(self) -> Any:
        """Restarts the process and returns its first answer. Raises LostError, and the exceptions of `serve`."""
        self.close()
        self.process = subprocess.Popen(
            self.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), **self.environment},
            start_new_session=True,  # its own group: killed with its children, not interrupted by Ctrl-C
        )
        atexit.register(self.close)
        return self._answer()

    def ask(self, question: Any) -> Any:
        """The answer to a question. Raises LostError, and the exceptions of the process."""
        if self.process is None:
            self.start()
        assert self.process is not None and self.process.stdin is not None
        with contextlib.suppress(OSError):  # it has ended, which the answer reports
            _send(self.process.stdin, question)
        return self._answer()

    def close(self) -> None:
        """Ends the process and its children."""
        process, self.process = self.process, None
        if process is None:
            return
        atexit.unregister(self.close)
        _kill(process)
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                assert pipe is not None
                pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(ENDING)

    def _answer(self) -> Any:
        process = self.process
        assert process is not None and process.stdout is not None
        late = threading.Event()

        def end() -> None:
            late.set()
            _kill(process)

        timer = threading.Timer(self.seconds, end)
        timer.start()
        try:
            good, answer = pickle.load(process.stdout)
        except (EOFError, pickle.UnpicklingError, OSError):
            status = process.wait()
            self.close()
            ending = (
                f"did not finish within {self.seconds:g} seconds" if late.is_set() else f"crashed ({_ending(status)})"
            )
            raise LostError(ending) from None
        finally:
            timer.cancel()
        if not good:
            raise answer
        return answer


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Kills the group of a process and those of its descendants, which may have processes of this kind."""
    if hasattr(os, "killpg"):
        for pid in _descendants(process.pid):
            with contextlib.suppress(OSError):
                os.killpg(pid, signal.SIGKILL)  # fails for those that are in the group of another
    process.kill()


def _descendants(pid: int) -> list[int]:
    """A process and what it has started, as far as the system tells (Linux)."""
    children: list[int] = []
    for path in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            children += map(int, path.read_text("ascii").split())
    return [pid, *(descendant for child in children for descendant in _descendants(child))]


def _ending(status: int) -> str:
    if status < 0:
        with contextlib.suppress(ValueError):
            return signal.Signals(-status).name
    return f"exit status {status}"


def _send(pipe: IO[bytes], value: object) -> None:
    pickle.dump(value, pipe, protocol=pickle.HIGHEST_PROTOCOL)
    pipe.flush()


def _main(module: str, name: str) -> None:
    answers = os.fdopen(os.dup(1), "wb")
    questions = os.fdopen(os.dup(0), "rb")
    quiet = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(quiet, stream)
    try:
        first, answer = importlib.import_module(module).serve(name)
    except Exception as error:
        _send(answers, (False, error))
        return
    _send(answers, (True, first))
    while True:
        try:
            question = pickle.load(questions)
        except EOFError:
            return
        try:
            result = True, answer(question)
        except Exception as error:
            result = False, error
        _send(answers, result)


if __name__ == "__main__":
    _main(*sys.argv[1:])
