"""Writes files atomically, inside their folder only."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from sssgen.ir.spans import NOWHERE
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.installed_files import is_installed, refusal
from sssgen.support.paths import posix


class Written(NamedTuple):
    """A file; `changed` is false where it already had the same content and was not written."""

    path: str
    changed: bool


def check_names(names: Iterable[str]) -> None:
    """Raises SssgenError with every name that leaves its folder, or that is invalid on some system."""
    errors = [
        Diagnostic(
            "error",
            f"cannot write {name[:200]!r}: {reason}",
            NOWHERE,
            "an output is named like `ice.wgsl` or `include/ice.hlsl`",
        )
        for name in names
        if (reason := _fault(name))
    ]
    if errors:
        raise SssgenError(errors)


_DRIVE = re.compile("[A-Za-z]:")
_INVALID = re.compile(r'[\x00-\x1f<>:"|?*\\]')


def _fault(name: str) -> str:
    """Why an output's name is invalid, or ''."""
    if not name.strip():
        return "the name is empty"
    if name.startswith(("/", "\\")) or _DRIVE.match(name):
        return "the name is absolute"
    if ".." in re.split(r"[/\\]", name):
        return "the name leaves the output folder"
    if _INVALID.search(name):
        return "the name has characters that file names cannot have on every system"
    if any(part in ("", ".") or part.endswith((".", " ")) for part in name.split("/")):
        return "the name is not a plain file name"
    return ""


def check_unchanged(folder: str, files: Mapping[str, str | bytes]) -> None:
    """Raises SssgenError where a file is there already with another content."""
    for name, content in files.items():
        path = os.path.join(folder, name)
        if os.path.isfile(path) and not has_content(path, as_bytes(content)):
            hint = "it may have been edited: choose another folder, or replace all files with --force"
            raise failure("the file already exists, with another content", hint, posix(path))


def check_folder(folder: str) -> None:
    """Raises SssgenError if files cannot be written to a folder: a file has its name, or that of a parent, or the user
    may not write there. Commands call it before work that takes long."""
    while folder and not os.path.exists(folder):
        folder = os.path.dirname(folder)
    if folder and not os.path.isdir(folder):
        raise failure("cannot write the file: this is not a folder", "choose another folder with -o", posix(folder))
    if not os.access(folder or ".", os.W_OK | os.X_OK):
        raise failure(
            "cannot write the file: you may not write to this folder", "choose another with -o", posix(folder)
        )


def check_file(path: str) -> None:
    """Raises SssgenError if a file cannot be written: a folder has its name, or as `check_folder`."""
    if os.path.isdir(path):
        raise failure("cannot write the file: a folder has its name", file=posix(path))
    check_folder(os.path.dirname(path))


def write_files(
    folder: str | os.PathLike[str], files: Mapping[str, str | bytes], installed: bool = False
) -> list[Written]:
    """Writes texts (as UTF-8) and bytes to a folder, which is created if missing; names may have sub-folders.

    All are written to temporary files before the first old file is replaced, each atomically: after an interruption
    every file has its complete old or new content. A link is replaced, not followed. `installed` allows changes of
    files that come with sssgen, for its authors. Raises SssgenError for such a file without it, where a name leaves
    the folder or is a device, and where the system refuses.
    """
    folder = os.fspath(folder)
    check_names(files)
    _check_links(folder, files)
    temporaries: list[tuple[str, str]] = []
    written: list[Written] = []
    try:
        for name, content in files.items():
            path = os.path.join(folder, name)
            if _is_special(path):
                raise failure("cannot write the file: this is a device or a pipe", "name a file", posix(path))
            data = as_bytes(content)
            if has_content(path, data):
                written.append(Written(path, False))
                continue
            if not installed and is_installed(path):
                raise refusal(path)
            parent, base = os.path.split(path)
            os.makedirs(parent or ".", exist_ok=True)
            if os.path.isdir(path):
                raise failure("cannot write the file: a folder has its name", file=posix(path))
            temporary = os.path.join(parent, f".{base}.{os.getpid()}.tmp")
            temporaries.append((temporary, path))
            _write_bytes(temporary, data)
            written.append(Written(path, True))
        while temporaries:
            _replace(*temporaries[0])
            temporaries.pop(0)
    except OSError as error:
        place = str(error.filename or folder)
        place = next((path for temporary, path in temporaries if temporary == place), place)
        raise failure(f"cannot write: {error.strerror or error}", _advice(error), posix(place)) from None
    finally:
        for temporary, _ in temporaries:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
    return written


def _is_special(path: str) -> bool:
    """Whether the path is a device, a pipe or a socket, which must not be replaced by a file."""
    return not os.path.islink(path) and os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path)


def _write_bytes(path: str, data: bytes) -> None:
    with open(path, "wb") as file:
        file.write(data)


def _replace(temporary: str, path: str) -> None:
    os.replace(temporary, path)


def as_bytes(content: str | bytes) -> bytes:
    """What a file with this content has: texts are UTF-8."""
    return content if isinstance(content, bytes) else content.encode("utf-8")


def has_content(path: str, data: bytes) -> bool:
    """Whether the file already has this content: engines import a file again when it is written."""
    try:
        if os.stat(path).st_size != len(data) or not os.path.isfile(path):
            return False
        with open(path, "rb") as file:
            return file.read() == data
    except OSError:
        return False


def _check_links(folder: str, names: Iterable[str]) -> None:
    """Raises SssgenError where a sub-folder is a link that leaves the folder."""
    top = os.path.realpath(folder)
    for parent in sorted({os.path.dirname(name) for name in names} - {""}):
        path = os.path.join(folder, parent)
        if os.path.commonpath([top, os.path.realpath(path)]) != top:
            raise failure("cannot write here: this folder is a link that leaves the output folder", file=posix(path))


def _advice(error: OSError) -> str:
    if isinstance(error, PermissionError):
        return "choose a folder with write permission, with -o"
    if isinstance(error, FileExistsError | NotADirectoryError):
        return "a file has the name of the folder: choose another folder with -o"
    return ""
