"""Where a name was declared: through `#include`, and from materials and scenes into techniques."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.editor.analysis import Analysis
from sssgen.editor.documents import Document
from sssgen.editor.lookup import meaning_at
from sssgen.editor.problems import Range, range_of


class Target(NamedTuple):
    """A place in a file."""

    path: str
    range: Range


def definition_at(document: Document, analysis: Analysis, line: int, column: int) -> Target | None:
    """Where the declaration is; None for what no file declares, such as a builtin."""
    meaning = meaning_at(document, analysis, line, column)
    if meaning is None or not meaning.path:
        return None
    return Target(meaning.path, range_of(meaning.span) if meaning.span is not None else Range(0, 0, 0, 0))
