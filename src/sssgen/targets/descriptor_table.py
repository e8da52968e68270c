"""The contents of descriptor files, as tables: the TOML, its word lists, and what it inherits.

`extends = "NAME"` names the base: a descriptor in the same folder, one of the project's (`targets/NAME.toml`), or that
of a plug-in's target. Sections are merged key by key; the extending file's keys win, and a list replaces that of the
base.
`words = "FILE"` names a file of word lists, beside the descriptor or in `targets`: a line `[names.reserved]` begins the
list of that key, `#` a comment.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping, Sequence
from typing import Any

from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean, failure
from sssgen.support.paths import place, posix, stem
from sssgen.targets import plugins

OWN_KEYS = ("name", "title", "also")
"""What no descriptor inherits."""
WHOLE_SECTIONS = ("files", "stage_builtins", "variants")
"""Sections that replace those of the base as a whole."""
SECTIONS_OF_PLACES = ("frame", "surface", "absent")
"""Sections of which each place replaces that of the base as a whole."""


def table_of(path: str) -> dict[str, Any]:
    """The contents of a descriptor, with those that it inherits. Raises SssgenError where a file cannot be read, for an
    unknown base, and for a cycle of bases."""
    result: dict[str, Any] = {}
    for table in reversed(_chain(path).values()):
        result = _merged({key: value for key, value in result.items() if key not in OWN_KEYS}, table)
    result.pop("extends", None)
    return result


def error_at(path: str, keys: Sequence[str], message: str, hint: str = "") -> SssgenError:
    """The error about a key of the descriptor at `path`, in this file or in the base that has it; `keys` lead to it.

    A key of a word list, which has no place, is an error in the descriptor.
    """
    errors = (error_in(file, keys, message, hint) for file in _chain(path))
    return next(filter(None, errors), None) or failure(message, hint, posix(path))


def error_in(path: str, keys: Sequence[str], message: str, hint: str = "") -> SssgenError | None:
    """The error about a key of the descriptor file at `path`; None where this file does not have the key."""
    from sssgen.support.toml_source import parse

    with open(path, encoding="utf-8") as file:
        document = parse(file.read(), posix(path))
    place = document.find(keys)
    if place is None:
        return None
    return SssgenError([Diagnostic("error", message, place.key, hint, document.reporter.line(place.key))])


def _chain(path: str) -> dict[str, dict[str, Any]]:
    """The contents of a descriptor and of its bases, by path."""
    own = _contents(path)
    chain = {os.path.abspath(path): own}
    base = _base(path, own)
    while base:
        if base in chain:
            names = " → ".join(map(stem, (*list(chain)[list(chain).index(base) :], base)))
            message = f"the target descriptor extends itself: {names}"
            raise failure(message, "extend another target in one of these files", posix(path))
        chain[base] = _inherited_contents(base)
        base = _base(base, chain[base])
    return chain


def _base(path: str, table: Mapping[str, Any]) -> str:
    """The absolute path of the descriptor that this one extends, or ''."""
    name = table.get("extends", "")
    file = posix(path)
    if not isinstance(name, str):
        raise failure("the target descriptor needs a text for 'extends'", file=file)
    if not name:
        return ""
    candidate = _beside(path, f"{name}.toml")
    if os.path.isfile(candidate):
        return candidate
    if name in plugins.entries() and isinstance(loaded := plugins.load(name), str):
        return os.path.abspath(loaded)
    own = [stem(entry) for entry in os.listdir(place("targets")) if entry.endswith(".toml")]
    bases = sorted({*own, *plugins.entries()})
    hint = did_you_mean(name, bases) or f"a descriptor in its folder, or one of these targets: {', '.join(bases)}"
    raise failure(f"the target descriptor extends '{name}', which is unknown", hint, file)


def _beside(path: str, name: str) -> str:
    """The absolute path of a file that a descriptor names: in its folder if it is there, else in `targets`."""
    own = os.path.join(os.path.dirname(path), name)
    return os.path.abspath(own if os.path.isfile(own) else os.path.join(place("targets"), name))


def _merged(base: Mapping[str, Any], table: Mapping[str, Any]) -> dict[str, Any]:
    """The base with the keys of the table, section by section."""
    both = [key for key, value in table.items() if isinstance(value, dict) and isinstance(base.get(key), dict)]
    sections = {
        key: {**base[key], **table[key]} if key in SECTIONS_OF_PLACES else _merged(base[key], table[key])
        for key in both
        if key not in WHOLE_SECTIONS
    }
    return {**base, **table, **sections}


def _contents(path: str) -> dict[str, Any]:
    """What one descriptor file and its word lists contain."""
    import tomllib

    file = posix(path)
    try:
        with open(path, encoding="utf-8") as opened:
            text = opened.read()
        table = tomllib.loads(text)
        words = table.pop("words", "")
        if not isinstance(words, str):
            raise failure("the target descriptor needs a text for 'words'", file=file)
        return _merged(_word_lists(_beside(path, words)), table) if words else table
    except tomllib.TOMLDecodeError:
        from sssgen.support.toml_source import parse

        parse(text, file)  # raises the errors with their places
        raise
    except (OSError, ValueError) as error:
        raise failure(f"cannot read the target descriptor: {error}", file=file) from None


_inherited_contents = functools.cache(_contents)
"""The same of a base, which several descriptors extend."""


def _word_lists(path: str) -> dict[str, dict[str, list[str]]]:
    """The lists of a file of words, by section and key. Raises OSError, and SssgenError for a word before all lists."""
    lists: dict[str, dict[str, list[str]]] = {}
    words = None
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            text = line.partition("#")[0].strip()
            if text.startswith("["):
                section, _, key = text.strip("[]").partition(".")
                words = lists.setdefault(section, {}).setdefault(key, [])
            elif text and words is None:
                message = f"line {number} has words before the first list"
                raise failure(message, "begin it with a line such as [names.reserved]", posix(path))
            elif words is not None:
                words.extend(text.split())
    return lists
