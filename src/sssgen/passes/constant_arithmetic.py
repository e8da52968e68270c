"""Arithmetic on constants, for `fold`: values as every target has them, or None where a target may differ.

Floats are float32: operands are rounded to it, the result is computed in float64 and rounded once. Nothing
gives inf, NaN or a denormal (which GPUs may flush to 0), nothing divides by zero. Ints and uints are of 32
bits and wrap. Builtins are computed within the domain that the intrinsic table gives.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from struct import Struct

from sssgen.ir.types import Type, components, kind_of

Number = float | int | bool
Numbers = tuple[Number, ...]
"""The components of a scalar or vector."""

_FLOAT32 = Struct("f")
_SMALLEST = 2.0**-126
_LARGEST = 2.0**128 - 2.0**104


def float32(value: float) -> float | None:
    """A float64 rounded to float32; None where that is not finite, or denormal."""
    try:
        result: float = _FLOAT32.unpack(_FLOAT32.pack(value))[0]
    except OverflowError:
        return None
    if not math.isfinite(result) or (abs(result) < _SMALLEST and value != 0.0):
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
        whole = int(value)
        return whole if whole == wrapped(whole, kind) else None
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


def unary(op: str, value: Numbers, kind: str) -> Numbers | None:
    """`op value`."""
    if op == "!":
        return tuple([not one for one in value])
    if kind == "float":
        return tuple([-one for one in value]) if op == "-" else None
    return tuple([wrapped(-int(one) if op == "-" else ~int(one), kind) for one in value])


def builtin(name: str, args: Sequence[Numbers], types: Sequence[Type], result: Type) -> Numbers | None:
    """A builtin of constant arguments; None for those that are not computed here, or outside their domain."""
    reduce = _REDUCED.get(name)
    kind = kind_of(result)
    if reduce is not None:
        try:
            values = reduce(*args)
        except (ArithmeticError, ValueError):
            return None
        return _rounded(values, kind)
    compute = _COMPONENTWISE.get(name)
    if compute is None or (name == "mix" and kind_of(types[2]) == "bool"):
        return None
    found = _each(compute, args, kind)
    return found if found is not None and len(found) == components(result) else None


def outside(name: str, args: Sequence[Numbers]) -> bool:
    """Whether constant arguments lie outside a builtin's domain, or its result outside the floats."""
    try:
        if name in _REDUCED:
            values = _REDUCED[name](*args)
        elif name in _COMPONENTWISE:
            size = max(map(len, args))
            wide = [arg if len(arg) == size else arg * size for arg in args]
            values = [_COMPONENTWISE[name](*parts) for parts in zip(*wide, strict=True)]
        else:
            return False
        return any(not abs(value) <= _LARGEST for value in values)
    except (ArithmeticError, ValueError):
        return True


def _each(compute: Callable[..., Number], args: Sequence[Numbers], kind: str) -> Numbers | None:
    size = max(map(len, args))
    wide = [arg if len(arg) == size else arg * size for arg in args]
    try:
        return _rounded([compute(*parts) for parts in zip(*wide, strict=True)], kind)
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


def _within(condition: bool, value: float) -> float:
    """`value`; ValueError where the domain's condition does not hold."""
    if not condition:
        raise ValueError
    return value


# Operators


def _quotient(x: int, y: int) -> int:
    if (x, y) == (-0x80000000, -1):
        raise ArithmeticError
    whole = abs(x) // abs(y)
    return whole if (x < 0) == (y < 0) else -whole


def _remainder(x: int, y: int) -> int:
    # of negative numbers it is undefined in GLSL ES 3.00, section 5.9
    if x < 0 or y < 0:
        raise ArithmeticError
    return x % y


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


# Builtins


def _atan(y: float, x: float | None = None) -> float:
    if x is None:
        return math.atan(y)
    return _within(x != 0.0 or y != 0.0, math.atan2(y, x))


def _pow(x: float, y: float) -> float:
    if x < 0.0 or (x == 0.0 and y <= 0.0):
        raise ValueError
    return math.pow(x, y)


def _sign(x: float) -> float:
    return (x > 0) - (x < 0)


def _clamp(x: float, low: float, high: float) -> float:
    return _within(low <= high, min(max(x, low), high))


def _smoothstep(low: float, high: float, x: float) -> float:
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return _within(low < high, t * t * (3.0 - 2.0 * t))


def _abs(x: float) -> float:
    return _within(x != -0x80000000 or isinstance(x, float), abs(x))


_COMPONENTWISE: dict[str, Callable[..., Number]] = {
    "radians": lambda x: x * math.pi / 180.0, "degrees": lambda x: x * 180.0 / math.pi,
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos, "atan": _atan,
    "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    "asinh": math.asinh, "acosh": math.acosh, "atanh": math.atanh,
    "pow": _pow, "exp": math.exp, "log": math.log, "exp2": lambda x: 2.0**x, "log2": math.log2,
    "sqrt": math.sqrt, "inversesqrt": lambda x: 1.0 / math.sqrt(x),
    "abs": _abs, "sign": _sign, "floor": math.floor, "ceil": math.ceil, "trunc": math.trunc,
    "round": round, "roundEven": round, "fract": lambda x: x - math.floor(x),
    "mod": lambda x, y: x - y * math.floor(x / y), "fmod": lambda x, y: x - y * math.trunc(x / y),
    "min": min, "max": max, "clamp": _clamp, "saturate": lambda x: min(max(x, 0.0), 1.0),
    "mix": lambda x, y, t: x * (1.0 - t) + y * t, "step": lambda edge, x: 0.0 if x < edge else 1.0,
    "smoothstep": _smoothstep,
    "lessThan": operator.lt, "lessThanEqual": operator.le, "greaterThan": operator.gt,
    "greaterThanEqual": operator.ge, "equal": operator.eq, "notEqual": operator.ne, "not": operator.not_,
}  # fmt: skip


def _dot(x: Sequence[float], y: Sequence[float]) -> float:
    return math.fsum(one * other for one, other in zip(x, y, strict=True))


def _length(x: Sequence[float]) -> float:
    return math.sqrt(_dot(x, x))


def _normalize(x: Sequence[float]) -> list[float]:
    return [one / _length(x) for one in x]


def _cross(x: Sequence[float], y: Sequence[float]) -> list[float]:
    return [x[i] * y[j] - x[j] * y[i] for i, j in ((1, 2), (2, 0), (0, 1))]


_REDUCED: dict[str, Callable[..., Sequence[Number]]] = {
    "dot": lambda x, y: [_dot(x, y)],
    "length": lambda x: [_length(x)],
    "distance": lambda x, y: [_length([one - other for one, other in zip(x, y, strict=True)])],
    "normalize": _normalize,
    "cross": _cross,
    "any": lambda x: [any(x)],
    "all": lambda x: [all(x)],
}
