"""The examples as cases of tests: in `make test` a part of those that are alike, in `make test-long` all."""

from __future__ import annotations

from typing import Any

import pytest

from sssgen.material.material_loading import examples

ALIKE = ("jelly", "candle", "ice_body", "leaves", "skin_ear", "soap", "milk_glass")
"""Examples whose chains march through a distance function, or that have techniques of their own."""


def example_cases(*expensive: str) -> list[Any]:
    """The names of all examples; the expensive ones are slow, and of those that are alike all but one."""
    slow = [pytest.mark.slow]
    return [pytest.param(name, marks=slow if name in expensive else marks(name)) for name in examples()]


def marks(name: str) -> list[pytest.MarkDecorator]:
    """The marks of an example: all but the first of those that are alike are slow."""
    return [pytest.mark.slow] if name in ALIKE[1:] else []
