"""Reads text files of users. Every file that is read is recorded for `file_memo`."""

from __future__ import annotations

import os
import stat
from collections.abc import Sequence

from sssgen.ir.spans import Span
from sssgen.support import unsaved
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean, failure
from sssgen.support.file_memo import note
from sssgen.support.paths import posix, shell_word, stem

MAX_BYTES = 4 << 20
"""The largest text file that is read. Shader libraries of thousands of functions stay below 1 MB."""

TEXTS = (".toml", ".sss", ".glsl")
"""The suffixes of the texts that most commands read."""
_MESHES = (".obj", ".ply", ".stl", ".glb", ".gltf", ".fbx", ".blend", ".usd", ".usdz", ".dae")
_CODE = {
    ".html": "HTML", ".htm": "HTML", ".js": "JavaScript", ".mjs": "JavaScript", ".ts": "TypeScript", ".css": "CSS",
    ".json": "JSON", ".md": "Markdown", ".gd": "GDScript", ".py": "Python",
}  # fmt: skip
"""The suffixes of other texts of a project → their languages."""
_PICTURES = (".png", ".jpg", ".jpeg", ".exr", ".hdr", ".npy", ".tif", ".tiff", ".webp", ".dds", ".ktx2")


def read_text(path: str | os.PathLike[str], shown: str, otherwise: str = "") -> str:
    """The text of a UTF-8 file, its lines ended by `\\n`; `shown` is its name in messages.

    An editor's unsaved text is read in place of the file's. `otherwise` is the encoding of a file that is not UTF-8.

    Raises SssgenError where the file is missing, too large, not a regular file (a pipe, a device), or not text.
    """
    note(path)
    if (kept := unsaved.text_of(path)) is not None:
        return _checked_text(kept.encode("utf-8", "surrogatepass"), shown)
    try:
        refuse_special(path, shown)
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            _check_size(size, shown)
            data = file.read()
    except FileNotFoundError:
        raise failure("no such file", _near(path), shown) from None
    except OSError as error:
        refuse_folder(path)
        raise failure(f"cannot read the file: {error.strerror}", "check its permissions", shown) from None
    except ValueError:  # a zero byte or a lone surrogate in its name
        raise failure("this is not a valid file name", "name a file that exists", shown) from None
    return _checked_text(data, shown, otherwise)


def _near(path: str | os.PathLike[str]) -> str:
    """What to do about a file that is missing: a file of a similar name, or the folder that is missing, too."""
    folder, name = os.path.split(os.fspath(path))
    try:
        return did_you_mean(name, sorted(os.listdir(folder or "."))) or "check the name"
    except OSError:
        return f"there is no folder '{folder}'"


def _check_size(size: int, shown: str) -> None:
    if size > MAX_BYTES:
        raise failure(f"the file is too large: {size} bytes; at most {MAX_BYTES} are read", "split it", shown)


def read_code(path: str | os.PathLike[str], shown: str) -> str:
    """As `read_text`, for code of others: a file that is not UTF-8 is in Windows-1252, which older editors wrote."""
    return read_text(path, shown, "windows-1252")


def _checked_text(data: bytes, shown: str, otherwise: str = "") -> str:
    """The text of a file's bytes. Raises SssgenError where they are too many, or no text."""
    _check_size(len(data), shown)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if not otherwise:
            raise _not_text("this is not UTF-8 text", data, error.start, shown) from None
        text = data.decode(otherwise, "replace")
    if "\x00" in text:
        raise _not_text("this is not a text file: it contains a zero byte", data, data.index(b"\x00"), shown)
    return text.replace("\r\n", "\n")


def refuse_special(path: str | os.PathLike[str], shown: str) -> None:
    """Raises SssgenError for a pipe, which would block, and a device, which may be endless; OSError as `stat`."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise failure("this is not a file", "write its content into a file first", shown)


def refuse_other_kinds(path: str | os.PathLike[str]) -> None:
    """Raises SssgenError for a file where TOML is wanted, whose name says that it is of another kind."""
    shown, suffix = posix(path), os.path.splitext(os.fspath(path))[1].lower()
    if suffix in _MESHES:
        hint = f"put a ready material on it: sssgen use wax {shell_word(shown)} -o DIR"
        raise failure("this is a mesh, and not a TOML file", hint, shown)
    if suffix in _PICTURES:
        raise failure("this is a picture, and not a TOML file", "name a material or a scene that uses it", shown)
    if suffix in _CODE:
        hint = "name the .toml file of a material or a scene"
        raise failure(f"this is {_CODE[suffix]}, and not a TOML file", hint, shown)


def refuse_folder(path: str | os.PathLike[str], suffixes: Sequence[str] = TEXTS, usual: str = "") -> None:
    """Raises SssgenError for a folder; the hint names a file in it that ends in one of the suffixes, if possible
    `usual`, or the one with the folder's name.
    """
    if not os.path.isdir(path):
        return
    try:
        names = sorted(os.listdir(path))
    except OSError:
        names = []
    shown = posix(os.path.normpath(path))
    hint = f"it has no file that ends in {' or '.join(suffixes)}: name one"
    for suffix in suffixes:
        if files := [name for name in names if name.endswith(suffix)]:
            preferred = next((name for name in (usual, f"{stem(shown)}{suffix}") if name in files), "")
            hint = f"name a file in it, such as {shown}/{preferred or files[0]}"
            if len(files) > 1 and not preferred:
                hint += f", or all where the command takes several: {shown}/*{suffix}"
            break
    raise failure("this is a folder, not a file", hint, shown)


def _not_text(message: str, data: bytes, position: int, shown: str) -> SssgenError:
    line = data.count(b"\n", 0, position) + 1
    column = position - data.rfind(b"\n", 0, position)
    return SssgenError([Diagnostic("error", message, Span(shown, line, column, line, column + 1))])
