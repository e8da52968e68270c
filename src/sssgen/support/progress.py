"""Progress: a bar on a terminal, by rich (https://github.com/Textualize/rich); elsewhere a line now and then."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import Any

Progress = Callable[[float, int, str], None]
"""Called with how many of all items are done, the number of all, and the name of the current one."""

DELAY = 1.0
"""Seconds before the bar: what is quick shows none, and does not import rich."""
QUIET = 10.0
"""Seconds between the lines, and before the first."""
LONG = 5.0
"""Seconds of all the work from which an estimate is printed as soon as there is one."""
OBSERVED = 1.0
"""Seconds of work on which an estimate is based."""


def silent(done: float, total: int, name: str) -> None:
    """The progress that nobody wants to see."""


def time_left(seconds: float) -> str:
    """An estimate, as text."""
    return f"about {seconds / 60.0:.0f} min left" if seconds >= 90.0 else f"about {max(seconds, 1.0):.0f} s left"


class ProgressBar:
    """`with ProgressBar() as progress: run(items, progress=progress)`: on the standard error stream.

    On a terminal with rich it is a bar that is erased at the end, with the time left; in a pipe or a log, a line every
    10 seconds, also while one item takes longer. With `one_line` a pipe gets one line alone for each total: as soon as
    the time left can be estimated, where the whole work takes more than 5 seconds.
    """

    def __init__(self, one_line: bool = False) -> None:
        self.one_line, self.printed = one_line, False
        self.bar: Any = None
        self.state: tuple[float, int, str] | None = None
        self.first: tuple[float, float, int] | None = None
        """The time of the first call for a total, how much was done, and the total"""
        self.started = self.shown = time.monotonic()
        self.lock = threading.RLock()
        self.ended = threading.Event()
        self.terminal = sys.stderr is not None and sys.stderr.isatty()

    def __enter__(self) -> ProgressBar:
        if self.terminal and DELAY == 0.0:
            self._open()
        elif sys.stderr is not None:
            threading.Thread(target=self._watch, daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.ended.set()
        with self.lock:
            if self.bar is not None:
                self.bar.stop()

    def __call__(self, done: float, total: int, name: str) -> None:
        """Shows how many of `total` items are done, and the name of the current one."""
        with self.lock:
            self.state = done, total, name
            if self.first is None or self.first[2] != total or done < self.first[1]:
                now = time.monotonic()
                self.first, self.printed = (now, done, total), False
                self.shown = now if self.one_line else self.shown
            self._show()

    @contextlib.contextmanager
    def hide(self) -> Iterator[None]:
        """Erases the bar while the command prints a part of its result."""
        with self.lock:
            if self.bar is not None:
                self.bar.stop()
            try:
                yield
            finally:
                if self.bar is not None:
                    self.bar.start()

    def _watch(self) -> None:
        """Opens the bar when the work is not quick, or prints the lines."""
        while not self.ended.wait(DELAY or QUIET):
            with self.lock:
                if self.ended.is_set():
                    return
                if self.terminal and self.bar is None:
                    self._open()
                if self.bar is not None:
                    return  # which has a thread of its own
                self._show()

    def _open(self) -> None:
        try:
            from rich.console import Console
            from rich.progress import (
                BarColumn,
                MofNCompleteColumn,
                Progress,
                TextColumn,
                TimeElapsedColumn,
                TimeRemainingColumn,
            )
        except ImportError:
            self.terminal = False  # lines are all that it gets
            return
        columns = (
            BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn(),
            TextColumn("{task.description}"),
        )  # fmt: skip
        # the result goes to the standard output, and not through the bar
        console = Console(stderr=True)
        self.bar = Progress(*columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False)
        self.task = self.bar.add_task("", total=None)
        self.bar.tasks[0].start_time = self.bar.get_time() - (time.monotonic() - self.started)
        self._show()
        self.bar.start()

    def _show(self) -> None:
        if self.state is None:
            return
        done, total, name = self.state
        if self.bar is not None:
            from rich.markup import escape

            self.bar.update(self.task, completed=done, total=total, description=escape(name))
        elif not self.terminal and sys.stderr is not None and done < total:
            now, left = time.monotonic(), self._left()
            early = self.one_line and left is not None and now - self.started + left > LONG
            if (early or now - self.shown >= QUIET) and not (self.one_line and self.printed):
                self.shown, self.printed = now, True
                more = "" if left is None else f"; {time_left(left)}"
                print(f"{done:.4g} of {total}: {name}{more}", file=sys.stderr, flush=True)

    def _left(self) -> float | None:
        """The estimated seconds to the end of this total; None before enough is done."""
        if self.state is None or self.first is None:
            return None
        (done, total, _), (start, before, _) = self.state, self.first
        spent = time.monotonic() - start
        if done <= before or spent < OBSERVED:
            return None
        return (total - done) * spent / (done - before)
