"""The lines of the source files that were loaded: messages quote them, and printers keep the comments beside code."""

from __future__ import annotations

import re
from collections.abc import Mapping

from sssgen.ir.spans import Span

_lines: dict[str, list[str]] = {}
_LINES_BEHIND = 8
"""How far below a span the end of its brackets may be."""


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


def whole(span: Span) -> Span:
    """A span of a loaded file with the brackets that it begins or ends inside of, and the arguments of a macro."""
    lines = _lines.get(span.file, [])[max(span.line - 1, 0) : span.end_line + _LINES_BEHIND] if span.line else []
    if not lines:
        return span
    text = "\n".join(lines)
    start = span.column - 1
    end = sum(len(line) + 1 for line in lines[: span.end_line - span.line]) + span.end_column - 1
    if re.fullmatch(r"[A-Za-z_]\w*", text[start:end]) and (call := re.compile(r"[ \t]*\(").match(text, end)):
        end = call.end()
    opened = closed = 0
    for char in text[start:end]:
        if char in "([":
            opened += 1
        elif char in ")]" and opened:
            opened -= 1
        elif char in ")]":
            closed += 1
    before, behind = _past(text[:start][::-1], "([", ")]", closed), _past(text[end:], ")]", "([", opened)
    if before is None or behind is None:
        return span
    start, end = start - before, end + behind
    first, last = text[:start].rpartition("\n"), text[:end].rpartition("\n")
    return Span(
        span.file, span.line + text[:start].count("\n"), len(first[2]) + 1,
        span.line + text[:end].count("\n"), len(last[2]) + 1,
    )  # fmt: skip


def _past(text: str, wanted: str, other: str, count: int) -> int | None:
    """The length of a text up to and with the bracket that closes `count` of them; None if it has too few."""
    depth = count
    for index, char in enumerate(text):
        if not depth:
            return index
        depth += (char in other) - (char in wanted)
    return None if depth else len(text)


def excerpt(span: Span, longest: int) -> str:
    """The text of a span in one line, with whole brackets; what is too long is cut at a blank."""
    text = " ".join(re.sub(r"(?m)^[ \t]*#.*$", "", source_text(whole(span))).split())
    if len(text) <= longest:
        return text
    return f"{text[:longest].rpartition(' ')[0] or text[:longest]} …"


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
