"""Checks before a bake that it fits into memory."""

from __future__ import annotations

from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

SPARE = 0.9
"""The share of the free memory that a bake may use."""


def check(needed: float, advice: str) -> None:
    """Raises SssgenError if `needed` bytes exceed the free memory."""
    free = need("psutil", extra="bake").virtual_memory().available
    if needed > SPARE * free:
        raise failure(f"this needs {_text(needed)} of memory, and {_text(free)} are free", advice)


def _text(size: float) -> str:
    return f"{size / 2**30:.1f} GiB" if size >= 2**30 else f"{size / 2**20:.0f} MiB"
