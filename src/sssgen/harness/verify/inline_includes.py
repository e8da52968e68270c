"""A GLSL text with its `#include`s written out, for drivers and compilers that know none."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

from sssgen.support.diagnostics import failure
from sssgen.support.text_files import read_text

_INCLUDE = re.compile(r"""^[ \t]*\#[ \t]*include[ \t]+(?:"([^"\n]+)"|<([^>\n]+)>)[^\n]*$""", re.MULTILINE)
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def expanded(text: str, path: str | os.PathLike[str], roots: Sequence[str | os.PathLike[str]] = ()) -> str:
    """The text of the file at `path` with each included file in place of its first `#include`.

    Later ones of the same file leave nothing: a file that is meant to be included twice guards itself against it.
    Files are looked for beside the one that includes them, then in `roots`. Raises SssgenError for a missing one.
    """
    return _expanded(text, Path(path), [Path(root) for root in roots], set())


def _expanded(text: str, path: Path, roots: Sequence[Path], seen: set[Path]) -> str:
    seen.add(path.resolve())
    silent = [comment.span() for comment in _COMMENT.finditer(text)]

    def written_out(match: re.Match[str]) -> str:
        if any(start <= match.start() < end for start, end in silent):
            return match[0]
        name = match[1] or match[2]
        for folder in (path.parent, *roots):
            found = folder / name
            if found.is_file():
                if found.resolve() in seen:
                    return ""
                return _expanded(read_text(found, found.as_posix()), found, roots, seen)
        raise failure(f"cannot find '{name}' to include", "it is looked for beside the file", path.as_posix())

    return _INCLUDE.sub(written_out, text)
