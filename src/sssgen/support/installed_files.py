"""The files that come with sssgen: commands read them and change none of them."""

from __future__ import annotations

import os

from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.paths import PACKAGE, place, posix

_FOLDERS = ("examples", "targets", "templates")


def is_installed(path: str | os.PathLike[str]) -> bool:
    """Whether a path is inside the package or its examples, targets or templates, through linked folders, too.

    A link to such a file, in another folder, is not: a command that writes replaces the link.
    """
    folder, name = os.path.split(os.path.abspath(path))
    full = os.path.normcase(os.path.join(os.path.realpath(folder), name))
    folders = (PACKAGE, *map(place, _FOLDERS))
    return any(full.startswith(os.path.normcase(os.path.realpath(folder)) + os.sep) for folder in folders)


def refusal(path: str | os.PathLike[str]) -> SssgenError:
    """The error for a command that would write such a file."""
    if not os.path.exists(path):
        hint = f"name another folder; or {copy_hint(path)}" if _is_example(path) else "name another folder"
        return failure("this folder comes with sssgen, which does not write here", hint, posix(path))
    return failure("this file comes with sssgen, which does not change it", copy_hint(path), posix(path))


def copy_hint(path: str | os.PathLike[str]) -> str:
    """How to get a copy of an installed file that can be changed."""
    folder = os.path.dirname(os.path.realpath(path))
    if not _is_example(path):
        return "copy it to a folder of your own, and change the copy"
    example = os.path.basename(folder)
    shown = "scene.toml" if os.path.isfile(os.path.join(folder, "scene.toml")) else f"{example}.toml"
    return f"copy the example with `sssgen new {example} --copy {example}`, and open {example}/{shown}"


def _is_example(path: str | os.PathLike[str]) -> bool:
    """Whether a file is in the folder of an example."""
    return os.path.realpath(os.path.dirname(os.path.dirname(os.path.realpath(path)))) == os.path.realpath(
        place("examples")
    )
