"""For tests of the preprocessor: texts with included files, and their tokens."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from sssgen.ir.spans import Span
from sssgen.lang.preprocess.preprocessor import Preprocessed, preprocess
from sssgen.lang.syntax.lexer import scan
from sssgen.support.diagnostics import SssgenError, failure
from watchdog import bounded


def run(text: str, files: Mapping[str, str] | None = None, **defines: str) -> Preprocessed:
    def find(name: str, place: Span, angled: bool) -> tuple[str, str]:
        shown = f"<{name}>" if angled else name
        if shown not in (files or {}):
            raise failure(f"no {shown} at {place.line}:{place.column}-{place.end_column}")
        return shown, (files or {})[shown]

    return preprocess(text, "main", find, defines)


def words(text: str, files: Mapping[str, str] | None = None, **defines: str) -> str:
    return " ".join(token.text for token in run(text, files, **defines).tokens)


def spaced(text: str) -> str:
    """A text's tokens, separated by spaces, as from `words`."""
    return " ".join(token.text for token in scan(text, "")[0])


def faults(text: str, files: Mapping[str, str] | None = None, **defines: str) -> list[tuple[str, str, int, int]]:
    """Of each error its message, its file, its line and its column."""
    with bounded(), pytest.raises(SssgenError) as caught:
        run(text, files, **defines)
    return [(one.message, *one.span[:3]) for one in caught.value.diagnostics]
