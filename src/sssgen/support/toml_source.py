"""TOML with positions: tomllib's values, and the position of each key and value in the text.

tomllib reads the values and reports syntax errors; a small scanner over the same text finds the places.
"""

from __future__ import annotations

import functools
import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from sssgen.ir.nodes import Span
from sssgen.support.diagnostics import Reporter

MAX_CHARACTERS = 1 << 18
"""The longest file that is read. A material of a hundred stages stays below 20,000."""

MAX_DEPTH = 32
"""How deeply brackets, and the parts of a dotted key, may nest."""

MAX_WORD = 1000
"""The longest key or number."""

MAX_SYNTAX_ERRORS = 20

Path = tuple[str | int, ...]
"""The way to a value: keys, and the indices of arrays."""


class Place(NamedTuple):
    """The place of a key and its value. A section's value is its header; an array's element is its own key."""

    key: Span
    value: Span


class Document:
    """A TOML text: `data` is the result of tomllib; `reporter` collects the errors."""

    def __init__(self, data: dict[str, Any], places: dict[Path, Place], reporter: Reporter) -> None:
        self.data = data
        self.reporter = reporter
        self._places = places

    def place(self, *path: str | int) -> Place:
        """The place of a value, or that of the nearest one around it."""
        while path and path not in self._places:
            path = path[:-1]
        start = Span(self.reporter.file, 1, 1, 1, 1)
        return self._places.get(path, Place(start, start))

    def find(self, keys: Sequence[str]) -> Place | None:
        """The place of a value, the first where an array of tables has several; None where there is none."""
        names = tuple(keys)
        for path, place in self._places.items():
            if tuple([part for part in path if isinstance(part, str)]) == names:
                return place
        return None

    def error(self, span: Span, message: str, hint: str = "") -> None:
        """Records an error. Raises SssgenError after too many."""
        self.reporter.error(span, message, hint)


def parse(text: str, file: str) -> Document:
    """Reads a TOML text. Raises SssgenError with every syntax error found."""
    data, places = _parse(text, file)
    return Document(data, places, Reporter(file, text))


def _parse(text: str, file: str) -> tuple[dict[str, Any], dict[Path, Place]]:
    """The values of a TOML text and their places."""
    import tomllib

    reporter = Reporter(file, text)
    place_of = _Positions(file, text)
    if len(text) > MAX_CHARACTERS:
        message = f"the file is too large: {len(text)} characters; at most {MAX_CHARACTERS} are read"
        reporter.error(place_of(0, 1), message, "one file describes one material")
        reporter.check()
    tokens = list(_tokens(text))
    for token, message in _too_much(tokens):
        reporter.error(place_of(token.start, token.end), message)
        reporter.check()
    remaining, line = text, 0
    while len(reporter.diagnostics) < MAX_SYNTAX_ERRORS:
        try:
            data = tomllib.loads(remaining)
            break
        except ValueError as error:
            before, line = line, _report(str(error), remaining, reporter)
        if line <= before:  # the end of the text
            break
        lines = remaining.split("\n")
        # lines below a faulty header do not belong to the section above
        lines[line - 1] = f'["line {line}"]' if lines[line - 1].lstrip().startswith("[") else ""
        remaining = "\n".join(lines)
    reporter.check()
    return data, _Scanner(tokens, place_of).scan()


_POSITION = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")

# tomllib's message → (our message, hint).
_SEVERAL = "a role with several stages has [[double brackets]], once for each"
_WORDING = (
    ("Cannot overwrite", "this key is given twice", ""),
    ("Duplicate inline table key", "this key is given twice", ""),
    ("Cannot declare", "this section is given twice", _SEVERAL),
    ("Cannot mutate", "this section is given twice", _SEVERAL),
    ("Invalid value", "this is not a value", 'write a text in quotes, as in "ice", and a number as 0.5'),
    ("Unclosed array", "this list has no end", "close it with ]"),
    ("Unclosed inline table", "this table has no end", "close it with }"),
    ("Unterminated string", "this text has no end", "close it with a quote"),
    ("Expected \"'''\"", "this text has no end", "close it with '''"),
    ("Expected '='", "'=' is missing after the key", "write: key = value"),
    ("Invalid initial character for a key", "a key is missing here", "write: key = value"),
    ("Illegal character '\\n'", "this text has no end", "close it with a quote"),
    ("Unescaped '\\'", "this backslash means nothing", "write it twice, or put the text in 'single quotes'"),
)  # fmt: skip


def _report(message: str, text: str, reporter: Reporter) -> int:
    """Records one of tomllib's errors; returns its line, or 0 for the end of the text."""
    match = _POSITION.search(message)
    original = message[: match.start()] if match else message
    ours, hint = next(
        (row[1:] for row in _WORDING if original.startswith(row[0])), (original[:1].lower() + original[1:], "")
    )
    lines = text.split("\n")
    if match and match[1]:
        line, column = int(match[1]), int(match[2])
        content = lines[line - 1].strip()
        if ours.endswith("given twice"):  # tomllib stops behind it
            column = lines[line - 1].find(content) + 1
        end = column + max(1, len(content)) if ours.endswith("given twice") else column + 1
        reporter.error(Span(reporter.file, line, column, line, end), ours, hint)
        return line
    # the end of the text: report the last line that is not blank
    last = max((number for number, content in enumerate(lines, 1) if content.strip()), default=1)
    column = len(lines[last - 1].rstrip()) + 1
    reporter.error(Span(reporter.file, last, column, last, column + 1), ours, hint)
    return 0


class Token(NamedTuple):
    """A piece of a text: newline, skip (blanks or a comment), string, mark, bare (part of a key or value) or other."""

    kind: str
    text: str
    start: int
    end: int


_TOKEN = re.compile(
    r"""(?P<newline>\n) | (?P<skip>[ \t\r]+|\#[^\n]*)
    | (?P<string>\"\"\"(?:\\.|[^\\])*?\"{3,5} | '''.*?'{3,5} | "(?:\\.|[^"\\\n])*" | '[^'\n]*')
    | (?P<mark>[][{}=,.]) | (?P<bare>[^][{}=,.\s\#"']+) | (?P<other>.)""",
    re.VERBOSE | re.DOTALL,
)


def all_tokens(text: str) -> Iterator[Token]:
    """The tokens of a text, which together are the text: blanks and comments, too."""
    for match in _TOKEN.finditer(text):
        yield Token(str(match.lastgroup), match.group(), match.start(), match.end())


def _tokens(text: str) -> Iterator[Token]:
    return (token for token in all_tokens(text) if token.kind != "skip")


def _too_much(tokens: list[Token]) -> Iterator[tuple[Token, str]]:
    """The places where brackets or dotted keys nest too deeply, or a word is too long."""
    depth = dots = 0
    for token in tokens:
        if token.kind == "newline" or token.text in ("=", ","):
            dots = 0
        elif token.kind == "mark":
            depth += (token.text in "[{") - (token.text in "]}")
            dots += token.text == "."
            if depth > MAX_DEPTH or dots > MAX_DEPTH:
                yield token, f"nested more than {MAX_DEPTH} levels deep"
        elif token.kind == "bare" and len(token.text) > MAX_WORD:
            yield token, f"this word has {len(token.text)} characters; at most {MAX_WORD} are read"


class _Positions:
    """Turns offsets into spans."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def __call__(self, start: int, end: int) -> Span:
        line, end_line = bisect_right(self.starts, start), bisect_right(self.starts, end)
        return Span(self.file, line, start - self.starts[line - 1] + 1, end_line, end - self.starts[end_line - 1] + 1)


class _Scanner:
    """Finds the places in a text that tomllib has accepted, so it need not look for errors."""

    def __init__(self, tokens: list[Token], place_of: _Positions) -> None:
        self.tokens = tokens
        self.place_of = place_of
        self.at = 0
        self.places: dict[Path, Place] = {}
        self.counts: dict[Path, int] = {}

    def scan(self) -> dict[Path, Place]:
        table: Path = ()
        while self.at < len(self.tokens):
            if self.tokens[self.at].kind == "newline":
                self.at += 1
            elif self.tokens[self.at].text == "[":
                table = self.header()
            else:
                self.pair(table)
        return self.places

    def header(self) -> Path:
        """`[a.b]` or `[[a.b]]`: the table that the lines below belong to."""
        first = self.tokens[self.at]
        double = self.tokens[self.at + 1].text == "["
        self.at += 2 if double else 1
        keys, span = self.keys()
        self.at += 2 if double else 1
        path: Path = ()
        for key in keys[:-1]:
            path = self.into((*path, key))
        path = (*path, keys[-1])
        if double:
            self.counts[path] = self.counts.get(path, 0) + 1
            self.places.setdefault(path, Place(span, span))
        path = self.into(path)
        header = self.place_of(first.start, self.tokens[self.at - 1].end)
        self.places[path] = Place(span, header)
        return path

    def into(self, path: Path) -> Path:
        """The table itself, or the newest of an array of tables."""
        return (*path, self.counts[path] - 1) if path in self.counts else path

    def keys(self) -> tuple[list[str], Span]:
        """A dotted key and its span."""
        first = self.tokens[self.at]
        keys = [_unquote(first)]
        while self.tokens[self.at + 1].text == ".":
            self.at += 2
            keys.append(_unquote(self.tokens[self.at]))
        self.at += 1
        return keys, self.place_of(first.start, self.tokens[self.at - 1].end)

    def pair(self, table: Path) -> None:
        """`key = value`."""
        keys, span = self.keys()
        self.at += 1
        path = (*table, *keys)
        value = self.value(path)
        for length in range(len(table) + 1, len(path)):
            self.places.setdefault(path[:length], Place(span, value))
        self.places[path] = Place(span, value)

    def value(self, path: Path) -> Span:
        """A value; what is inside it is noted too."""
        first = self.tokens[self.at]
        if first.text == "{":
            self.at += 1
            while not self.closes("}"):
                self.pair(path)
        elif first.text == "[":
            self.at += 1
            index = 0
            while not self.closes("]"):
                element = self.value((*path, index))
                self.places[(*path, index)] = Place(element, element)
                index += 1
        else:
            while self.at < len(self.tokens) and not _ends_value(self.tokens[self.at]):
                self.at += 1
        return self.place_of(first.start, self.tokens[self.at - 1].end)

    def closes(self, bracket: str) -> bool:
        """Skips newlines and commas; whether the bracket follows, which is skipped, too."""
        while self.tokens[self.at].kind == "newline" or self.tokens[self.at].text == ",":
            self.at += 1
        if self.tokens[self.at].text == bracket:
            self.at += 1
            return True
        return False


def _ends_value(token: Token) -> bool:
    return token.kind == "newline" or (token.kind == "mark" and token.text in ",]}")


@functools.cache
def _unescape(quoted: str) -> str:
    import tomllib

    return str(tomllib.loads(f"key = {quoted}")["key"])


def _unquote(token: Token) -> str:
    if token.kind != "string":
        return token.text
    return _unescape(token.text) if "\\" in token.text else token.text[1:-1]
