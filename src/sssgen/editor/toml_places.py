"""Where a place in a material or scene is: its section, its key, and whether it is in a value.

The text is read line by line, as it is half written while it is being completed: tomlkit and `support.toml_source` find
places in texts without errors only.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from sssgen.editor.documents import Document

_HEADER = re.compile(r"^[ \t]*(\[{1,2})[ \t]*([\w.\-]*)")
_KEY = re.compile(r"^[ \t]*([\w\-]+)[ \t]*=")
_TEXT = re.compile(r"""["']([^"']*)["']?""")
_INLINE = re.compile(r"([\w\-]+)[ \t]*=[ \t]*")


class Table(NamedTuple):
    """A table of a document, from its header to the next one."""

    first_line: int
    """The line of the header; -1 for the keys before the first header."""
    last_line: int
    section: str
    """The name in the header; '' before the first."""
    technique: str
    """The technique that the table names."""


class TomlPlace(NamedTuple):
    """A place in a document."""

    table: Table
    keys: tuple[str, ...]
    """The keys of this table, without that of the place's own line."""
    key: str
    """The key of the line, or '' where none is written yet."""
    inner_key: str
    """The key in an inline table, as in `bind = { KEY = "…" }`."""
    in_value: bool
    """Whether the place is behind the `=`."""
    in_header: bool
    in_text: bool
    """Whether the place is between quotes."""
    in_table: bool
    """Whether the place is in an inline table, where a key can stand."""

    @property
    def section(self) -> str:
        return self.table.section


def place_at(document: Document, line: int, column: int) -> TomlPlace:
    """The place of a line and column."""
    lines = document.lines
    table = next(table for table in reversed(tables_of(document)) if table.first_line <= line)
    header = table.first_line
    own = document.line(line)
    others = [lines[number] for number in range(header + 1, table.last_line + 1) if number != line]
    keys = [match.group(1) for text in others if (match := _KEY.match(text))]
    key_match = _KEY.match(own)
    start = _start_of_value(lines, line, header) if key_match is None else line
    if key_match is None and start != line:
        key_match = _KEY.match(lines[start])
    before = own[:column]
    in_value = key_match is not None and (start != line or column >= key_match.end())
    value = before if start != line else before[key_match.end() :] if key_match is not None and in_value else ""
    in_table = value.count("{") > value.count("}")
    inner = _INLINE.findall(value[value.rfind("{") + 1 :]) if in_table else []
    after_key = value[value.rfind(",") + 1 :] if "," in value and value.rfind(",") > value.rfind("{") else value
    return TomlPlace(
        table,
        tuple(keys),
        key_match.group(1) if key_match else "",
        inner[-1] if inner and "=" in after_key[after_key.rfind("{") + 1 :] else "",
        in_value,
        header == line,
        in_value and (value.count('"') % 2 == 1 or (value.count('"') == 0 and value.count("'") % 2 == 1)),
        in_table,
    )


def _start_of_value(lines: list[str], line: int, header: int) -> int:
    """The line on which the list that a line is in begins; the line itself if it is in none."""
    depth = 0
    for number in range(line - 1, header, -1):
        text = lines[number].split("#")[0]
        depth += text.count("[") + text.count("{") - text.count("]") - text.count("}")
        if _KEY.match(lines[number]):
            return number if depth > 0 else line
    return line


def _technique_of(lines: list[str]) -> str:
    """The technique that the lines of a table name."""
    for text in lines:
        match = _KEY.match(text)
        if match and match.group(1) == "technique":
            found = _TEXT.search(text, match.end())
            return found.group(1) if found else ""
    return ""


def text_at(document: Document, line: int, column: int) -> tuple[str, int, int]:
    """The quoted text around a place, and its first and last column; '' where there is none."""
    for match in _TEXT.finditer(document.line(line)):
        if match.start() <= column <= match.end():
            return match.group(1), match.start(1), match.end(1)
    return "", column, column


def bound_texts(text: str, slot: str) -> list[str]:
    """The texts of the keys with a slot's name."""
    return re.findall(rf"""\b{re.escape(slot)}[ \t]*=[ \t]*["']([^"'\n]*)["']""", text)


def tables_of(document: Document) -> list[Table]:
    """The tables of a document; the first is what stands before the first header."""
    lines = document.lines
    starts = [-1, *(number for number, text in enumerate(lines) if _HEADER.match(text))]
    tables = []
    for start, following in zip(starts, [*starts[1:], len(lines)], strict=True):
        match = _HEADER.match(lines[start]) if start >= 0 else None
        section = match.group(2) if match else ""
        tables.append(Table(start, following - 1, section, _technique_of(lines[start + 1 : following])))
    return tables
