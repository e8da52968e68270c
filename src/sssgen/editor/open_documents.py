"""The documents that an editor has open, each with what was read of it."""

from __future__ import annotations

import os

from sssgen.editor.analysis import Analysis, analyse
from sssgen.editor.documents import Document
from sssgen.editor.problems import Problem, problems_of
from sssgen.support import unsaved
from sssgen.support.text_files import read_text


class OpenDocuments:
    """The open documents by path."""

    def __init__(self) -> None:
        self._documents: dict[str, Document] = {}
        self._analyses: dict[str, Analysis] = {}

    def change(self, path: str, text: str) -> None:
        """Takes a new text of a file, which is read from now on in place of what is on disk."""
        text = text.replace("\r\n", "\n")
        path = os.path.abspath(path)
        unsaved.keep(path, text)
        self._documents[path] = Document(path, text)

    def close(self, path: str) -> None:
        """Forgets a file: what is on disk is read again."""
        path = os.path.abspath(path)
        unsaved.drop(path)
        self._documents.pop(path, None)
        self._analyses.pop(path, None)

    def problems(self, path: str) -> list[Problem]:
        """The problems of an open document, which is read again; those of a closed one: none."""
        path = os.path.abspath(path)
        document = self._documents.get(path)
        if document is None:
            return []
        self._analyses[path] = analyse(document, self._analyses.get(path))
        return problems_of(document, self._analyses[path])

    def get(self, path: str) -> tuple[Document, Analysis] | None:
        """An open document and what it says; None for a closed one."""
        path = os.path.abspath(path)
        document = self._documents.get(path)
        if document is None:
            return None
        if path not in self._analyses:
            self._analyses[path] = analyse(document)
        return document, self._analyses[path]

    def refresh(self, path: str) -> tuple[Document, Analysis] | None:
        """As `get`, of the text as it is: where its analysis is of an older one, it is read again."""
        if path in self._documents:
            self.problems(path)
        return self.get(path)

    def lines_of(self, path: str) -> list[str]:
        """The lines of a file, open or not."""
        document = self._documents.get(path)
        return document.lines if document else Document(path, read_text(path, path)).lines

    @property
    def paths(self) -> list[str]:
        """The paths of the open documents."""
        return list(self._documents)

    def depending_on(self, path: str) -> list[str]:
        """The other open documents that read a file."""
        path = os.path.abspath(path)
        return [other for other, analysis in self._analyses.items() if other != path and path in analysis.files]
