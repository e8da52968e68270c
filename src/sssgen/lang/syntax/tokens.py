"""Tokens and comments: the lexer's output, with their places in the source file."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.spans import Span


class Token(NamedTuple):
    """One token of a source text."""

    type: str
    """Its terminal in grammar.lark."""
    text: str
    span: Span
    """Where it is written; for a token from a macro's body, the place of the macro's use."""


class Comment(NamedTuple):
    """A comment: its first and last line, and its text with the comment marks."""

    first: int
    last: int
    text: str
