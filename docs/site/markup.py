"""Pieces of Markdown for generated pages."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence


def escaped(text: str) -> str:
    """Plain text, also for the cell of a table: nothing of it is markup but `code`."""
    pieces = re.split(r"(`[^`]*`)", " ".join(text.split()))
    return "".join(
        piece.replace("|", "\\|") if piece.startswith("`") else re.sub(r"([\\*_<>\[\]|$])", r"\\\1", piece)
        for piece in pieces
    )


def fenced(text: str, language: str) -> list[str]:
    return [f"```{language}", text, "```"]


def folded(text: str, width: int = 90) -> str:
    """Text for a fence, with lines that fit on a page."""
    lines = text.splitlines()
    return "\n".join(
        piece
        for line in lines
        for piece in (textwrap.wrap(line, width, break_on_hyphens=False, break_long_words=False) if line else [""])
    )


def in_search(*words: str) -> list[str]:
    """Words that the search of the site leads to this place of a page first."""
    return [line for word in dict.fromkeys(map(str.lower, words)) for line in (f"```{{index}} ! {word}", "```", "")]


def number(value: object) -> str:
    return f"{value:g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value).lower()


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [f"| {' | '.join(heads)} |", f"|{'---|' * len(heads)}", *(f"| {' | '.join(row)} |" for row in rows)]
