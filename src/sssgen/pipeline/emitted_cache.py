"""The files of earlier `sssgen emit` commands: an equal command on unchanged files compiles nothing.

An entry is valid while every file that was read for it has the same content and sssgen itself is unchanged.
"""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from sssgen.support import cache
from sssgen.support.diagnostics import Diagnostic
from sssgen.support.paths import PACKAGE, place


class EmittedFiles(NamedTuple):
    """The texts of a command, not yet written."""

    files: dict[str, str]
    sources: dict[str, tuple[str, str]]
    """File name → the material and the target of the text."""
    warnings: list[Diagnostic]
    requires: dict[str, list[str]]
    """Material → what it requires besides its parameters, in words."""
    errors: Sequence[Diagnostic] = ()
    """Of the materials that have no files here; such a result is not kept."""


def load(command: Sequence[str]) -> EmittedFiles | None:
    """The files of the command (its materials, targets and options), if nothing that they depend on has changed."""
    entry = cache.unpickle(cache.read(_entry_name(command)))
    if not isinstance(entry, tuple) or entry[0] != installation():
        return None
    _, digests, emitted = entry
    return EmittedFiles(*emitted) if _digests(digests) == digests else None


def store(command: Sequence[str], emitted: EmittedFiles, read: Iterable[str]) -> None:
    """Writes the files of a command to the cache; `read` are the paths that were read for them.

    Nothing is stored while plug-ins are installed: it is unknown which files their text depends on.
    """
    from sssgen.targets import registry

    if registry.has_plugins():
        return
    entry = (installation(), _digests(read), tuple(emitted))
    cache.write(_entry_name(command), cache.to_pickle(entry))


def _digests(paths: Iterable[str]) -> dict[str, str]:
    """Path → digest of the file's content; '' for a missing file."""
    digests = {}
    for path in paths:
        try:
            with open(path, "rb") as file:
                digests[path] = cache.digest(file.read())
        except OSError:
            digests[path] = ""
    return digests


def _entry_name(command: Sequence[str]) -> str:
    return "emitted-" + cache.digest("\0".join([os.getcwd(), *command]))


@functools.cache
def installation() -> list[object]:
    """The state of sssgen's files and of the Python that runs it, to compare with that of an entry."""
    packages = [path for path in sys.path if path.endswith("-packages") and os.path.isdir(path)]
    folders = (PACKAGE, place("targets"), place("templates"))
    changed = [(path, os.stat(path).st_mtime_ns) for path in packages]  # a plug-in may have been installed there
    return [sys.version, changed, *map(cache.stamp, folders)]
