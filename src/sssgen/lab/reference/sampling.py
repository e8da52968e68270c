"""How many random paths a reference takes, and which."""

from __future__ import annotations

from typing import NamedTuple


class Sampling(NamedTuple):
    """The paths of a reference; the same values give the same numbers."""

    samples: int
    """For each point or ray, rounded up to full batches."""
    seed: int = 0
    scatterings: int = 0
    """Above 0: only light with at most that many scatterings counts."""
