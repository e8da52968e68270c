"""A progress bar on a terminal; nothing elsewhere."""

from __future__ import annotations

import contextlib
import sys
from types import TracebackType

WIDTH = 20
"""Of the bar that is drawn without the package rich, in columns."""


class Bar:
    """`with Bar() as told: run(items, progress=told)`: on the standard error stream, and gone when it ends."""

    def __init__(self) -> None:
        self.shown = sys.stderr is not None and sys.stderr.isatty()
        self.rich = None
        if self.shown:
            with contextlib.suppress(ImportError):
                from rich.console import Console
                from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

                columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), TextColumn("{task.description}"))
                self.rich = Progress(*columns, console=Console(stderr=True), transient=True)
                self.task = self.rich.add_task("", total=None)

    def __enter__(self) -> Bar:
        if self.rich is not None:
            self.rich.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self.rich is not None:
            self.rich.stop()
        elif self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    def __call__(self, done: int, total: int, name: str) -> None:
        """So many are done of so many, the last of them called `name`."""
        if self.rich is not None:
            from rich.markup import escape

            self.rich.update(self.task, completed=done, total=total, description=escape(name))
        elif self.shown:
            bar = "#" * round(WIDTH * done / max(total, 1))
            print(f"\r\033[K[{bar:.<{WIDTH}}] {done}/{total} {name}", end="", file=sys.stderr, flush=True)
