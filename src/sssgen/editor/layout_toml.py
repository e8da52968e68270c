"""The layout of TOML: one space around `=` and after `,`, lists indented by their depth, single blank lines.

Lines stay as the author broke them, and comments keep their distance. The values are compared with those before.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Sequence

from sssgen.editor.layout_code import INDENT, join_lines
from sssgen.support.diagnostics import failure
from sssgen.support.toml_source import Token, all_tokens, parse

_Line = Sequence[tuple[Token, str]]
"""The tokens of one line, each with the blanks before it; a text of several lines is one token."""


def toml_layout(text: str, shown: str) -> str:
    """The text in this layout. Raises SssgenError with its syntax errors."""
    before = parse(text, shown).data
    result = join_lines(_separate_sections(_lay_out(list(_lines(text)))))
    if repr(tomllib.loads(result)) != repr(before):
        raise failure("the layout would change a value", "report this file as a bug of sssgen fmt", shown)
    return result


def _lines(text: str) -> Iterator[_Line]:
    line: list[tuple[Token, str]] = []
    blanks = ""
    for token in all_tokens(text):
        if token.kind == "newline":
            yield line
            line, blanks = [], ""
        elif token.text.strip(" \t\r"):
            line.append((token, blanks))
            blanks = ""
        else:
            blanks = token.text
    yield line


def _lay_out(lines: Sequence[_Line]) -> Iterator[str]:
    """The lines with their indentation and blanks."""
    brackets: list[str] = []
    for line in lines:
        is_header = not brackets and bool(line) and line[0][0].text == "["
        closing = 0
        while closing < len(line) and line[closing][0].text in ("]", "}"):
            closing += 1
        depth = max(0, len(brackets) - closing)
        yield INDENT * depth + _space_tokens(line, is_header, brackets)
        if is_header:
            brackets.clear()


def _space_tokens(line: _Line, is_header: bool, brackets: list[str]) -> str:
    """A line's tokens with the blanks between them; `brackets` are those that are open, and are updated."""
    text = ""
    before: Token | None = None
    for token, blanks in line:
        if before is not None:
            text += _blanks_between(before, token, blanks, is_header, brackets)
        text += token.text.rstrip() if token.text.startswith("#") else token.text
        if token.kind == "mark" and token.text in "[{":
            brackets.append(token.text)
        elif token.kind == "mark" and token.text in "]}" and brackets:
            brackets.pop()
        before = token
    return text


def _blanks_between(before: Token, token: Token, blanks: str, is_header: bool, brackets: Sequence[str]) -> str:
    """The blanks between two tokens of a line."""
    if token.text.startswith("#"):
        return blanks.replace("\t", INDENT).replace("\r", "") or " "
    first = before.text if before.kind == "mark" else ""
    second = token.text if token.kind == "mark" else ""
    if is_header or first == "." or second in (".", ","):
        return ""
    if first == "{":
        return "" if second == "}" else " "
    if second == "}":
        return " "
    if first == "[" or second == "]":
        return ""
    if first in ("=", ",") or second == "=":
        return " "
    return " " if blanks else ""


def _separate_sections(lines: Iterator[str]) -> Iterator[str]:
    """The lines with a blank line before each section; one below a comment belongs to it."""
    before = ""
    for line in lines:
        if line.startswith("[") and before.strip() and not before.startswith("#"):
            yield ""
        yield line
        before = line
