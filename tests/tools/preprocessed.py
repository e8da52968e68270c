"""Helpers for tests of the preprocessor: texts with included files, and their tokens."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from sssgen.ir.spans import Span
from sssgen.lang.preprocess.preprocessor import PreprocessedText, preprocess
from sssgen.lang.syntax.lexer import scan
from sssgen.support.diagnostics import SssgenError, failure
from watchdog import bounded


def run(text: str, files: Mapping[str, str] | None = None, **defines: str) -> PreprocessedText:
    def find(name: str, place: Span, angled: bool) -> tuple[str, str]:
        key = f"<{name}>" if angled else name
        if key not in (files or {}):
            raise failure(f"no {key} at {place.line}:{place.column}-{place.end_column}")
        return key, (files or {})[key]

    return preprocess(text, "main", find, defines)


def words(text: str, files: Mapping[str, str] | None = None, **defines: str) -> str:
    return " ".join(token.text for token in run(text, files, **defines).tokens)


def spaced(text: str) -> str:
    """The tokens of a text, separated by spaces."""
    return " ".join(token.text for token in scan(text, "")[0])


def faults(text: str, files: Mapping[str, str] | None = None, **defines: str) -> list[tuple[str, str, int, int]]:
    """The message, file, line and column of each error."""
    with bounded(), pytest.raises(SssgenError) as caught:
        run(text, files, **defines)
    return [(error.message, *error.span[:3]) for error in caught.value.diagnostics]
