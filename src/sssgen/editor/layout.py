"""Lays out files: blanks, indentation and blank lines, never what they mean. A file with errors is not changed."""

from __future__ import annotations

import os
import stat

from sssgen.editor.layout_code import code_layout
from sssgen.editor.layout_toml import toml_layout
from sssgen.support.diagnostics import failure
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text

LAYOUTS = {".sss": code_layout, ".toml": toml_layout}
"""The suffixes of files that have a layout."""


def lay_out(text: str, path: str) -> str:
    """The text of a file in its layout. Raises SssgenError with its syntax errors, or for a file of another kind."""
    layout = LAYOUTS.get(os.path.splitext(path)[1].lower())
    if layout is None:
        raise failure("this kind of file has no layout", f"it is for {' and '.join(LAYOUTS)}", posix(path))
    return layout(text, posix(path))


def lay_out_file(path: str, write: bool = True) -> bool:
    """Whether a file's layout changes; it is then written, atomically, unless `write` is False. Raises SssgenError.

    Line ends stay those of the file, and a link stays a link.
    """
    text = read_text(path, posix(path))
    result = lay_out(text, path)
    if result == text:
        return False
    if write:
        target = os.path.realpath(path)
        with open(target, "rb") as file:
            crlf = b"\r\n" in file.read()
        mode = stat.S_IMODE(os.stat(target).st_mode)
        data = result.replace("\n", "\r\n") if crlf else result
        write_files(os.path.dirname(target), {os.path.basename(target): data.encode("utf-8")}, installed=True)
        os.chmod(target, mode)
    return True
