"""What the reflection says of guards. It imports nothing, as cached programs contain it."""

from __future__ import annotations

from typing import NamedTuple


class GuardReport(NamedTuple):
    """The operations with a domain: proven safe, or guarded."""

    proven: int = 0
    """How many are proven safe."""
    rows: tuple[dict[str, str], ...] = ()
    """Of each that has a guard: its place, its name, what can fail, and the ranges."""
