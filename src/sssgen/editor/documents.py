"""An open file: its text, what kind of file it is, and the words at its places.

Lines and columns count from 0 here, as in editors; those of a `Span` count from 1.
"""

from __future__ import annotations

import os
import re
from typing import NamedTuple

from sssgen.material.roles import SECTIONS
from sssgen.support.paths import posix

TECHNIQUE, MATERIAL, SCENE, GLSL, OTHER = "technique", "material", "scene", "glsl", ""
"""The kinds of files. Other TOML files are left alone."""

SUFFIXES = {".sss": TECHNIQUE, ".glsl": GLSL, ".frag": GLSL, ".vert": GLSL}

_OF_MATERIALS = "|".join(("material", *(section for section in SECTIONS if section not in ("geometry", "environment"))))
_MATERIAL = re.compile(rf"^[ \t]*\[{{1,2}}(?:{_OF_MATERIALS})\b", re.MULTILINE)
_SCENE = re.compile(
    r"^[ \t]*(?:(?:material|bodies)[ \t]*=|\[camera\]|\[\[light\]\]|\[shell\]|\[medium\]|"
    r"\[geometry\][^\[]*^[ \t]*kind[ \t]*=)",
    re.MULTILINE,
)
_STAGE = re.compile(r"^[ \t]*technique[ \t]*=", re.MULTILINE)
_WORD = re.compile(r"[A-Za-z_]\w*")
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+["<]([^">\n]*)')


class Word(NamedTuple):
    """A word on a line, its end exclusive."""

    text: str
    line: int
    start: int
    end: int


class Document(NamedTuple):
    """An open file."""

    path: str
    text: str

    @property
    def kind(self) -> str:
        return kind_of(self.path, self.text)

    @property
    def display_name(self) -> str:
        """The file's name in messages."""
        return posix(self.path)

    @property
    def folder(self) -> str:
        return os.path.dirname(self.path)

    @property
    def lines(self) -> list[str]:
        return self.text.split("\n")

    def line(self, number: int) -> str:
        """A line; '' below the last one."""
        lines = self.lines
        return lines[number].rstrip("\r") if 0 <= number < len(lines) else ""

    def word_at(self, line: int, column: int) -> Word | None:
        """The name at a place, or that ends there."""
        for match in _WORD.finditer(self.line(line)):
            if match.start() <= column <= match.end():
                return Word(match.group(), line, match.start(), match.end())
        return None

    def include_at(self, line: int) -> Word | None:
        """The name of the file that a line includes."""
        match = _INCLUDE.match(self.line(line))
        return Word(match.group(1), line, match.start(1), match.end(1)) if match else None


def kind_of(path: str, text: str) -> str:
    """The kind of a file, by its name; TOML by its sections, of which half may not be written yet."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix != ".toml":
        return SUFFIXES.get(suffix, OTHER)
    if os.path.basename(path) == "pyproject.toml":
        return OTHER
    if _SCENE.search(text):
        return SCENE
    return MATERIAL if _MATERIAL.search(text) or (_STAGE.search(text) and "[geometry]" in text) else OTHER
