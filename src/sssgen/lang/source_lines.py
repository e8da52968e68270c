"""The lines of the source files that were loaded: messages quote them, and printers keep the comments beside code."""

from __future__ import annotations

import re
from collections.abc import Mapping

from sssgen.ir.spans import Span

_lines: dict[str, list[str]] = {}


def keep_lines(texts: Mapping[str, str]) -> None:
    """Stores the lines of texts by the names of their files."""
    _lines.update({name: text.split("\n") for name, text in texts.items()})


def source_line(span: Span) -> str:
    """The line on which a span of a loaded file begins, or ''."""
    lines = _lines.get(span.file, [])
    return lines[span.line - 1] if 0 < span.line <= len(lines) else ""


def source_text(span: Span) -> str:
    """The text of a span of a loaded file, or ''."""
    lines = _lines.get(span.file, [])[max(span.line - 1, 0) : span.end_line] if span.line else []
    if not lines:
        return ""
    lines = [*lines[:-1], lines[-1][: span.end_column - 1]]
    return "\n".join([lines[0][span.column - 1 :], *lines[1:]])


def line_before(span: Span, pattern: str) -> Span | None:
    """The last line before a span of a loaded file that matches a regular expression."""
    lines = _lines.get(span.file, [])
    for number in range(min(span.line - 1, len(lines)), 0, -1):
        text = lines[number - 1]
        if re.search(pattern, text):
            start = len(text) - len(text.lstrip(" \t/*")) + 1
            return Span(span.file, number, start, number, len(text) + 1)
    return None


def comments_before(file: str, line: int) -> list[str]:
    """The `//` comments alone on the lines directly before a line of a loaded file, without their marks."""
    lines = _lines.get(file, [])
    comments: list[str] = []
    while 1 < line <= len(lines):
        text = lines[line - 2].strip()
        if not text.startswith("//") or text.startswith("///"):
            break
        comments.insert(0, text[2:].strip())
        line -= 1
    return comments


_AFTER_CODE = re.compile(r"\S.*?[ \t]//+[ \t]?(.*\S)[ \t]*$")


def comment_behind(file: str, line: int) -> str:
    """The `//` comment after the code on a line of a loaded file, without its marks; '' for none."""
    lines = _lines.get(file, [])
    text = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    match = _AFTER_CODE.match(text) if "//" in text and not text.startswith(("//", "*", "/*")) else None
    return match.group(1) if match is not None else ""
