"""What the lexer gives and the parser takes: words with their place in the file that they were written in."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.spans import Span


class Token(NamedTuple):
    """One word of a source text."""

    type: str
    """The terminal of grammar.lark that it is."""
    text: str
    span: Span
    """Where it is written: for what a macro gave, the macro's name at the place that uses it."""


class Comment(NamedTuple):
    """A comment: its lines, and its text with its marks."""

    first: int
    last: int
    text: str
