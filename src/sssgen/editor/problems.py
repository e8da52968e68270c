"""The diagnostics of a document at their places in it; those of files that it names stand where it names them."""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from sssgen.editor.analysis import Analysis, own_names
from sssgen.editor.documents import Document
from sssgen.editor.source_files import path_of
from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic
from sssgen.support.paths import display_name

_QUOTED = re.compile(r"'([^']+)'")


class Range(NamedTuple):
    """A part of a text: lines and columns from 0, the end exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int


class Problem(NamedTuple):
    """An error or warning in an open document."""

    range: Range
    severity: str
    message: str
    hint: str = ""
    related_path: str = ""
    """The file that the problem is in, where it is another one."""
    related_range: Range = Range(0, 0, 0, 0)
    related_message: str = ""


class Fix(NamedTuple):
    """A change that a problem's hint suggests: a word takes the place of a range."""

    title: str
    range: Range
    text: str


def range_of(span: Span) -> Range:
    """The range of a span; the start of the file for one without a place."""
    if not span.line:
        return Range(0, 0, 0, 0)
    return Range(span.line - 1, max(0, span.column - 1), span.end_line - 1, max(0, span.end_column - 1))


def problems_of(document: Document, analysis: Analysis) -> list[Problem]:
    """The problems of an analysed document."""
    own = own_names(document)
    return [_problem(document, analysis, own, diagnostic) for diagnostic in analysis.diagnostics]


def _problem(document: Document, analysis: Analysis, own: tuple[str, ...], diagnostic: Diagnostic) -> Problem:
    severity, message, span, hint, _ = diagnostic
    if not span.file or span.file in own:
        return Problem(_visible_range(document, range_of(span)), severity, message, hint)
    shown = display_name(span.file, os.path.realpath(document.folder))
    place = f"{shown}:{span.line}:{span.column}: " if span.line else f"{shown}: "
    path = path_of(span.file, document, analysis.files)
    return Problem(_mention(document, span.file), severity, place + message, hint, path, range_of(span), message)


def _visible_range(document: Document, range: Range) -> Range:
    """A range that is not empty: an error at the end of a line is shown on its last character."""
    if range[:2] != range[2:]:
        return range
    width = len(document.line(range.line))
    start = min(range.column, max(0, width - 1))
    return Range(range.line, start, range.line, max(start + 1, min(width, start + 1)))


def _mention(document: Document, file: str) -> Range:
    """Where a document names a file, or the technique in it; its first line if it names neither itself."""
    base = os.path.basename(file)
    for name in (file, base, f'"{os.path.splitext(base)[0]}"'):
        for number, line in enumerate(document.lines):
            column = line.find(name)
            if column >= 0 and not line.lstrip().startswith("//"):
                return Range(number, column, number, column + len(name))
    return Range(0, 0, 0, max(1, len(document.line(0))))


def fixes_of(document: Document, problem: Problem) -> list[Fix]:
    """The changes that a hint of the form `did you mean 'x' or 'y'?` suggests."""
    if not problem.hint.startswith("did you mean ") or problem.related_path:
        return []
    line = document.line(problem.range.line)
    end = problem.range.end_column if problem.range.end_line == problem.range.line else len(line)
    text = line[problem.range.column : end]
    for wrong in _QUOTED.findall(problem.message):
        match = re.search(rf"(?<!\w){re.escape(wrong)}(?!\w)", text)
        if match:
            start = problem.range.column + match.start()
            place = Range(problem.range.line, start, problem.range.line, start + len(wrong))
            names = [name.removeprefix("the file ") for name in _QUOTED.findall(problem.hint)]
            return [Fix(f"Change '{wrong}' to '{name}'", place, name) for name in names]
    return []
