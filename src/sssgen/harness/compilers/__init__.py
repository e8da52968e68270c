"""Compilers that this project did not write, behind one interface.

from sssgen.harness.compilers import Source, check, errors
for name, messages in check(Source(text, language="wgsl", stage="fragment", entry="fragment_main")).items():
    print(name, errors(messages))
"""

from __future__ import annotations

from functools import cache

from sssgen.harness.compilers.compiler_interface import (
    LANGUAGES,
    Compiler,
    CompilerMissing,
    Message,
    Source,
    Stage,
    errors,
)

__all__ = [
    "LANGUAGES",
    "Compiler",
    "CompilerMissing",
    "Message",
    "Source",
    "Stage",
    "available",
    "check",
    "errors",
    "get",
    "missing",
    "readers",
]


def available() -> list[Compiler]:
    """Every compiler that this machine has, started."""
    return [found for found in map(_find, LANGUAGES) if isinstance(found, Compiler)]


def missing() -> list[tuple[str, str]]:
    """(name, how to get it) of every compiler that this machine lacks."""
    return [(name, found) for name in LANGUAGES if isinstance(found := _find(name), str)]


def readers(language: str) -> list[str]:
    """The names of all compilers for `language`, also of those that this machine lacks."""
    return [name for name, languages in LANGUAGES.items() if language in languages]


def get(name: str) -> Compiler:
    """The compiler of that name. Raises CompilerMissing, which says how to get it, where it is not there."""
    found = _find(name)
    if isinstance(found, str):
        raise CompilerMissing(found)
    return found


def check(source: Source) -> dict[str, list[Message]]:
    """What each compiler at hand says of `source`, by the compiler's name."""
    return {c.name: c.check(source) for c in map(_find, readers(source.language)) if isinstance(c, Compiler)}


_MODULES = {"gl": "gl_driver", "python": "python_syntax", "unity": "unity_compiler"}


@cache
def _find(name: str) -> Compiler | str:
    """The compiler of that name, started once a process, or how to get it."""
    from importlib import import_module

    try:
        found: Compiler = import_module(f"sssgen.harness.compilers.{_MODULES.get(name, name)}").find()
    except CompilerMissing as reason:
        return str(reason)
    return found
