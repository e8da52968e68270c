"""Decimal texts of floating-point numbers."""

from __future__ import annotations

import math
from functools import lru_cache

from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.rules import FLOAT_MAX

_SMALLEST = 2.0**-126
"""The smallest normal float32."""


def float_text(value: float, kept: bool = False) -> str:
    """The shortest decimal that reads back to the same float32, always with a point; `kept`: to the same float64."""
    if kept and _SMALLEST <= abs(value) < FLOAT_MAX:
        return _with_point(repr(value))
    if abs(value) > FLOAT_MAX:  # a shorter decimal would exceed the largest float, which WGSL refuses
        value = math.copysign(FLOAT_MAX, value)
    if abs(value) == FLOAT_MAX:
        return "-3.4028234e38" if value < 0.0 else "3.4028234e38"
    if value == 0.0:
        return "-0.0" if math.copysign(1.0, value) < 0.0 else "0.0"
    return shortest(value, FLOAT32)


@lru_cache(4096)
def shortest(value: float, format: Format) -> str:
    """The shortest decimal, always with a point, that reads back to the same number of the format; not for 0."""
    nearest = format.rounded(value)
    for digits in range(1, 10):
        text = f"{nearest:.{digits}g}"
        if format.rounded(float(text)) == nearest:
            break
    exponent = text.partition("e")[2]
    if exponent and -5 < int(exponent) < 8:
        text = f"{float(text):.{max(1, digits - int(exponent) - 1)}f}"
    return _with_point(text)


def _with_point(text: str) -> str:
    mantissa, _, exponent = text.partition("e")
    if "." not in mantissa:
        mantissa += ".0"
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa
