"""What `sssgen emit` made, kept between processes: the same command on the same files need not compile again.

An entry holds for as long as every file that went into it has the same content, and sssgen itself is the same.
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


class Made(NamedTuple):
    """The texts of a command, not yet written."""

    files: dict[str, str]
    sources: dict[str, tuple[str, str]]
    """File name → the material and the target that it is for."""
    warnings: list[Diagnostic]


def recall(materials: Sequence[str], target: str, form: str, guards: str) -> Made | None:
    """What the command made, if nothing has changed since."""
    found = cache.unpickled(cache.read(_name(materials, target, form, guards)))
    if not isinstance(found, tuple) or found[0] != installation():
        return None
    _, state, made = found
    return Made(*made) if _state(state) == state else None


def remember(materials: Sequence[str], target: str, form: str, guards: str, made: Made, files: Iterable[str]) -> None:
    """Keeps what a command made, unless a plug-in may have had a part in it, whose files are not known here."""
    from sssgen.targets import registry

    if registry.has_plugins():
        return
    cache.write(_name(materials, target, form, guards), cache.pickled((installation(), _state(files), tuple(made))))


def _state(files: Iterable[str]) -> dict[str, str]:
    """The content of each file, shortened; '' for one that is not there."""
    found = {}
    for path in files:
        try:
            with open(path, "rb") as file:
                found[path] = cache.digest(file.read())
        except OSError:
            found[path] = ""
    return found


def _name(materials: Sequence[str], target: str, form: str, guards: str) -> str:
    return "emitted-" + cache.digest("\0".join([os.getcwd(), target, form, guards, *materials]))


@functools.cache
def installation() -> list[object]:
    """Tells one state of sssgen, and of the Python that it runs in, from another."""
    packages = [path for path in sys.path if path.endswith("-packages") and os.path.isdir(path)]
    folders = (PACKAGE, place("targets"), place("templates"))
    changed = [(path, os.stat(path).st_mtime_ns) for path in packages]  # where a plug-in may have come
    return [sys.version, changed, *map(cache.stamp, folders)]
