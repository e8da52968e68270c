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
PRESETS = os.path.join(PACKAGE, "presets", "presets.toml")
"""The table of the ready materials."""

_LIBRARIES = tuple(os.path.realpath(folder) + os.sep for folder in (TECHNIQUES, PACKAGE))
"""Their real paths; a file's name is relative to them."""


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


def shell_word(path: str) -> str:
    """A path in a command to copy: from the current folder where it is below it, in double quotes if it has blanks."""
    try:
        relative = os.path.relpath(path)
    except (OSError, ValueError):  # the current folder is gone, or on another drive
        relative = os.pardir
    shown = posix(path if relative.startswith(os.pardir) else relative)
    return f'"{shown}"' if " " in shown else shown


def source_name(path: str | os.PathLike[str]) -> str:
    """The one name of a source file, however its path is spelled: its place in the library, or its real path.

    Spans have this name, so two declarations of equal spans are the same. People see `display_name`. A name that no
    file can have stays: who reads the file says so.
    """
    try:
        real = os.path.realpath(path)
    except ValueError:  # it contains a zero byte, or what is no character
        return posix(path)
    for library in _LIBRARIES:
        inside = real.removeprefix(library)
        if inside != real and not inside.startswith("_data"):  # a wheel has the examples there
            return posix(inside)
    return posix(real)


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
