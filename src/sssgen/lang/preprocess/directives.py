"""Finds the directives of a text: one regular expression that handles comments, strings and line continuations."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sssgen.ir.spans import Span
from sssgen.lang.syntax.lexer import BLOCK_COMMENT, LINE_COMMENT, NEWLINE, OPEN_COMMENT, TEXT

BLANK = rf"(?>(?:[^\S\n]|{NEWLINE}|{BLOCK_COMMENT})*)"
_DIRECTIVE = re.compile(
    rf"""
    ^{BLANK}(?P<mark>\#){BLANK}(?P<name>\w*+)
        (?P<rest>(?>(?:[^\n\\/"]++|{NEWLINE}|{LINE_COMMENT}|{BLOCK_COMMENT}|{TEXT}|\\|/(?!\*))*))
    | {LINE_COMMENT} | {BLOCK_COMMENT} | {OPEN_COMMENT} | {TEXT}
    """,
    re.VERBOSE | re.MULTILINE,
)
_IGNORED = re.compile(rf"{NEWLINE}|{LINE_COMMENT}|{BLOCK_COMMENT}")


_TOKEN_PARTS = re.compile(
    rf"(?<=[\w.])(?:(?:{NEWLINE})+(?:[\w.]+\(?|\())+|(?<=[-+*/%&|^<>=!\#])(?:(?:{NEWLINE})+[-+*/&|^<>=\#]+)+"
)


def with_whole_tokens(text: str) -> str:
    """The text with the line continuations inside tokens after these tokens, so that lines keep their numbers.

    So it is for one between a macro's name and its `(`.
    """
    if "\\\n" not in text and "\\\r\n" not in text:
        return text

    def joined(match: re.Match[str]) -> str:
        return re.sub(NEWLINE, "", match[0]) + "".join(re.findall(NEWLINE, match[0]))

    return _TOKEN_PARTS.sub(joined, text)


def directives(text: str) -> Iterator[re.Match[str]]:
    """The directives, each with its `mark` (#), its `name`, which may be empty, and the `rest` of its line."""
    if "#" in text:
        for match in _DIRECTIVE.finditer(text):
            if match["mark"] is not None:
                yield match


def plain(rest: str) -> str:
    """The arguments of a directive without comments, on one line, separated by single blanks."""
    return " ".join(_IGNORED.sub(" ", rest).split())


class Branch:
    """An #if that is open."""

    def __init__(self, place: Span, outside: bool) -> None:
        self.place = place
        self.outside = outside  # whether the code around it is active
        self.live = False
        self.taken = False  # whether one of its branches was active
        self.last = False  # whether this branch is the #else


class SourceFile:
    """A file that is being read: the position, and the open #if."""

    def __init__(self, text: str, label: str) -> None:
        self.text = text
        self.label = label
        self.position = 0
        self.line = 1
        self.branches: list[Branch] = []

    def place(self, start: int, end: int) -> Span:
        """The span of a part; parts must be requested in the order of their starts."""
        self.line += self.text.count("\n", self.position, start)
        self.position = start
        column = start - self.text.rfind("\n", 0, start)
        lines = self.text.count("\n", start, end)
        end_column = end - self.text.rfind("\n", start, end) if lines else column + end - start
        return Span(self.label, self.line, column, self.line + lines, end_column)

    @property
    def live(self) -> bool:
        """Whether the code that follows is active."""
        return not self.branches or self.branches[-1].live
