"""The folders that come with the project: `templates`, `targets`, `examples`.

In a checkout they are at its top; a wheel has them inside the package. The emit path uses `os.path`, as importing
`pathlib` takes a tenth of a cold emit.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = os.path.dirname(os.path.dirname(__file__))
"""The folder of the package itself."""


TECHNIQUES = os.path.join(PACKAGE, "techniques")
"""The folder of the technique library."""


def place(name: str) -> str:
    """The path of the folder called `name`, in a checkout or an installed package."""
    packaged = os.path.join(PACKAGE, "_data", name)
    return packaged if os.path.isdir(packaged) else os.path.join(os.path.dirname(os.path.dirname(PACKAGE)), name)


def folder(name: str) -> Path:
    """The same as a Path."""
    from pathlib import Path

    return Path(place(name))


def posix(path: str | os.PathLike[str]) -> str:
    """A path as messages show it: with `/`, without empty parts and `.`."""
    text = os.fspath(path).replace(os.sep, "/")
    parts = [part for part in text.split("/") if part not in ("", ".")]
    return "/" * text.startswith("/") + "/".join(parts) or "."


def source_name(path: str | os.PathLike[str]) -> str:
    """The one name of a source file, however its path is spelled: its place in the technique library, or its real path.

    Spans have this name, so two declarations of equal spans are the same. People see `display_name`.
    """
    real, library = os.path.realpath(path), os.path.realpath(TECHNIQUES) + os.sep
    return posix(real.removeprefix(library))


def display_name(name: str, folder: str = "") -> str:
    """A source's name for people: its real path relative to a real `folder`, or to the working folder if shorter."""
    if not os.path.isabs(name):
        return name
    try:
        relative = posix(os.path.relpath(name, folder or None))
    except ValueError:  # it is on another drive
        return name
    return relative if folder else min(relative, name, key=len)


def stem(path: str) -> str:
    """A file's name without its folder and its last suffix."""
    return os.path.splitext(os.path.basename(path))[0]
