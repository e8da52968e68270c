"""The floating-point formats of shaders, with the limits that value ranges and guards need."""

from __future__ import annotations

import struct
from typing import NamedTuple


class Format(NamedTuple):
    """A binary format of IEEE 754 without subnormal numbers, as GPUs may flush them to 0."""

    name: str
    code: str
    """Its format character for `struct`."""
    largest: float
    tiny: float
    """The lower limit of guards for positive arguments, near the smallest normal number."""
    divisor: float
    """The smallest divisor behind a guard: small compared with values of scenes, its inverse far below `largest`."""
    square: float
    """The smallest squared length that normalize divides by: the squares of the components are still normal."""
    epsilon: float
    """The distance from 1 to the next number."""
    exponent: float
    """The largest argument of exp2: the result is finite, with a margin for its error."""

    def rounded(self, value: float) -> float:
        """The nearest number of the format; beyond the largest, infinity."""
        try:
            nearest: float = struct.unpack(self.code, struct.pack(self.code, value))[0]
        except OverflowError:
            return float("inf") if value > 0.0 else float("-inf")
        return nearest


def _format(format: Format) -> Format:
    """A format with its limits rounded to its own numbers."""
    return format._replace(
        tiny=format.rounded(format.tiny), divisor=format.rounded(format.divisor), square=format.rounded(format.square)
    )


FLOAT32 = _format(Format("float", "f", 2.0**128 - 2.0**104, 1e-37, 1e-20, 1e-30, 2.0**-23, 126.0))
FLOAT16 = _format(Format("half", "e", 65504.0, 1e-4, 1e-4, 1e-3, 2.0**-10, 15.0))
