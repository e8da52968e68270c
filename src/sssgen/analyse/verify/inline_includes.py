"""Replaces `#include` in a GLSL text by the included text, for drivers and compilers without it."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

from sssgen.support.diagnostics import failure
from sssgen.support.text_files import read_code

_INCLUDE = re.compile(r"""^[ \t]*\#[ \t]*include[ \t]+(?:"([^"\n]+)"|<([^>\n]+)>)[^\n]*$""", re.MULTILINE)
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def expand(text: str, path: str | os.PathLike[str], roots: Sequence[str | os.PathLike[str]] = ()) -> str:
    """The text of the file at `path` with each included file in place of its first `#include`; later ones are removed.

    A file is searched for next to the file that includes it, then in `roots`. Raises SssgenError for a missing file.
    """
    return _expand(text, Path(path), [Path(root) for root in roots], set())


def _expand(text: str, path: Path, roots: Sequence[Path], seen: set[Path]) -> str:
    seen.add(path.resolve())
    comments = [comment.span() for comment in _COMMENT.finditer(text)]

    def included(match: re.Match[str]) -> str:
        if any(start <= match.start() < end for start, end in comments):
            return match[0]
        name = match[1] or match[2]
        for folder in (path.parent, *roots):
            file = folder / name
            if file.is_file():
                if file.resolve() in seen:
                    return ""
                return _expand(read_code(file, file.as_posix()), file, roots, seen)
        raise failure(
            f"cannot find '{name}' to include",
            "it is searched for next to the file, and in the folders of -I",
            path.as_posix(),
        )

    return _INCLUDE.sub(included, text)
