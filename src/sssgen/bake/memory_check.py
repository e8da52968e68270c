"""Whether there is room for what is to be baked, told before the work starts."""

from __future__ import annotations

from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

SPARE = 0.9
"""The share of the free memory that a bake may take."""


def check(wanted: float, advice: str) -> None:
    """Raises SssgenError where so many bytes are more than are free."""
    free = need("psutil", extra="bake").virtual_memory().available
    if wanted > SPARE * free:
        raise failure(f"this needs {_told(wanted)} of memory, and {_told(free)} are free", advice)


def _told(size: float) -> str:
    return f"{size / 2**30:.1f} GiB" if size >= 2**30 else f"{size / 2**20:.0f} MiB"
