"""Doc comments: the declaration that each belongs to, and its text without comment marks."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from textwrap import dedent
from typing import Any

from sssgen.ir.spans import Span
from sssgen.lang.syntax import tree as s
from sssgen.lang.syntax.tokens import Comment

_DOC = re.compile(r"///(?!/)|/\*\*(?![*/])")
_EMPTY = re.compile(r"\s*(#.*)?$")


def attach_docs(
    externals: Sequence[Any],
    comments: Mapping[str, Sequence[Comment]],
    lines: Mapping[str, Sequence[str]],
    plain: bool = False,
) -> tuple[s.External, ...]:
    """Gives each declaration the doc comment that ends on the line before it: a `/** */` block, or `///` lines.

    In `plain` GLSL every comment on lines of its own counts, and empty lines and directives may follow it, as in files
    with include guards.
    """
    ends = {file: _by_end(in_file, lines[file], plain) for file, in_file in comments.items()}
    documented: list[s.External] = []
    for external in externals:
        if isinstance(external, s.GlobalSyntax) and external.declaration.type.name == "auto":
            documented.append(external)  # a macro
            continue
        place = _first_place(external)
        by_end = ends.get(place.file, {})
        line = place.line
        if by_end and plain and not isinstance(external, s.GlobalSyntax):
            line = _line_after_comment(lines[place.file], line, by_end)
        parts: list[str] = []
        while line - 1 in by_end:
            line, text = by_end[line - 1]
            parts.append(text)
            if not text.startswith("//"):
                break
        if parts:
            doc = "\n".join(map(words_of, reversed(parts))).strip("\n").rstrip()
            external = replace(external, doc=doc)
        documented.append(external)
    return tuple(documented)


def _by_end(comments: Sequence[Comment], lines: Sequence[str], plain: bool) -> dict[int, tuple[int, str]]:
    """The comments that can document a declaration: last line → (first line, text)."""
    by_end = {}
    for first, last, text in comments:
        if (plain or _DOC.match(text)) and lines[first - 1].lstrip().startswith(text[:2]):
            by_end[last] = first, text
    return by_end


def _line_after_comment(lines: Sequence[str], line: int, by_end: Mapping[int, object]) -> int:
    """The line after the comment before a declaration, if only directives and empty lines are between them."""
    above = line
    while above > 1 and above - 1 not in by_end and _EMPTY.match(lines[above - 2]):
        above -= 1
    return above if above - 1 in by_end else line


def _first_place(external: s.External) -> Span:
    """The place where a declaration begins."""
    if isinstance(external, s.FunctionSyntax):
        return external.result.span
    if isinstance(external, s.GlobalSyntax):
        qualified = external.declaration.qualifiers.span
        return qualified if qualified.line else external.declaration.type.span
    return external.name.span


def words_of(text: str) -> str:
    """The text of one comment without its marks, with its own indentation."""
    if text.startswith("//"):
        return text[3 if text.startswith("///") else 2 :].removeprefix(" ").rstrip()
    first, *rest = [line.rstrip() for line in text[2:-2].removeprefix("*").split("\n")]
    if all(line.lstrip().startswith("*") for line in rest if line.strip()):
        rest = [line.lstrip()[1:].removeprefix(" ") for line in rest]
        return "\n".join([first.strip(), *rest])
    return "\n".join([first.strip(), dedent("\n".join(rest))])
