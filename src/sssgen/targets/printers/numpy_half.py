"""NumPy with the guards of half precision, which the harness runs on float16; not a target for users."""

from __future__ import annotations

from sssgen.targets.descriptor import Target
from sssgen.targets.registry import load


def target() -> Target:
    """The target `numpy` in half precision."""
    double = load("numpy")
    return double._replace(name="numpy-f16", title="NumPy in half precision", half_of=double.name)
