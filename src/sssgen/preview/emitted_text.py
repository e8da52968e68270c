"""The emitted text of a target with the source of each line, and the text of these sources."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from typing import Any

from sssgen.pipeline.compiler import FORMS, Compiled
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.paths import PACKAGE, TECHNIQUES, posix, source_name
from sssgen.support.text_files import read_text
from sssgen.targets import registry

DEFAULT = "glsl-330"
_GUARDS = "guards/safe_"
"""What the places of a builtin's guard begin with, which is in no file."""


def text_of(emit: Callable[[str, str], Compiled], target: str, form: str) -> dict[str, Any]:
    """The message with the files of a target; where it cannot carry the material, with the error.

    `emit` gives the files of a target and a form. The first file is the one with the most lines that have a source.
    Raises ValueError for a target or a form that does not exist.
    """
    names = registry.names()
    target = target or DEFAULT
    if target not in names or form not in FORMS:
        raise ValueError(target, form)
    message: dict[str, Any] = {"kind": "text"}
    message |= {"target": target, "form": form, "targets": list(names), "error": "", "files": []}
    try:
        compiled = emit(target, form)
    except SssgenError as error:
        return {**message, "error": str(error)}
    reflection = compiled.reflection
    sources = reflection["source_map"]
    message["files"] = [
        {"name": name, "text": text, "sources": sources.get(name, {})}
        for name, text in compiled.files.items()
        if not name.endswith(".json")
    ]
    message["files"].sort(key=lambda file: -len(file["sources"]))
    return message


def source_of(name: str, folder: str, read: Collection[str]) -> dict[str, Any]:
    """The message with the text of a file that lines come from, named relative to a folder. Raises SssgenError.

    It is one of the library, or one of those that were `read` for the picture; no other file is read.
    """
    if name.startswith(_GUARDS):
        builtin = name.removeprefix(_GUARDS)
        note = f"The guard of the builtin {builtin}, where its operands are not proven safe: sssgen show {builtin}"
        return {"kind": "source", "name": name, "text": "", "note": note}
    path = _path(name, folder, read)
    if not path:
        raise failure(f"'{name}' is not a file that this picture depends on", "it may have been renamed: save it again")
    return {"kind": "source", "name": name, "text": read_text(path, posix(path)), "note": ""}


def _path(name: str, folder: str, read: Collection[str]) -> str:
    """The path of a file as places name it: relative to the folder, or as `source_name` has it; '' for others."""
    own = os.path.realpath(os.path.join(folder, name))
    if own in map(os.path.realpath, read):
        return own
    for root in (TECHNIQUES, PACKAGE):  # the library's techniques, and the shells
        path = os.path.normpath(os.path.join(root, name))
        if source_name(path) == name and path.endswith(".sss") and os.path.isfile(path):
            return path
    return ""
