"""Loads source files: follows `#include`, checks, and keeps the result by content so that it is checked once.

The cache holds pickled IR under the hash of the text, of what it includes and of the front end itself.
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Mapping, Sequence

from sssgen.ir.nodes import Module, Span
from sssgen.lang.front_end_stamp import front_end_stamp
from sssgen.support import cache
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_memo import note

MAX_BYTES = 4 << 20
"""The largest source file that is read. Shader libraries of thousands of functions stay below 1 MB."""

MAX_INCLUDED = 50
"""How deeply files may include files. The library's own do so two deep."""

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"\n]*)"', re.MULTILINE)

_memory: dict[str, Module] = {}
_keys: dict[int, str] = {}
_lines: dict[str, list[str]] = {}


def load_file(path: str | os.PathLike[str], shown: str, roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a file and all it includes.

    `shown` is the file's name in messages; `roots` are the folders in which `#include "x"` is looked for,
    after the file's own. Raises SssgenError for a missing, unreadable, too large or faulty file.
    """
    return load_text(read_text(path, shown), shown, (os.path.dirname(path), *roots))


def load_text(text: str, shown: str, roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a source text; see `load_file`."""
    return _load(text, shown, tuple([os.fspath(root) for root in roots]), (), {})[0]


_Loaded = dict[tuple[str, tuple[str, ...]], tuple[Module, str]]
"""The files included so far, by path and roots: each is read once, however many ways lead to it."""


def _load(
    text: str, shown: str, roots: tuple[str, ...], within: tuple[str, ...], loaded: _Loaded
) -> tuple[Module, str]:
    """A text's module and the hash of all that it was made from."""
    _lines[shown] = text.split("\n")
    included, parts = Module(), [front_end_stamp(), shown, text]
    for name, place in _includes(text, shown).items():
        module, key = _include(name, place, roots, (*within, shown), loaded)
        included = merge(included, module)
        parts.append(key)
    key = cache.digest("\0".join(parts))
    known = _memory.get(key) or cache.unpickled(cache.read(f"{key}.ir"))
    if not isinstance(known, Module):
        from sssgen.lang.check.module_checker import check
        from sssgen.lang.syntax.parser import parse

        known = check(parse(text, shown), text, included)
        cache.write(f"{key}.ir", cache.pickled(known))
    _memory[key] = known
    _keys[id(known)] = key
    return known, key


def _includes(text: str, shown: str) -> dict[str, Span]:
    """The names that a text includes, each with its first place."""
    found: dict[str, Span] = {}
    for match in _INCLUDE.finditer(text):
        if match.group(1) not in found:
            line = text.count("\n", 0, match.start()) + 1
            column = match.start(1) - text.rfind("\n", 0, match.start(1))
            found[match.group(1)] = Span(shown, line, column, line, column + len(match.group(1)))
    return found


def keep_lines(texts: Mapping[str, str]) -> None:
    """Has the texts of files at hand for what quotes their lines."""
    _lines.update({name: text.split("\n") for name, text in texts.items()})


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


_BEHIND = re.compile(r"\S.*?[ \t]//+[ \t]?(.*\S)[ \t]*$")


def comment_behind(file: str, line: int) -> str:
    """The `//` comment that stands behind the code on a line of a loaded file, without its marks; '' for none."""
    lines = _lines.get(file, [])
    text = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    found = _BEHIND.match(text) if "//" in text and not text.startswith(("//", "*", "/*")) else None
    return found.group(1) if found is not None else ""


def source_line(span: Span) -> str:
    """The line that a span of a loaded file begins on, or ''."""
    lines = _lines.get(span.file, [])
    return lines[span.line - 1] if 0 < span.line <= len(lines) else ""


def read_text(path: str | os.PathLike[str], shown: str) -> str:
    """The text of a source file. Raises SssgenError where it is missing, no file (a pipe, a device), or not text."""
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
    except ValueError:  # a zero byte or half a surrogate in its name
        raise failure("no file can have this name", file=shown) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _no_text("this is not UTF-8 text", data, error.start, shown) from None
    if "\x00" in text:
        raise _no_text("this is not a text file: it holds a zero byte", data, data.index(b"\x00"), shown)
    return text.replace("\r\n", "\n")


def refuse_special(path: str | os.PathLike[str], shown: str) -> None:
    """Raises SssgenError for a pipe, which would wait, and for a device, which may have no end; OSError as `stat`."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise failure("this is not a file", "write what it gives into a file", shown)


def _no_text(message: str, data: bytes, position: int, shown: str) -> SssgenError:
    line = data.count(b"\n", 0, position) + 1
    column = position - data.rfind(b"\n", 0, position)
    return SssgenError([Diagnostic("error", message, Span(shown, line, column, line, column + 1))])


def merge(first: Module, second: Module) -> Module:
    """Both modules' declarations, what both bring (by its place in the source) once."""
    return Module(*(_union(one, two) for one, two in zip(first, second, strict=True)))


def _union(first: tuple, second: tuple) -> tuple:  # type: ignore[type-arg]  # a tuple of any kind of declaration
    known = {declaration.span for declaration in first}
    return first + tuple(declaration for declaration in second if declaration.span not in known)


def _include(
    name: str, place: Span, roots: tuple[str, ...], within: tuple[str, ...], loaded: _Loaded
) -> tuple[Module, str]:
    """The module of an included file, and its hash."""
    line = source_line(place)
    for root in roots:
        path = os.path.join(root, name)
        if os.path.isfile(path):
            if name in within:
                message = f"'{name}' includes itself: {' → '.join((*within, name))}"
                raise SssgenError([Diagnostic("error", message, place, "", line)])
            if len(within) > MAX_INCLUDED:
                message = f"files include files more than {MAX_INCLUDED} deep"
                raise SssgenError([Diagnostic("error", message, place, "include what is needed itself", line)])
            known = loaded.get((path, roots))
            if known is None:
                inner = tuple(dict.fromkeys((os.path.dirname(path), *roots)))
                known = loaded[path, roots] = _load(read_text(path, name), name, inner, within, loaded)
            return known
        note(path)
    hint = "it is looked for beside the file and in the technique library"
    raise SssgenError([Diagnostic("error", f"cannot find '{name}' to include", place, hint, line)])
