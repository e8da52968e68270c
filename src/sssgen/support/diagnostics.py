"""Errors for users: a file, a line, a column, a caret, and a hint.

A run collects every error it can find and raises them together as one `SssgenError`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.ir.spans import NOWHERE, Span
from sssgen.support.paths import display_name

MAX_ERRORS = 100
"""The largest number of errors collected for one file."""

MAX_MESSAGE = 500
"""The largest length of a message: a name in it may be a megabyte long."""

MIN_PART = 3
"""The letters that a word needs before longer names are suggested for it."""
MAX_SUGGESTIONS = 5
"""The largest number of names in one suggestion."""
ONE_LETTER, SIMILAR = 0.85, 0.6
"""Similarities, from 0 to 1: of words of usual length that differ in a letter or two; the least for a suggestion."""


class Diagnostic(NamedTuple):
    """One error or warning. `source_line` is the text of the line that `span` begins on, if it is known."""

    severity: str
    message: str
    span: Span = NOWHERE
    hint: str = ""
    source_line: str = ""

    def render(self) -> str:
        """The diagnostic as it is shown in a terminal."""
        lines = [f"{self.severity}: {visible(self.message)}"]
        span = self.span
        if span.file:
            file = display_name(span.file)
            place = f"{file}:{span.line}:{span.column}" if span.line else file
            lines.append(f"  --> {visible(place)}")
        if self.source_line.strip():
            text, column, end = _window(self.source_line, span)
            gutter = str(span.line)
            lines.append(f" {gutter} | {text}")
            lines.append(f" {' ' * len(gutter)} | {' ' * (column - 1)}{'^' * max(1, end - column)}")
        if self.hint:
            lines.append(f"  help: {visible(self.hint)}")
        return "\n".join(lines)

    def as_json(self) -> dict[str, Any]:
        """The diagnostic for editors: 1-based positions, the end exclusive."""
        span = self.span
        return {
            "severity": self.severity,
            "message": self.message,
            "file": display_name(span.file),
            "line": span.line,
            "column": span.column,
            "end_line": span.end_line,
            "end_column": span.end_column,
            "help": self.hint,
        }


def visible(text: str) -> str:
    """Text that is safe for a terminal: each character that is not printable becomes a visible one."""
    if text.isprintable():
        return text
    return "".join([char if char.isprintable() else _picture(char) for char in text])


def _picture(char: str) -> str:
    code = ord(char)
    if char == "\t":
        return " "
    return chr(0x2400 + code) if code < 0x20 else "\u2421" if code == 0x7F else "\ufffd"


def _window(line: str, span: Span, width: int = 120) -> tuple[str, int, int]:
    """A readable part of a possibly very long line, with the caret's columns in it."""
    end = span.end_column if span.end_line == span.line else len(line) + 1
    start = max(0, span.column - 1 - width // 2) if len(line) > width else 0
    shown = visible(line[start : start + width])
    return shown, span.column - start, min(end - start, len(shown) + 1)


class SssgenError(Exception):
    """All errors of an input. `diagnostics` is never empty."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("\n".join(diagnostic.render() for diagnostic in self.diagnostics))

    def __reduce__(self) -> tuple[type[SssgenError], tuple[list[Diagnostic]]]:
        return type(self), (self.diagnostics,)  # errors are sent between processes


class UnsupportedError(SssgenError):
    """The errors of an input that is correct, but that the chosen target cannot express."""


def failure(message: str, hint: str = "", file: str = "") -> SssgenError:
    """An error without a position in a source text (a missing file, a bad argument)."""
    return SssgenError([Diagnostic("error", message, Span(file, 0, 0, 0, 0), hint)])


class Reporter:
    """Collects the diagnostics of one source text; `texts` are those of the files that it includes, by their names."""

    def __init__(self, file: str, text: str, texts: Mapping[str, str] | None = None) -> None:
        self.file = file
        self.texts = texts or {}
        self.macros: Collection[str] = ()
        """The macros that the text uses: an error at such a use may be in the macro's definition."""
        self.lines = text.split("\n")  # as the parser counts them: other line ends are white space to it
        self.diagnostics: list[Diagnostic] = []
        self.warnings: list[Diagnostic] = []
        self.seen: set[tuple[Span, str]] = set()

    def error(self, span: Span, message: str, hint: str = "") -> None:
        """Records an error; the same message at the same place is recorded once. Raises after too many."""
        message, hint = _cut(message), _cut(hint)
        if self.macros and (macro := self.line(span)[span.column - 1 : span.end_column - 1]) in self.macros:
            message = f"{message}, in the expansion of the macro {macro}"
        if (span, message) in self.seen:
            return
        self.seen.add((span, message))
        self.diagnostics.append(Diagnostic("error", message, span, hint, self.line(span)))
        if len(self.diagnostics) >= MAX_ERRORS:
            self.diagnostics.append(
                Diagnostic("error", f"more than {MAX_ERRORS} errors; the others are not reported", span)
            )
            self.check()

    def warn(self, span: Span, message: str, hint: str = "") -> None:
        """Records a warning."""
        self.warnings.append(Diagnostic("warning", _cut(message), span, _cut(hint), self.line(span)))

    def line(self, span: Span) -> str:
        """The text of the line that the span begins on."""
        own = span.file == self.file or span.file not in self.texts
        lines = self.lines if own else self.texts[span.file].split("\n")
        return lines[span.line - 1].rstrip("\r") if 0 < span.line <= len(lines) else ""

    def check(self) -> None:
        """Raises the collected errors in source order, if there are any."""
        if self.diagnostics:
            raise SssgenError(sorted(self.diagnostics, key=lambda diagnostic: diagnostic.span[1:3]))


def _cut(text: str) -> str:
    return text if len(text) <= MAX_MESSAGE else f"{text[:MAX_MESSAGE]}…"


def did_you_mean(word: str, candidates: Iterable[str], aliases: Iterable[str] = ()) -> str:
    """`did you mean 'x'?` for the candidates most like the word, or ''.

    The order: names that begin with the word; a name that differs in a letter or two; names with the word as a part;
    `aliases`, which are other names of the candidates, that begin with it; the most similar of all names.
    """
    import difflib

    if not word or len(word) > 100:
        return ""
    names, others = ([name for name in group if len(name) <= 100][:2000] for group in (candidates, aliases))
    every, folded = [*names, *others], word.lower()
    if same := [name for name in every if name.lower() == folded]:
        return _question(same[:1])
    if longer := _names_starting_with(folded, names):
        return _question(longer)
    if near := difflib.get_close_matches(word, every, n=1, cutoff=ONE_LETTER):
        return _question(near)
    part = re.compile(rf"(?<![a-z0-9]){re.escape(folded)}(?![a-z0-9])")
    holding = [name for name in names if len(word) >= MIN_PART and part.search(name.lower())]
    return _question(
        holding or _names_starting_with(folded, others) or difflib.get_close_matches(word, every, n=1, cutoff=SIMILAR)
    )


def _names_starting_with(folded: str, names: Sequence[str]) -> list[str]:
    return [name for name in names if len(folded) >= MIN_PART and name.lower().startswith(folded)]


def _question(names: Sequence[str]) -> str:
    """`did you mean 'x', 'y' or 'z'?`; '' without a name."""
    if not names:
        return ""
    *first, last = [f"'{name}'" for name in dict.fromkeys(names)][:MAX_SUGGESTIONS]
    return f"did you mean {', '.join(first)}{' or ' if first else ''}{last}?"
