"""Opens texts as an editor does, with a mark at the cursor's place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from sssgen.editor.analysis import Analysis
from sssgen.editor.documents import Document
from sssgen.editor.open_documents import OpenDocuments

MARK = "‸"


class Opened(NamedTuple):
    """An open document, and the place of the mark in it."""

    documents: OpenDocuments
    document: Document
    analysis: Analysis
    line: int
    column: int

    @property
    def place(self) -> tuple[Document, Analysis, int, int]:
        return self.document, self.analysis, self.line, self.column


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Callable[..., Opened]]:
    """`opened("my.sss", text)`: the text without its mark, open and read; `right` was read before it."""
    documents = OpenDocuments()
    paths: list[str] = []

    def open_text(name: str, text: str, right: str = "") -> Opened:
        before, _, after = text.partition(MARK)
        path = str(tmp_path / name)
        paths.append(path)
        if right:
            documents.change(path, right.replace(MARK, ""))
            assert documents.problems(path) == []
        documents.change(path, before + after)
        documents.problems(path)
        found = documents.get(path)
        assert found is not None
        return Opened(documents, *found, before.count("\n"), len(before) - before.rfind("\n") - 1)

    yield open_text
    for path in paths:
        documents.close(path)
