"""Text in columns that fit the terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterable

WIDEST = 100
"""Text is not wider than this, however wide the terminal is: long lines are hard to read."""


def help_width() -> int:
    """The width of help texts: that of the terminal, or of COLUMNS; 80 columns where there is neither."""
    import shutil

    return max(min(shutil.get_terminal_size().columns, WIDEST) - 2, 20)


def table_width() -> int | None:
    """The width of tables: that of the terminal. None in a pipe, where each row stays one line for other programs."""
    if sys.stdout is None or not sys.stdout.isatty():
        return None
    import shutil

    return max(shutil.get_terminal_size().columns - 1, 20)


def text_width() -> int:
    """The width of printed texts: that of the terminal; `WIDEST` in a pipe."""
    return min(table_width() or WIDEST, WIDEST)


def wrap(text: str, width: int, first: str = "", rest: str = "") -> list[str]:
    """The lines of a text; they begin with `first` and `rest`. Names with hyphens are not broken."""
    import textwrap

    return textwrap.wrap(
        text, width, initial_indent=first, subsequent_indent=rest, break_on_hyphens=False, break_long_words=False
    )


def table_rows(rows: Iterable[tuple[str, str]], first: int, width: int | None, indent: int = 2) -> list[str]:
    """Rows of a name and a text. The names have `first` columns; the texts are wrapped at `width`, if there is one.

    Where not even the first word fits behind the name, the text is below it.
    """
    lines = []
    for name, text in rows:
        start = f"{' ' * indent}{name:{first}}  "
        if width is None or len(start) + len(text) <= width:
            lines.append(f"{start}{text}".rstrip())
        elif len(start) + len(text.split(" ", 1)[0]) > width:
            below = " " * (2 * indent + 4)
            lines += [start.rstrip(), *wrap(text, width, below, below)]
        else:
            rest = len(start) if width > 2 * len(start) else 2 * indent
            lines += wrap(text, width, start, " " * rest)
    return lines


def print_rows(rows: Iterable[tuple[str, str]], first: int, indent: int = 2) -> None:
    """Prints rows of a name and a text, wrapped on a terminal."""
    print("\n".join(table_rows(rows, first, table_width(), indent)))
