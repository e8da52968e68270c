"""The floating-point formats that a shader computes in, as far as value ranges and guards need to know them."""

from __future__ import annotations

import struct
from typing import NamedTuple


class Format(NamedTuple):
    """A binary format of IEEE 754. GPUs may flush its subnormal numbers to 0, so it has none here."""

    name: str
    code: str
    """Its letter for `struct`."""
    largest: float
    tiny: float
    """Near the smallest normal number: what guards keep arguments from falling below."""
    divisor: float
    """The smallest divisor that guards let through: small against what scenes hold, its inverse far from largest."""
    square: float
    """The smallest square of a length whose parts are not lost: normalize's divisor."""
    epsilon: float
    """The distance from 1 to the next number."""
    exponent: float
    """exp2 of this is still finite, with room for its error."""

    def rounded(self, value: float) -> float:
        """The nearest number of the format; beyond the largest, infinity."""
        try:
            found: float = struct.unpack(self.code, struct.pack(self.code, value))[0]
        except OverflowError:
            return float("inf") if value > 0.0 else float("-inf")
        return found


def _format(format: Format) -> Format:
    """A format, with its limits as numbers of its own."""
    return format._replace(
        tiny=format.rounded(format.tiny), divisor=format.rounded(format.divisor), square=format.rounded(format.square)
    )


FLOAT32 = _format(Format("float", "f", 2.0**128 - 2.0**104, 1e-37, 1e-20, 1e-30, 2.0**-23, 126.0))
FLOAT16 = _format(Format("half", "e", 65504.0, 1e-4, 1e-4, 1e-3, 2.0**-10, 15.0))
