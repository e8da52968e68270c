"""Reads the picture files that a material names."""

from __future__ import annotations

import os

from sssgen.interchange.surface_model import Picture
from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.paths import posix

MAX_BYTES = 256 << 20
"""The largest picture file that is read."""


def read_picture(path: str, place: Span) -> Picture:
    """The content of a picture file; `place` is where it is named. Raises SssgenError where it cannot be read."""
    name = os.path.basename(path)
    try:
        if not os.path.isfile(path):
            raise _failure(place, f"there is no picture '{name}'", f"it is looked for at {posix(path)}")
        if os.path.getsize(path) > MAX_BYTES:
            raise _failure(place, f"the picture '{name}' has more than {MAX_BYTES >> 20} MB", "make it smaller")
        with open(path, "rb") as file:
            return Picture(name, file.read())
    except OSError as error:
        raise _failure(place, f"the picture '{name}' cannot be read: {error.strerror}", "") from None


def _failure(place: Span, message: str, hint: str) -> SssgenError:
    return SssgenError([Diagnostic("error", message, place, hint)])
