"""How much is fuzzed: a little, always the same, in a test run; with FUZZ_EXAMPLES set that many, each time others."""

from __future__ import annotations

import os
from collections import Counter

from hypothesis import HealthCheck, Phase, settings

LONG = bool(os.environ.get("FUZZ_EXAMPLES"))
"""Whether this is a long run."""

COUNTED: Counter[str] = Counter()
"""What has been tried, by kind."""


def examples(few: int, share: float = 1.0, shrink: bool = True) -> settings:
    """`few` examples in a test run; in a long one `share` of FUZZ_EXAMPLES."""
    return settings(
        max_examples=max(1, round(int(os.environ["FUZZ_EXAMPLES"]) * share)) if LONG else few,
        derandomize=not LONG,
        deadline=None,  # the watchdog reports the input
        suppress_health_check=list(HealthCheck),
        phases=[Phase.generate, *([Phase.shrink] if shrink else [])],
        database=None,
        print_blob=True,
    )
