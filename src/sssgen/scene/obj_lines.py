"""The wrong line of a Wavefront .obj file: its reader names none, and reads some wrong lines as other numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

_LEAST = {b"v": 3, b"vt": 1, b"vn": 3}
"""Keyword → the least numbers behind it."""
_NOUNS = {b"v": "vertex", b"vt": "texture coordinate", b"vn": "normal"}
_CORNER = (b"v", b"vt", b"vn")
"""What the numbers of a corner of a triangle refer to."""
_VERTEX = re.compile(rb"^v[ \t][^\r\n]*", re.MULTILINE)
_OF_ZERO = re.compile(rb"^f[^\n]*[ \t]0[/\s]", re.MULTILINE)
"""A triangle of vertex 0"""


class FaultyLine(NamedTuple):
    """A wrong line, and what is wrong with it."""

    number: int
    text: str
    message: str


def is_doubtful(data: bytes, has_uv: bool) -> bool:
    """Whether a reader may have taken some lines for others; such a file may be right.

    These are rows of numbers of different lengths, triangles of vertex 0, and texture coordinates that were not read.
    """
    lengths = {len(row.split()) for row in _VERTEX.findall(data)}
    return len(lengths) > 1 or _OF_ZERO.search(data) is not None or (not has_uv and b"\nvt " in data)


def faulty_line(data: bytes) -> FaultyLine | None:
    """The first wrong line of a file."""
    lines = data.splitlines()
    rows = [line.partition(b"#")[0].split() for line in lines]
    counts = {key: sum(1 for row in rows if row[:1] == [key]) for key in _LEAST}
    width = 0
    for number, row in enumerate(rows, 1):
        if not row:
            continue
        key, *words = row
        message = ""
        if key in _LEAST:
            message = _of_numbers(key, words)
            if key == b"v" and not message:
                width = width or len(words)
                message = f"a vertex has {len(words)} numbers, and others have {width}" if len(words) != width else ""
        elif key == b"f":
            message = _of_corners(words, counts)
        if message:
            return FaultyLine(number, lines[number - 1].decode("utf-8", "replace"), message)
    return None


def _of_numbers(key: bytes, words: Sequence[bytes]) -> str:
    """What is wrong with a row of numbers, or ''."""
    for word in words:
        try:
            float(word)
        except ValueError:
            shown = word.decode("utf-8", "replace")
            return f"'{shown}' is no number" + (": write a point in place of the comma" if b"," in word else "")
    if len(words) < _LEAST[key]:
        return f"a {_NOUNS[key]} has at least {_LEAST[key]} numbers, and this one has {len(words)}"
    return ""


def _of_corners(words: Sequence[bytes], counts: dict[bytes, int]) -> str:
    """What is wrong with the corners of a triangle or polygon, or ''."""
    for word in words:
        for key, index in zip(_CORNER, word.split(b"/"), strict=False):
            if not index and key != b"v":
                continue
            noun, count = _NOUNS[key], counts[key]
            try:
                place = int(index)
            except ValueError:
                return f"'{word.decode('utf-8', 'replace')}' is no number of a {noun}"
            if place == 0:
                return f"a triangle refers to {noun} 0, and the first one has the number 1"
            if abs(place) > count:
                return f"a triangle refers to {noun} {abs(place)}, and the file has {count}"
    return ""
