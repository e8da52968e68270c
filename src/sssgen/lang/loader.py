"""Loads source files: follows `#include`, checks, and keeps the result by content so that it is checked once.

The cache holds pickled IR under the hash of the text, of what it includes and of the front end itself.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence

from .. import cache
from ..diagnostics import Diagnostic, SssgenError, failure
from ..ir.nodes import Module, Span
from ..watch import note

MAX_BYTES = 4 << 20
"""The largest source file that is read. Shader libraries of thousands of functions stay below 1 MB."""

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"\n]*)"', re.MULTILINE)

_memory: dict[str, Module] = {}
_keys: dict[int, str] = {}
_lines: dict[str, list[str]] = {}
_stamp = ""


def load_file(path: str | os.PathLike[str], shown: str, roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a file and all it includes.

    `shown` is the file's name in messages; `roots` are the folders in which `#include "x"` is looked for,
    after the file's own. Raises SssgenError for a missing, unreadable, too large or faulty file.
    """
    return load_text(read_text(path, shown), shown, (os.path.dirname(path), *roots))


def load_text(text: str, shown: str, roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a source text; see `load_file`."""
    return _load(text, shown, roots, ())[0]


def _load(
    text: str, shown: str, roots: Sequence[str | os.PathLike[str]], within: tuple[str, ...]
) -> tuple[Module, str]:
    """A text's module and the hash of all that it was made from."""
    _lines[shown] = text.split("\n")
    included, parts = Module(), [front_end_stamp(), shown, text]
    for match in _INCLUDE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        place = Span(shown, line, match.start(1) - text.rfind("\n", 0, match.start(1)), line, match.end(1) + 1)
        module, key = _include(match.group(1), place, text, roots, (*within, shown))
        included = merge(included, module)
        parts.append(key)
    key = cache.digest("\0".join(parts))
    known = _memory.get(key) or cache.unpickled(cache.read(f"{key}.ir"))
    if not isinstance(known, Module):
        from .check import check
        from .parser import parse

        known = check(parse(text, shown), text, included)
        cache.write(f"{key}.ir", cache.pickled(known))
    _memory[key] = known
    _keys[id(known)] = key
    return known, key


def key_of(module: Module) -> str:
    """The hash of all that a module was made from; '' for one that was not loaded here."""
    return _keys.get(id(module), "")


def comments_before(file: str, line: int) -> list[str]:
    """The `//` comments that stand alone on the lines just before a line of a loaded file, without their marks."""
    lines = _lines.get(file, [])
    found: list[str] = []
    while 1 < line <= len(lines):
        text = lines[line - 2].strip()
        if not text.startswith("//") or text.startswith("///"):
            break
        found.insert(0, text[2:].strip())
        line -= 1
    return found


def source_line(span: Span) -> str:
    """The line that a span of a loaded file begins on, or ''."""
    lines = _lines.get(span.file, [])
    return lines[span.line - 1] if 0 < span.line <= len(lines) else ""


def read_text(path: str | os.PathLike[str], shown: str) -> str:
    """The text of a source file. Raises SssgenError where it is missing or is not text."""
    note(path)
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size > MAX_BYTES:
                raise failure(f"the file is too large: {size} bytes; at most {MAX_BYTES} are read", file=shown)
            data = file.read()
    except FileNotFoundError:
        raise failure("no such file", file=shown) from None
    except OSError as error:
        raise failure(f"cannot read the file: {error.strerror}", file=shown) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - data.rfind(b"\n", 0, error.start)
        place = Span(shown, line, column, line, column + 1)
        raise SssgenError([Diagnostic("error", "this is not UTF-8 text", place)]) from None
    if "\x00" in text:
        raise failure("this is not a text file: it holds a zero byte", file=shown)
    return text.replace("\r\n", "\n")


def merge(first: Module, second: Module) -> Module:
    """Both modules' declarations, what both bring (by its place in the source) once."""
    return Module(*(_union(one, two) for one, two in zip(first, second, strict=True)))


def _union(first: tuple, second: tuple) -> tuple:  # type: ignore[type-arg]  # a tuple of any kind of declaration
    known = {declaration.span for declaration in first}
    return first + tuple(declaration for declaration in second if declaration.span not in known)


def _include(
    name: str, place: Span, text: str, roots: Sequence[str | os.PathLike[str]], within: tuple[str, ...]
) -> tuple[Module, str]:
    """The module of an included file, and its hash."""
    line = text.splitlines()[place.line - 1]
    for root in roots:
        path = os.path.join(root, name)
        if os.path.isfile(path):
            if name in within:
                message = f"'{name}' includes itself: {' → '.join((*within, name))}"
                raise SssgenError([Diagnostic("error", message, place, "", line)])
            return _load(read_text(path, name), name, (os.path.dirname(path), *roots), within)
        note(path)
    hint = "it is looked for beside the file and in the technique library"
    raise SssgenError([Diagnostic("error", f"cannot find '{name}' to include", place, hint, line)])


def front_end_stamp() -> str:
    """Tells one state of the project's own sources from another, so that no stale result is used."""
    global _stamp
    if not _stamp:
        here = os.path.dirname(__file__)
        _stamp = repr([cache.stamp(folder) for folder in (here, os.path.join(os.path.dirname(here), "ir"))])
    return _stamp
