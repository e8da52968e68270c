"""The ranges of the builtins' results: evaluates what the intrinsic table says of them.

Most rows speak of one component; those with `whole:` take vectors and matrices as they are and are computed here.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from functools import cache
from types import CodeType
from typing import Any

from sssgen.ir import intervals
from sssgen.ir.contracts import LENGTH, Contract
from sssgen.ir.formats import Format
from sssgen.ir.intervals import ANY, INF, Range, absolute, hull, widened
from sssgen.ir.intrinsics import BUILTINS
from sssgen.passes.ranges import vector_ranges as vectors
from sssgen.passes.ranges.vector_ranges import Value, length_of

Whole = tuple[list[Range], Range]
"""Components, and the length of the vector."""
Ordered = Callable[[Range, Range], bool]


@cache
def _compiled(text: str) -> CodeType:
    return compile(text, "<intrinsic table>", "eval")


_SCOPE: dict[str, Any] = {name: getattr(intervals, name) for name in (
    "absolute", "blend", "clip", "falling", "fraction", "hull", "maximum", "minimum", "power", "remainder", "rising",
    "signs", "truncated",
)} | {"math": math}  # fmt: skip


def evaluated(text: str, format: Format, args: Sequence[Range], ordered: Ordered | None = None) -> Any:
    """A text of the table, over ranges: those of x, y and z."""
    x, y, z = (*args, None, None, None)[:3]
    return eval(_compiled(text), _SCOPE, {"F": format, "x": x, "y": y, "z": z, "ordered": ordered})


def result(name: str, args: tuple[Value, ...], size: int, format: Format) -> Whole:
    """The components of a builtin's result, not yet rounded, and its length (ANY: what the components say)."""
    text = BUILTINS[name].range
    if text.startswith("whole:"):
        parts, length = _WHOLE[text.removeprefix("whole: ").partition("(")[0]](format, *args)
        return parts[:size], length
    if not text:
        return [ANY] * size, ANY
    error = _ERRORS.get(name)
    parts = []
    for index in range(size):
        at = [arg.parts[index if len(arg.parts) > 1 else 0] if arg.parts else ANY for arg in args]  # a texture has none
        part = evaluated(text, format, at)
        parts.append(part if error is None else error(part, format, *at))
    return parts, ANY


# What the ends and rounding add to the componentwise rows that are formulas


def _scaled(part: Range, format: Format, *_: Range) -> Range:
    return widened(part, 2.0 * format.epsilon)


def _blended(part: Range, format: Format, x: Range, y: Range, z: Range) -> Range:
    """By x·(1 - z) + y·z, or by x + (y - x)·z as HLSL has it: result and error have their ends at the corners.

    Between two numbers of one sign the sign stays, and so does a power of two as the largest of them.
    """
    most = max(x.size, y.size)
    if most == INF or z.size == INF:
        return ANY
    low, high = INF, -INF
    for a, b, c in itertools.product((x.low, x.high), (y.low, y.high), (z.low, z.high)):
        found = a * (1.0 - c) + b * c
        error = 2.0 * format.epsilon * (abs((b - a) * c) + abs(a * (1.0 - c)) + abs(b * c))
        low, high = min(low, found - error), max(high, found + error)
    if z.low < 0.0 or z.high > 1.0:
        return Range(low, high)
    bound = most if math.frexp(most)[0] == 0.5 else INF
    if part.low >= 0.0:
        return Range(max(low, 0.0), min(high, bound))
    if part.high <= 0.0:
        return Range(max(low, -bound), min(high, 0.0))
    return Range(low, high)


def _raised(part: Range, _: Format, x: Range, __: Range) -> Range:
    """0 to a power is 0."""
    return part if x.low > 0.0 else Range(0.0, part.high)


def _wrapped(part: Range, format: Format, x: Range, y: Range) -> Range:
    """x/y may round to the next integer, but for a power of two y; and it may overflow."""
    if x.size > 1e30 * y.gap:
        return ANY
    exact = y.low == y.high and abs(math.frexp(y.low)[0]) == 0.5
    apart = max(x.high, y.high) > 0.0 > min(x.low, y.low)
    # a quotient below 0 that is flushed to 0 leaves x as it is
    flushed = format.tiny * y.size if apart and not (exact and y.size <= 1.0) else 0.0
    return widened(part, 0.0, (0.0 if exact else 4.0 * format.epsilon * x.size) + flushed)


def _near_one(part: Range, format: Format, x: Range) -> Range:
    """There is a number between 1 - epsilon and 1."""
    return widened(part, 0.0, 0.35) if x.size > 1.0 - format.epsilon else part


_ERRORS: dict[str, Callable[..., Range]] = {
    "radians": _scaled, "degrees": _scaled, "mix": _blended, "mod": _wrapped, "fmod": _wrapped, "pow": _raised,
    "atanh": _near_one,
}  # fmt: skip


# The rows after `whole:`


def _slack(format: Format) -> float:
    """The error of a sum of up to four products, as a part of the size of its terms."""
    return 8.0 * format.epsilon


def _length(format: Format, x: Value, y: Value | None = None) -> Whole:
    found = x.length
    if y is not None:
        parts = tuple([a - b for a, b in zip(x.parts, y.parts, strict=True)])
        # each component of the difference rounds
        size = _slack(format) * (x.length.high + y.length.high)
        found = widened(
            length_of(parts).met(vectors.total_length(x.length, y.length)), 0.0, size if size < INF else 0.0
        )
        found = Range(max(found.low, 0.0), found.high)
    # the squares in it overflow, or are too small
    low = found.low if found.low > format.tiny**0.5 else 0.0
    high = found.high if found.high < format.largest**0.5 else INF
    return [widened(Range(low, high), _slack(format))], ANY


def _dot(format: Format, x: Value, y: Value) -> Whole:
    total, slack = vectors.dot(x, y), _slack(format)
    if x.numbers == y.numbers:
        return [widened(total, slack)], ANY
    products = [a * b for a, b in zip(x.parts, y.parts, strict=True)]
    if all(part.low >= 0.0 for part in products) or len(products) == 1:
        return [widened(total, slack)], ANY
    size = min(sum(part.size for part in products), x.length.high * y.length.high if x.length.high else 0.0)
    return [widened(total, 0.0, slack * size + format.tiny) if size < INF else ANY], ANY


def _cross(format: Format, x: Value, y: Value) -> Whole:
    parts, length = vectors.cross(x, y)
    if length.high == INF:
        return parts, length
    size = _slack(format) * length.high + format.tiny
    return [widened(part, 0.0, size) for part in parts], widened(length, _slack(format))


def _unit(format: Format, x: Value) -> Whole:
    slack = 2.0 * _slack(format)
    # beyond these limits it is the guard's direction, which may be shorter
    sure = x.length.low > format.square**0.5 and x.length.high < format.largest**0.5
    least = x.length.low if sure else 0.0
    parts = []
    for part in x.parts:
        low = max(part.low / least, -1.0) if least > 0.0 else -1.0
        high = min(part.high / least, 1.0) if least > 0.0 else 1.0
        low, high = (low if part.low < 0.0 else 0.0), (high if part.high > 0.0 else 0.0)
        parts.append(widened(Range(low, high), slack))
    return parts, Range(1.0 - slack if sure else 0.0, 1.0 + slack)


def _turned(_: Format, x: Value, *__: Value) -> Whole:
    return [part.joined(-part) for part in x.parts], x.length


def _reflected(format: Format, x: Value, y: Value) -> Whole:
    factor = vectors.dot(y, x) * 2.0
    parts = [a - factor * b for a, b in zip(x.parts, y.parts, strict=True)]
    slack = 2.0 * _slack(format)
    if INF in (x.length.high, y.length.high):
        return [ANY for _ in parts], ANY
    whole = x.length.high * (1.0 + 2.0 * y.length.high * y.length.high)
    most = x.length.high if y.length.high <= 1.0 + slack else whole
    error = slack * whole + format.tiny
    return [widened(part.met(hull(-most, most)), 0.0, error) for part in parts], hull(0.0, most + 2.0 * error)


def _refracted(format: Format, x: Value, y: Value, z: Value) -> Whole:
    eta = absolute(z.parts[0]).high
    cosine = absolute(vectors.dot(y, x)).high
    if not eta * cosine < format.largest**0.5 or x.length.high == INF or y.length.high == INF:
        return [ANY for _ in x.parts], ANY  # its square overflows
    root = math.sqrt(1.0 + eta * eta * cosine * cosine)
    most = eta * x.length.high + (eta * cosine + root) * y.length.high
    if eta <= 1.0 and x.length.high <= LENGTH and y.length.high <= LENGTH:
        most = min(most, 2.3)
    most *= 1.0 + 4.0 * _slack(format)
    return [hull(-most, most) for _ in x.parts], hull(0.0, most * 2.0)


def _outer(_: Format, x: Value, y: Value) -> Whole:
    return [a * b for b in y.parts for a in x.parts], ANY


def _transposed(_: Format, x: Value) -> Whole:
    size = math.isqrt(len(x.parts))
    return [x.parts[column * size + row] for row in range(size) for column in range(size)], ANY


def _determinant(format: Format, x: Value) -> Whole:
    size = math.isqrt(len(x.parts))
    largest = max(part.size for part in x.parts)
    most = math.factorial(size) * largest**size if largest < 1e60 else INF
    return [widened(hull(-most, most), 4.0 * _slack(format))], ANY


def _normal_texel(_: Format, x: Value) -> Whole:
    return [part * 2.0 - 1.0 for part in x.parts[:3]], ANY


def _texels(_: Format, x: Value, *__: Value) -> Whole:
    texel = x.texel or Contract(0.0, 1.0)
    return [hull(texel.low, texel.high)] * 4, ANY


_WHOLE: dict[str, Callable[..., Whole]] = {
    "length": _length, "dot": _dot, "cross": _cross, "unit": _unit, "turned": _turned, "reflected": _reflected,
    "refracted": _refracted, "outer": _outer, "transposed": _transposed, "determinant": _determinant,
    "normal_texel": _normal_texel, "texels": _texels,
}  # fmt: skip
