"""Doc comments: which declaration each belongs to, and its words without its marks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from textwrap import dedent
from typing import Any

from . import syntax as s

Comment = tuple[int, int, str]
"""The first line of a comment, its last line, and its text as written."""

_DOC = re.compile(r"///(?!/)|/\*\*(?![*/])")


def attach_docs(externals: Sequence[Any], comments: Sequence[Comment], lines: Sequence[str]) -> tuple[s.External, ...]:
    """Gives each declaration the doc comment that ends on the line before it: a `/** */` block, or `///` lines."""
    by_end = {
        end: (first, text)
        for first, end, text in comments
        if _DOC.match(text) and lines[first - 1].lstrip().startswith(text[:3])
    }
    documented: list[s.External] = []
    for external in externals:
        line = _first_line(external)
        parts: list[str] = []
        while line - 1 in by_end:
            line, text = by_end[line - 1]
            parts.append(text)
            if text.startswith("/**"):
                break
        if parts:
            doc = "\n".join(map(_words, reversed(parts))).strip("\n").rstrip()
            external = external._replace(doc=doc)
        documented.append(external)
    return tuple(documented)


def _first_line(external: s.External) -> int:
    """The line that a declaration begins on; 0 for what has no documentation."""
    if isinstance(external, s.FunctionSyntax):
        return external.result.span.line
    if isinstance(external, s.UniformSyntax):
        return external.type.span.line
    return external.name.span.line if isinstance(external, s.StructSyntax) else 0


def _words(text: str) -> str:
    """The words of one comment: what stands behind the marks, its own indentation kept."""
    if text.startswith("///"):
        return text[3:].removeprefix(" ").rstrip()
    first, *rest = [line.rstrip() for line in text[3:-2].split("\n")]
    if all(line.lstrip().startswith("*") for line in rest if line.strip()):
        rest = [line.lstrip()[1:].removeprefix(" ") for line in rest]
        return "\n".join([first.strip(), *rest])
    return "\n".join([first.strip(), dedent("\n".join(rest))])
