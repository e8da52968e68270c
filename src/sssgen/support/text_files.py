"""Reads text files of users. Every file that is read is recorded for `file_memo`."""

from __future__ import annotations

import os
import stat

from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_memo import note

MAX_BYTES = 4 << 20
"""The largest text file that is read. Shader libraries of thousands of functions stay below 1 MB."""


def read_text(path: str | os.PathLike[str], shown: str) -> str:
    """The text of a UTF-8 file, its lines ended by `\\n`; `shown` is its name in messages.

    Raises SssgenError where the file is missing, too large, not a regular file (a pipe, a device), or not text.
    """
    note(path)
    try:
        refuse_special(path, shown)
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size > MAX_BYTES:
                raise failure(f"the file is too large: {size} bytes; at most {MAX_BYTES} are read", file=shown)
            data = file.read()
    except FileNotFoundError:
        raise failure("no such file", file=shown) from None
    except OSError as error:
        raise failure(f"cannot read the file: {error.strerror}", file=shown) from None
    except ValueError:  # a zero byte or a lone surrogate in its name
        raise failure("this is not a valid file name", file=shown) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _not_text("this is not UTF-8 text", data, error.start, shown) from None
    if "\x00" in text:
        raise _not_text("this is not a text file: it contains a zero byte", data, data.index(b"\x00"), shown)
    return text.replace("\r\n", "\n")


def refuse_special(path: str | os.PathLike[str], shown: str) -> None:
    """Raises SssgenError for a pipe, which would block, and a device, which may be endless; OSError as `stat`."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise failure("this is not a file", "write its content into a file first", shown)


def _not_text(message: str, data: bytes, position: int, shown: str) -> SssgenError:
    line = data.count(b"\n", 0, position) + 1
    column = position - data.rfind(b"\n", 0, position)
    return SssgenError([Diagnostic("error", message, Span(shown, line, column, line, column + 1))])
