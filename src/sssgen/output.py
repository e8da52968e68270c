"""Writing emitted files: inside their folder only, and each whole or not at all."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath, PureWindowsPath

from .diagnostics import Diagnostic, SssgenError, failure
from .ir.nodes import NOWHERE
from .ir.typed import NamedTuple


class Written(NamedTuple):
    """One file of an emit; `changed` is false where it already held the same text and was left as it was."""

    path: Path
    changed: bool


def check_names(names: Iterable[str]) -> None:
    """Raises SssgenError for every name that leaves its folder, or that some system cannot have."""
    wrong = [
        Diagnostic(
            "error",
            f"cannot write {name[:200]!r}: {why}",
            NOWHERE,
            "an output is named like `ice.wgsl` or `include/ice.hlsl`",
        )
        for name in names
        if (why := _fault(name))
    ]
    if wrong:
        raise SssgenError(wrong)


_UNFIT = re.compile(r'[\x00-\x1f<>:"|?*\\]')


def _fault(name: str) -> str:
    """What is wrong with an output's name, or ''."""
    if not name.strip():
        return "the name is empty"
    if PurePosixPath(name).is_absolute() or PureWindowsPath(name).anchor:
        return "the name is absolute"
    if ".." in re.split(r"[/\\]", name):
        return "the name climbs out of the output folder"
    if _UNFIT.search(name):
        return "the name has characters that file names cannot have on every system"
    if any(part in ("", ".") or part.endswith((".", " ")) for part in name.split("/")):
        return "the name is not a plain file name"
    return ""


def write_files(folder: Path, files: Mapping[str, str]) -> list[Written]:
    """Writes texts (UTF-8, as they are) into a folder, making it if need be; names may have sub-folders.

    All texts stand in temporary files before the first old file is replaced, each in one step:
    whatever interrupts, every file is either the old or the new one, whole. Raises SssgenError where a name
    climbs out of the folder or the system refuses.
    """
    check_names(files)
    _check_links(folder, files)
    waiting: list[tuple[Path, Path]] = []
    written: list[Written] = []
    try:
        for name, text in files.items():
            path, data = folder / name, text.encode("utf-8")
            if _holds(path, data):
                written.append(Written(path, False))
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.is_dir():
                raise failure("cannot write the file: a folder has its name", file=path.as_posix())
            temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
            waiting.append((temporary, path))
            temporary.write_bytes(data)
            written.append(Written(path, True))
        while waiting:
            waiting[0][0].replace(waiting[0][1])
            waiting.pop(0)
    except OSError as error:
        place = str(error.filename or folder).replace(os.sep, "/")
        place = next(
            (path.as_posix() for temporary, path in waiting if str(temporary) == str(error.filename)), place
        )
        raise failure(f"cannot write: {error.strerror or error}", _advice(error), place) from None
    finally:
        for temporary, _ in waiting:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
    return written


def _holds(path: Path, data: bytes) -> bool:
    """Whether the file already holds this, so that no editor need import it again."""
    try:
        return path.stat().st_size == len(data) and path.is_file() and path.read_bytes() == data
    except OSError:
        return False


def _check_links(folder: Path, names: Iterable[str]) -> None:
    """Raises SssgenError where a sub-folder is a link to somewhere outside."""
    parents = {(folder / name).parent for name in names} - {folder}
    for parent in sorted(parents):
        if not parent.resolve().is_relative_to(folder.resolve()):
            raise failure(
                "cannot write here: this folder is a link out of the output folder", file=parent.as_posix()
            )


def _advice(error: OSError) -> str:
    if isinstance(error, PermissionError):
        return "choose a folder that you may write to, with -o"
    if isinstance(error, FileExistsError | NotADirectoryError):
        return "a file stands where a folder is wanted: choose another one, with -o"
    return ""
