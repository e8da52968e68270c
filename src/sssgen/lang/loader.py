"""Loads technique files: follows `#include`, checks, and caches the checked module by content.

The key of a module is the digest of its text, of the modules that it includes, and of the front end itself. A module is
kept in memory and, as IR, in the cache folder.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import Any

from sssgen.ir.nodes import Module, Span
from sssgen.lang.source_lines import keep_lines, source_line
from sssgen.support import cache, unsaved
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.file_memo import note
from sssgen.support.paths import PACKAGE, display_name, source_name
from sssgen.support.text_files import read_text

MAX_INCLUDED = 50
"""How deeply files may include files. The library's own do so two deep."""

MAX_MODULES = 1024
"""The number of modules in memory before the oldest is dropped: a program that runs for days may read many texts."""

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"\n]*)"', re.MULTILINE)

_modules: dict[str, LoadedModule] = {}
"""Key → module; the one used last is at the end."""
_front_end_stamp = ""


class LoadedModule(Module):
    """A module as its source text declares it. The copy that `_replace` makes has no key."""

    key: str = ""


LoadedModules = dict[str, LoadedModule]
"""The files included so far, by their names: a file is read once per load."""


def load_file(path: str | os.PathLike[str], roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a file and of all that it includes.

    `roots` are the folders in which `#include "x"` is looked for, after that of the file with the line. So the module
    of a file does not depend on the files that include it. Raises SssgenError for a missing, unreadable, too large or
    faulty file.
    """
    name = source_name(path)
    return _load(read_text(path, name), name, os.path.dirname(os.path.realpath(path)), _folders(roots), (), {})


def load_text(text: str, name: str, roots: Sequence[str | os.PathLike[str]] = ()) -> Module:
    """The checked module of a source text with this name, which is in no folder; see `load_file`."""
    return _load(text, name, "", _folders(roots), (), {})


def key_of(module: Module) -> str:
    """The key of a loaded module; '' for a module that was not loaded here."""
    return module.key if isinstance(module, LoadedModule) else ""


def merge(first: Module, second: Module) -> Module:
    """The declarations of both modules; a declaration of both, by its place in the source, comes once."""
    return Module(*(_union(*fields) for fields in zip(first, second, strict=True)))


def _union(first: tuple[Any, ...], second: tuple[Any, ...]) -> tuple[Any, ...]:
    spans = {declaration.span for declaration in first}
    return first + tuple(declaration for declaration in second if declaration.span not in spans)


def _folders(roots: Sequence[str | os.PathLike[str]]) -> tuple[str, ...]:
    return tuple([os.fspath(root) for root in roots])


def _load(
    text: str, name: str, folder: str, roots: tuple[str, ...], within: tuple[str, ...], loaded: LoadedModules
) -> LoadedModule:
    """The module of a text in a folder ('' for none). `within` are the files that include it."""
    keep_lines({name: text})
    included, parts = Module(), [_stamp(), name, text]
    for included_name, span in _includes(text, name).items():
        part = _include(included_name, span, folder, roots, (*within, name), loaded)
        included = merge(included, part)
        parts.append(part.key)
    key = cache.digest("\0".join(parts))
    module = _modules.pop(key, None) or _cached_module(text, name, included, key)
    _modules[key] = module
    if len(_modules) > MAX_MODULES:
        _modules.pop(next(iter(_modules)))
    return module


def _cached_module(text: str, name: str, included: Module, key: str) -> LoadedModule:
    """The module with this key, from the cache folder or from its text."""
    module = cache.unpickle(cache.read(f"{key}.ir"))
    if not isinstance(module, Module):
        from sssgen.lang.check.module_checker import check
        from sssgen.lang.syntax.parser import parse

        module = check(parse(text, name), text, included)
        if not unsaved.any_kept():
            cache.write(f"{key}.ir", cache.to_pickle(module))
    loaded = LoadedModule(*module)
    loaded.key = key
    return loaded


def _includes(text: str, file: str) -> dict[str, Span]:
    """The names that a text includes, each with its first place."""
    names: dict[str, Span] = {}
    for match in _INCLUDE.finditer(text):
        if match.group(1) not in names:
            line = text.count("\n", 0, match.start()) + 1
            column = match.start(1) - text.rfind("\n", 0, match.start(1))
            names[match.group(1)] = Span(file, line, column, line, column + len(match.group(1)))
    return names


def _include(
    included: str, span: Span, folder: str, roots: tuple[str, ...], within: tuple[str, ...], loaded: LoadedModules
) -> LoadedModule:
    """The module of a file that one in this folder includes."""
    line = source_line(span)
    for root in (folder, *roots) if folder else roots:
        path = os.path.join(root, included)
        note(path)
        if os.path.isfile(path):
            name = source_name(path)
            if name in within:
                message = f"'{included}' includes itself: {' → '.join(map(display_name, (*within, name)))}"
                raise SssgenError([Diagnostic("error", message, span, "", line)])
            if len(within) > MAX_INCLUDED:
                message = f"files include files more than {MAX_INCLUDED} deep"
                raise SssgenError([Diagnostic("error", message, span, "include what is needed itself", line)])
            if name not in loaded:
                inner = os.path.dirname(os.path.realpath(path))
                loaded[name] = _load(read_text(path, name), name, inner, roots, within, loaded)
            return loaded[name]
    hint = "it is looked for beside the file and in the technique library"
    raise SssgenError([Diagnostic("error", f"cannot find '{included}' to include", span, hint, line)])


def _stamp() -> str:
    """The state of the front end's own sources, so that no result of an older front end is used."""
    global _front_end_stamp
    if not _front_end_stamp:
        _front_end_stamp = repr([cache.stamp(os.path.join(PACKAGE, folder)) for folder in ("lang", "ir")])
    return _front_end_stamp
