"""Reads in advance what the first explanation or completion would wait for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from sssgen.material import library
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import builtin_facts, registry


def prepare() -> Iterator[None]:
    """Reads the targets and the library, a file at each step, of which none takes longer than a keystroke's errors."""
    for target in registry.names():
        with suppress(SssgenError):
            registry.load(target)
        yield
    builtin_facts.describe("clamp")
    yield
    for name in library.index():
        with suppress(SssgenError):
            library.load(name)
        yield
