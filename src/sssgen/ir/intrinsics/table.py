"""What a row of the intrinsic table is, and what rows share."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from sssgen.ir.formats import Format


class Guard(NamedTuple):
    """What arguments must keep to, and what stands in the call's place where the range pass cannot prove it."""

    needs: str
    """Python over the ranges (`passes.intervals`) x, y, z of the arguments (lengths, of vectors that a builtin takes
    whole) and the format F; true where nothing can go wrong."""
    says: str
    """What goes wrong otherwise, for people."""
    text: str
    """An expression of the language in x, y, z, or a function's body, with the constants TINY (smallest normal number),
    DIVISOR, SQUARE, EPSILON, EXPONENT (the largest of exp2), LARGEST and ROOT (its square root). '' means that it is the
    polyfill with its own divisions guarded."""
    replaces: str = ""
    """The argument that `text` stands for; `result`: the call's own, x in it; '' means the whole call."""
    scalar: str = ""
    """The text for a single number, where that reads better."""
    doc: str = ""
    """The comment of the function that it becomes where it is too long to stand in the text."""


def with_constants(text: str, format: Format, limits: tuple[float, float], shown: Callable[[float], str] = repr) -> str:
    """A guard's text with the format's numbers for its constants, times the factor that stands before one.

    LOW and HIGH are the `limits` of the place, LAST the upper one as an int.
    """
    numbers = {
        "TINY": format.tiny, "DIVISOR": format.divisor, "SQUARE": format.square, "EPSILON": format.epsilon,
        "EXPONENT": format.exponent, "LARGEST": format.largest, "ROOT": format.largest**0.5,
        "LOW": limits[0], "HIGH": limits[1],
    }  # fmt: skip

    def number(found: re.Match[str]) -> str:
        factor, name = found.groups()
        return str(int(limits[1])) if name == "LAST" else shown(float(factor or 1.0) * numbers[name])

    return re.sub(rf"(?:([\d.]+) \* )?\b({'|'.join(numbers)}|LAST)\b", number, text)


class Builtin(NamedTuple):
    """One row of the table."""

    name: str
    signatures: tuple[str, ...]
    doc: str
    domain: str = ""
    """Where the result is defined, with x, y, z for the arguments in their order; '' means everywhere."""
    range: str = ""
    """The range of a component of the result, as Python over those of the arguments' components (`passes.intervals`);
    after `whole:`, of the result from the whole arguments (`passes.builtin_ranges`); '' means any number."""
    guards: tuple[Guard, ...] = ()
    """Where it may give inf or NaN, or what languages leave undefined; the first one needed is put in."""
    inside: str = ""
    """The domain as Python, for each component, over the functions of the NumPy runtime; '' means every finite number.
    It is where the parity is measured, and so leaves out where intermediate results overflow or underflow."""
    size: str = ""
    """What the error is measured in ulp of, as Python: the size of terms that may cancel; '' means the result."""
    texts: Mapping[str, str] = MappingProxyType({})
    polyfill: str = ""
    constant: tuple[int, ...] = ()
    """The positions of arguments that must be constant expressions."""
    splat: tuple[str, ...] = ("wgsl",)
    """Languages in which a scalar beside vectors must be widened to a vector first."""
    kind: str = "alu"
    """What it costs: alu, transcendental, fetch or derivative."""
    cost: int = 1
    """Operations per component, for the static cost."""
    once: int = 0
    """Operations beside these, once a call: the one root of a length."""
    ulp: float = 4.0
    """The float32 error allowed against the float64 oracle, in units in the last place of the result's magnitude."""
    absolute: float = 0.0
    """The absolute error allowed instead, where that is larger."""
    clause: str = ""
    """Where a specification allows more than 4 ulp: which, and what it says."""
    vectors: tuple[tuple[tuple[object, ...], object], ...] = ()
    """At least three test vectors: (arguments, result); vectors are tuples, matrices tuples of columns."""


NONZERO = "max(abs(y), DIVISOR) * (2.0 * step(0.0, y) - 1.0)"
"""A divisor of the same sign (0 counts as positive) that is not 0."""
FINITE = "mix(clamp(x, -LARGEST, LARGEST), genF(0.0), isnan(x))"
"""The largest number in place of infinity, 0 in place of NaN."""


F1 = ("genF(genF)",)
F2 = ("genF(genF, genF)",)
NAN, INF = float("nan"), float("inf")
HALF_PI, PI = 1.5707963267948966, 3.141592653589793
