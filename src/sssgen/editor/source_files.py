"""The paths of files that spans and `#include` name."""

from __future__ import annotations

import os
from collections.abc import Iterable

from sssgen.editor.documents import Document
from sssgen.material import library
from sssgen.support.paths import place, source_name


def path_of(file: str, document: Document, files: Iterable[str] = ()) -> str:
    """The path of a file by its name in messages; '' where it is not found. `files` are those that were read."""
    if file in (document.display_name, source_name(document.path)):
        return document.path
    if os.path.isabs(file) and os.path.isfile(file):
        return file
    ending = os.sep + os.path.normpath(file)
    for path in files:
        if path.endswith(ending) and os.path.isfile(path):
            return path
    roots = (document.folder, library.TECHNIQUES, os.path.dirname(place("examples")))
    return next((path for root in roots if os.path.isfile(path := os.path.join(root, file))), "")
