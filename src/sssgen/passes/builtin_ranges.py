"""The ranges of the builtins' results: evaluates what the intrinsic table says of them.

Most rows speak of one component; those with `whole:` take vectors and matrices as they are and are computed here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from types import CodeType
from typing import Any

from ..ir.contracts import LENGTH, Contract
from ..ir.formats import Format
from ..ir.intrinsics import BUILTINS
from . import intervals, vectors
from .intervals import ANY, Range, absolute, hull, widened
from .vectors import Value, length_of

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
        return _WHOLE[text.removeprefix("whole: ").partition("(")[0]](*args)
    if not text:
        return [ANY] * size, ANY
    parts = []
    for index in range(size):
        at = [arg.parts[index if len(arg.parts) > 1 else 0] for arg in args]
        parts.append(evaluated(text, format, at))
    return parts, ANY


def _length(x: Value, y: Value | None = None) -> Whole:
    if y is None:
        return [x.length], ANY
    parts = tuple([a - b for a, b in zip(x.parts, y.parts, strict=True)])
    apart = length_of(parts).met(vectors.total_length(x.length, y.length))
    return [widened(apart, 1e-6)], ANY


def _dot(x: Value, y: Value) -> Whole:
    return [widened(vectors.dot(x, y), 1e-6)], ANY


def _cross(x: Value, y: Value) -> Whole:
    parts, length = vectors.cross(x, y)
    return [widened(part, 1e-6) for part in parts], widened(length, 1e-6)


def _unit(x: Value) -> Whole:
    least = x.length.low
    parts = []
    for part in x.parts:
        low = max(part.low / least, -1.0) if least > 0.0 else (-1.0 if part.low < 0.0 else 0.0)
        high = min(part.high / least, 1.0) if least > 0.0 else (1.0 if part.high > 0.0 else 0.0)
        parts.append(widened(Range(low, high), 2e-6))
    return parts, Range(1.0 - 2e-6 if least > 0.0 else 0.0, 1.0 + 2e-6)


def _turned(x: Value, *_: Value) -> Whole:
    return [part.joined(-part) for part in x.parts], x.length


def _reflected(x: Value, y: Value) -> Whole:
    factor = vectors.dot(y, x) * 2.0
    parts = [a - factor * b for a, b in zip(x.parts, y.parts, strict=True)]
    most = x.length.high * (1.0 + 2.0 * y.length.high * y.length.high)
    if y.length.high <= 1.0 + 2e-6:
        most = x.length.high
    return [widened(part.met(hull(-most, most)), 1e-5) for part in parts], widened(hull(0.0, most), 1e-5)


def _refracted(x: Value, y: Value, z: Value) -> Whole:
    eta = absolute(z.parts[0]).high
    cosine = absolute(vectors.dot(y, x)).high
    root = math.sqrt(1.0 + eta * eta * cosine * cosine)
    most = eta * x.length.high + (eta * cosine + root) * y.length.high
    if eta <= 1.0 and x.length.high <= LENGTH and y.length.high <= LENGTH:
        most = min(most, 2.3)
    return [hull(-most, most) for _ in x.parts], hull(0.0, most)


def _outer(x: Value, y: Value) -> Whole:
    return [a * b for b in y.parts for a in x.parts], ANY


def _transposed(x: Value) -> Whole:
    size = math.isqrt(len(x.parts))
    return [x.parts[column * size + row] for row in range(size) for column in range(size)], ANY


def _determinant(x: Value) -> Whole:
    size = math.isqrt(len(x.parts))
    most = math.factorial(size) * max(part.size for part in x.parts) ** size
    return [hull(-most, most)], ANY


def _normal_texel(x: Value) -> Whole:
    return [part * 2.0 - 1.0 for part in x.parts[:3]], ANY


def _texels(x: Value, *_: Value) -> Whole:
    texel = x.texel or Contract(0.0, 1.0)
    return [hull(texel.low, texel.high)] * 4, ANY


_WHOLE: dict[str, Callable[..., Whole]] = {
    "length": _length, "dot": _dot, "cross": _cross, "unit": _unit, "turned": _turned, "reflected": _reflected,
    "refracted": _refracted, "outer": _outer, "transposed": _transposed, "determinant": _determinant,
    "normal_texel": _normal_texel, "texels": _texels,
}  # fmt: skip
