"""Arithmetic on constants, for `fold`: values as every target has them, or None where a target may differ.

Floats are float32: operands are rounded to it, the result is computed in float64 and rounded once. Nothing
gives inf, NaN or a denormal (which GPUs may flush to 0), nothing divides by zero. Ints and uints are of 32
bits and wrap. Builtins are computed by `fold` of the intrinsic table, within their domains.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from struct import Struct

from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import Range
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Matrix, Type, components, kind_of

Number = float | int | bool
Numbers = tuple[Number, ...]
"""The components of a scalar or vector."""

_FLOAT32 = Struct("f")
_SMALLEST = 2.0**-126
_LARGEST = 2.0**128 - 2.0**104


def float32(value: float) -> float | None:
    """A float64 rounded to float32; None where that is not finite, or denormal."""
    return _nearest(value) if value else float(value)  # 0.0 and -0.0 would be one key


@lru_cache(4096)
def _nearest(value: float) -> float | None:
    """The same, of a number that is not 0: most literals of a text are the same few."""
    try:
        result: float = _FLOAT32.unpack(_FLOAT32.pack(value))[0]
    except OverflowError:
        return None
    if not math.isfinite(result) or abs(result) < _SMALLEST:
        return None
    return result


def wrapped(value: int, kind: str) -> int:
    """An integer brought into the 32 bits of an int or uint."""
    value &= 0xFFFFFFFF
    return value - (1 << 32) if kind == "int" and value > 0x7FFFFFFF else value


def converted(value: Number, kind: str) -> Number | None:
    """`float(value)`, `int(value)`… None where it does not fit."""
    if kind == "bool":
        return bool(value)
    if kind == "float":
        return float32(float(value))
    if isinstance(value, float):
        integer = int(value)
        return integer if integer == wrapped(integer, kind) else None
    return wrapped(int(value), kind)


def binary(op: str, left: Numbers, right: Numbers, kind: str) -> Numbers | None:
    """`left op right`, componentwise, of operands of one kind. Not for matrices."""
    if op in _COMPARISONS:
        if op in ("==", "!="):
            return ((left == right) == (op == "=="),)
        return (_COMPARISONS[op](left[0], right[0]),)
    table = {"float": _FLOAT, "bool": _BOOL}.get(kind, _INTEGER)
    compute = table.get(op)
    return _each(compute, (left, right), kind) if compute is not None else None


def unbounded(op: str, left: Numbers, right: Numbers) -> list[Number] | None:
    """`left op right` of integers, as if they had any number of bits."""
    try:
        return [_INTEGER[op](*parts) for parts in _by_component((left, right))]
    except ArithmeticError:
        return None


def unary(op: str, value: Numbers, kind: str) -> Numbers | None:
    """`op value`."""
    if op == "!":
        return tuple([not component for component in value])
    if kind == "float":
        return tuple([-component for component in value]) if op == "-" else None
    return tuple([wrapped(-int(component) if op == "-" else ~int(component), kind) for component in value])


def builtin(name: str, args: Sequence[Numbers], types: Sequence[Type], result: Type) -> Numbers | None:
    """A builtin of constant arguments; None where it is not folded, or the arguments are outside of its domain."""
    try:
        values = _values(name, args, types, kind_of(result))
    except (ArithmeticError, ValueError):
        return None
    result_values = _rounded(values, kind_of(result)) if values is not None else None
    return result_values if result_values is not None and len(result_values) == components(result) else None


def outside(name: str, args: Sequence[Numbers], types: Sequence[Type], result: Type) -> bool:
    """Whether constant arguments lie outside a builtin's domain, or its result outside the floats."""
    try:
        return any(not abs(value) <= _LARGEST for value in _values(name, args, types, kind_of(result)) or ())
    except (ArithmeticError, ValueError):
        return True


def reason(name: str, args: Sequence[Numbers], kind: str) -> str:
    """Why a builtin of constants that are `outside` has no value: what its row says, or an overflow."""
    row = BUILTINS[name]
    points = list(_by_component(args)) if row.componentwise else [tuple([math.hypot(*arg) for arg in args])]
    shown = (
        [", ".join(map(_spelled, point)) for point in points] if row.componentwise else [", ".join(map(_whole, args))]
    )
    for point, text in zip(points, shown, strict=True):
        ranges = [Range(float(value), float(value)) for value in point]
        # the last guard of a row with several is that of the domain; an overflow matters inside of it
        for guard in reversed(row.guards):
            if (guard.replaces != "y" or len(args) > 1) and guard.safe and not guard.safe(FLOAT32, *ranges):
                return f"{name}({text}) has no value: {guard.problem}"
    if kind != "float":  # integers wrap
        return f"{name}({shown[0] if len(shown) == 1 else '…'}) has no value: it needs {row.domain}"
    return f"the value of {name}({shown[0] if len(shown) == 1 else '…'}) is too large for a float"


def _spelled(value: Number) -> str:
    text = f"{value:g}" if isinstance(value, float) else str(value)
    return f"{text}.0" if isinstance(value, float) and text.lstrip("-").isdigit() else text


def _whole(value: Numbers) -> str:
    text = ", ".join(map(_spelled, value))
    return text if len(value) == 1 else f"({text})"


def _values(name: str, args: Sequence[Numbers], types: Sequence[Type], kind: str) -> Sequence[Number] | None:
    """The unrounded components of a builtin's result of a kind; None where the table has no `fold` for it."""
    row = BUILTINS[name]
    fold = row.fold_uint if kind == "uint" and row.fold_uint is not None else row.fold
    if fold is None:
        return None
    if not row.componentwise:
        values: Sequence[Number] = fold(*map(_by_columns, args, types))
        return values
    return [fold(*parts) for parts in _by_component(args)]


def _by_columns(arg: Numbers, type_: Type) -> Numbers | list[Numbers]:
    """The columns of a matrix; the numbers of any other argument."""
    if not isinstance(type_, Matrix):
        return arg
    return [arg[start : start + type_.rows] for start in range(0, len(arg), type_.rows)]


def _by_component(args: Sequence[Numbers]) -> Iterator[tuple[Number, ...]]:
    """The arguments of each component; a scalar counts for all of them."""
    size = max(map(len, args))
    return zip(*[arg if len(arg) == size else arg * size for arg in args], strict=True)


def _each(compute: Callable[..., Number], args: Sequence[Numbers], kind: str) -> Numbers | None:
    try:
        return _rounded([compute(*parts) for parts in _by_component(args)], kind)
    except (ArithmeticError, ValueError):
        return None


def _rounded(values: Sequence[Number], kind: str) -> Numbers | None:
    result: list[Number] = []
    for value in values:
        if kind == "float":
            single = float32(float(value))
            if single is None:
                return None
            result.append(single)
        else:
            result.append(bool(value) if kind == "bool" else wrapped(int(value), kind))
    return tuple(result)


# Operators


def _quotient(x: int, y: int) -> int:
    quotient = abs(x) // abs(y)
    return quotient if (x < 0) == (y < 0) else -quotient


def _remainder(x: int, y: int) -> int:
    # of negative numbers it is undefined in GLSL, section 5.9; WGSL and HLSL truncate
    return x - y * _quotient(x, y)


def _shift(shift: Callable[[int, int], int]) -> Callable[[int, int], int]:
    def shifted(x: int, y: int) -> int:
        if not 0 <= y < 32:
            raise ArithmeticError
        return shift(x, y)

    return shifted


_COMPARISONS: dict[str, Callable[[Number, Number], bool]] = {
    "==": operator.eq, "!=": operator.ne,
    "<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge,
}  # fmt: skip
_FLOAT: dict[str, Callable[..., Number]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv,
}  # fmt: skip
_INTEGER: dict[str, Callable[..., Number]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": _quotient, "%": _remainder,
    "&": operator.and_, "|": operator.or_, "^": operator.xor,
    "<<": _shift(operator.lshift), ">>": _shift(operator.rshift),
}  # fmt: skip
_BOOL: dict[str, Callable[..., Number]] = {
    "&&": lambda x, y: x and y, "||": lambda x, y: x or y, "^^": operator.xor,
}  # fmt: skip
