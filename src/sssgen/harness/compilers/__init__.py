"""Compilers that this project did not write, behind one interface.

from sssgen.harness.compilers import Source, check, errors
for name, messages in check(Source(text, language="wgsl", stage="fragment", entry="fragment_main")).items():
    print(name, errors(messages))
"""

from __future__ import annotations

from functools import cache
from importlib import import_module

from sssgen.harness.compiler_registry import COMPILERS, readers
from sssgen.harness.compilers.compiler_interface import (
    Compiler,
    CompilerMissing,
    Message,
    Source,
    Stage,
    errors,
)

__all__ = [
    "COMPILERS",
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
    return [found for found in map(_find, COMPILERS) if isinstance(found, Compiler)]


def missing() -> list[tuple[str, str]]:
    """(name, how to get it) of every compiler that this machine lacks."""
    return [(name, found) for name in COMPILERS if isinstance(found := _find(name), str)]


def get(name: str) -> Compiler:
    """The compiler of that name. Raises CompilerMissing, which says how to get it, where it is not there."""
    found = _find(name)
    if isinstance(found, str):
        raise CompilerMissing(found)
    return found


def check(source: Source) -> dict[str, list[Message]]:
    """What each compiler at hand says of `source`, by the compiler's name."""
    return {c.name: c.check(source) for c in map(_find, readers(source.language)) if isinstance(c, Compiler)}


@cache
def _find(name: str) -> Compiler | str:
    """The compiler of that name, started once a process, or how to get it."""
    try:
        compiler: Compiler = import_module(f"sssgen.harness.compilers.{COMPILERS[name].module}").find()
    except CompilerMissing as reason:
        return str(reason)
    return compiler
