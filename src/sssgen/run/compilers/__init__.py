"""Compilers that this project did not write, behind one interface.

from sssgen.run.compilers import Source, check, errors
for name, messages in check(Source(text, language="wgsl", stage="fragment", entry="fragment_main")).items():
    print(name, errors(messages))
"""

from __future__ import annotations

from functools import cache
from importlib import import_module

from sssgen.run.compiler_registry import COMPILERS, readers
from sssgen.run.compilers.compiler_interface import (
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
    return [compiler for compiler in map(_find, COMPILERS) if isinstance(compiler, Compiler)]


def missing() -> list[tuple[str, str]]:
    """(name, how to get it) of every compiler that this machine lacks."""
    return [(name, reason) for name in COMPILERS if isinstance(reason := _find(name), str)]


def get(name: str) -> Compiler:
    """The compiler of that name. Raises CompilerMissing, which states how to get it, where it is missing."""
    compiler = _find(name)
    if isinstance(compiler, str):
        raise CompilerMissing(compiler)
    return compiler


def check(source: Source) -> dict[str, list[Message]]:
    """The messages of each available compiler about `source`, by its name."""
    return {c.name: c.check(source) for c in map(_find, readers(source.language)) if isinstance(c, Compiler)}


@cache
def _find(name: str) -> Compiler | str:
    """The compiler of that name, started once a process, or how to get it."""
    try:
        compiler: Compiler = import_module(f"sssgen.run.compilers.{COMPILERS[name].module}").find()
    except CompilerMissing as reason:
        return str(reason)
    return compiler
