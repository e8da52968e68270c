"""A progress line on a terminal; nothing elsewhere."""

from __future__ import annotations

import sys
from time import monotonic

WIDTH = 20
SECONDS = 0.1
"""The line is written anew this often at most."""


class Progress:
    """`with Progress(46) as told: told("beer_lambert", "random", 0.3)`: the line goes when it ends."""

    def __init__(self, count: int) -> None:
        self.count, self.done, self.last, self.title = count, 0, 0.0, ""
        self.shown = sys.stderr is not None and sys.stderr.isatty()

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    def __call__(self, title: str, what: str, share: float) -> None:
        """`share`: how much is done of the technique of that title."""
        if title != self.title:
            self.done, self.title = self.done + bool(self.title), title
        if not self.shown or monotonic() - self.last < SECONDS:
            return
        self.last = monotonic()
        whole = (self.done + share) / max(self.count, 1)
        bar = "#" * round(WIDTH * whole)
        print(
            f"\r\033[K[{bar:.<{WIDTH}}] {self.done}/{self.count} {title}: {what}", end="", file=sys.stderr, flush=True
        )
