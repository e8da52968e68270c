"""Progress: a bar on a terminal, by rich (https://github.com/Textualize/rich); elsewhere a line now and then."""

from __future__ import annotations

import contextlib
import sys
import time
from types import TracebackType

QUIET = 10.0
"""Seconds between the lines, and before the first: what is quick prints none."""


class ProgressBar:
    """`with ProgressBar() as progress: run(items, progress=progress)`: on the standard error stream.

    On a terminal with rich it is a bar that is erased at the end; in a pipe or a log, a line every 10 seconds.
    """

    def __init__(self) -> None:
        self.bar = None
        self.shown = time.monotonic()
        if sys.stderr is not None and sys.stderr.isatty():
            with contextlib.suppress(ImportError):
                from rich.console import Console
                from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

                columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), TextColumn("{task.description}"))
                self.bar = Progress(*columns, console=Console(stderr=True), transient=True)
                self.task = self.bar.add_task("", total=None)

    def __enter__(self) -> ProgressBar:
        if self.bar is not None:
            self.bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.bar is not None:
            self.bar.stop()

    def __call__(self, done: float, total: int, name: str) -> None:
        """Shows how many of `total` items are done, and the name of the current one."""
        if self.bar is not None:
            from rich.markup import escape

            self.bar.update(self.task, completed=done, total=total, description=escape(name))
        elif sys.stderr is not None and time.monotonic() - self.shown >= QUIET:
            self.shown = time.monotonic()
            print(f"{done:.4g} of {total}: {name}", file=sys.stderr, flush=True)
