"""What GLSL's builtins compute, by GLSL's specification, for the interpreter of random programs."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

from glsl_values import (
    Undefined,
    Value,
    bits_of,
    componentwise,
    determinant,
    exact,
    float_of,
    product,
    transpose,
    wrapped,
)


def _clamp(x: Any, low: Any, high: Any) -> Any:
    if low > high:
        raise Undefined("clamp")
    return min(max(x, low), high)


def _sign(x: Any) -> Any:
    return type(x)((x > 0) - (x < 0))


def _absolute(x: Any) -> Any:
    if x == -0x80000000:
        raise Undefined("abs")
    return abs(x)


def _modulo(x: float, y: float) -> float:
    if y == 0.0:
        raise Undefined("mod")
    return exact(x - y * math.floor(x / y))


def _mixed(x: Any, y: Any, a: Any) -> Any:
    if isinstance(a, bool):
        return y if a else x
    return exact(exact(x * exact(1.0 - a)) + exact(y * a))


def _extract(signed: bool) -> Callable[[int, int, int], int]:
    def extract(x: int, offset: int, bits: int) -> int:
        if offset < 0 or bits < 0 or offset + bits > 32:
            raise Undefined("bitfieldExtract")
        field = (x & 0xFFFFFFFF) >> offset & ((1 << bits) - 1)
        if signed and bits and field >> (bits - 1):
            field -= 1 << bits
        return field

    return extract


def _insert(base: int, inserted: int, offset: int, bits: int) -> int:
    if offset < 0 or bits < 0 or offset + bits > 32:
        raise Undefined("bitfieldInsert")
    mask = ((1 << bits) - 1) << offset
    return (base & 0xFFFFFFFF & ~mask) | ((inserted << offset) & mask)


def _reversed(x: int) -> int:
    return int(f"{x & 0xFFFFFFFF:032b}"[::-1], 2)


def _lowest(x: int) -> int:
    return (x & -x).bit_length() - 1


def _highest(x: int) -> int:
    return (~x if x < 0 else x).bit_length() - 1


def _half(x: float) -> int:
    bits: int = struct.unpack("<H", struct.pack("<e", x))[0]
    return bits


def _of_half(bits: int) -> float:
    number: float = struct.unpack("<e", struct.pack("<H", bits))[0]
    return exact(number)


def _scaled(x: float, power: int) -> float:
    if not -20 <= power <= 20:
        raise Undefined("ldexp")
    return exact(math.ldexp(x, power))


def _cross(a: Value, b: Value) -> Value:
    pairs = ((1, 2), (2, 0), (0, 1))
    return tuple(exact(exact(a[i] * b[j]) - exact(b[i] * a[j])) for i, j in pairs)


def _dot(a: Value, b: Value) -> float:
    if not isinstance(a, tuple):
        return exact(a * b)
    return exact(sum(exact(x * y) for x, y in zip(a, b, strict=True)))


def _reflected(i: Value, n: Value) -> Value:
    twice = exact(2.0 * _dot(n, i))
    return componentwise(lambda x, y: exact(x - exact(twice * y)), i, n)


def _rounded(function: Callable[..., float]) -> Callable[..., Any]:
    return lambda *args: componentwise(function, *args)


def _parts(pack: Callable[[Any], int], size: int) -> Callable[[Value], int]:
    return lambda v: sum(pack(x) << (size * i) for i, x in enumerate(v))


def _unpacked(unpack: Callable[[int], float], size: int) -> Callable[[int], Value]:
    return lambda n: tuple(unpack(n >> (size * i) & ((1 << size) - 1)) for i in range(32 // size))


def _signed(number: float) -> float:
    """A number whose bits are compared. Raises Undefined for 0, whose sign implementations need not keep."""
    if number == 0.0:
        raise Undefined("the sign of a zero")
    return number


COMPONENTWISE: dict[str, Callable[..., Any]] = {
    "abs": _absolute, "sign": _sign, "min": min, "max": max, "clamp": _clamp, "floor": lambda x: float(math.floor(x)),
    "ceil": lambda x: float(math.ceil(x)), "trunc": lambda x: float(math.trunc(x)),
    "roundEven": lambda x: float(round(x)),
    "fract": lambda x: exact(x - math.floor(x)), "mod": _modulo, "mix": _mixed,
    "step": lambda edge, x: 0.0 if x < edge else 1.0, "fma": lambda a, b, c: exact(exact(a * b) + c), "ldexp": _scaled,
    "lessThan": lambda a, b: a < b, "lessThanEqual": lambda a, b: a <= b, "greaterThan": lambda a, b: a > b,
    "greaterThanEqual": lambda a, b: a >= b, "equal": lambda a, b: a == b, "notEqual": lambda a, b: a != b,
    "not": lambda a: not a, "isnan": lambda x: False, "isinf": lambda x: False,
    "bitCount": lambda x: (x & 0xFFFFFFFF).bit_count(),
    "findLSB": _lowest, "findMSB": _highest, "floatBitsToInt": lambda x: wrapped("int", bits_of(_signed(x))),
    "floatBitsToUint": lambda x: bits_of(_signed(x)), "intBitsToFloat": lambda n: exact(float_of(n)),
    "uintBitsToFloat": lambda n: exact(float_of(n)),
}  # fmt: skip
WHOLE: dict[str, Callable[..., Any]] = {
    "any": any, "all": all, "dot": _dot, "cross": _cross, "transpose": transpose, "determinant": determinant,
    "matrixCompMult": lambda a, b: componentwise(lambda x, y: exact(x * y), a, b),
    "outerProduct": lambda c, r: tuple(tuple(exact(x * y) for x in c) for y in r), "reflect": _reflected,
    "faceforward": lambda n, i, r: n if _dot(r, i) < 0.0 else componentwise(lambda x: 0.0 - x, n),
    "packHalf2x16": _parts(lambda x: _half(_signed(x)), 16), "unpackHalf2x16": _unpacked(_of_half, 16),
}  # fmt: skip
SMOOTH: dict[str, Callable[..., Any]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": lambda *a: math.atan2(a[0], a[1] if len(a) > 1 else 1.0),
    "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh, "asinh": math.asinh, "acosh": math.acosh,
    "atanh": math.atanh,
    "exp": math.exp, "exp2": lambda x: 2.0**x, "log": math.log, "log2": math.log2, "pow": math.pow, "sqrt": math.sqrt,
    "inversesqrt": lambda x: 1.0 / math.sqrt(x), "radians": math.radians, "degrees": math.degrees,
    "abs": abs, "min": min, "max": max, "clamp": _clamp, "mix": lambda x, y, a: x * (1.0 - a) + y * a,
}  # fmt: skip


def _norm(v: Value) -> float:
    return math.hypot(*v) if isinstance(v, tuple) else abs(v)


def _normalized(v: Value) -> Value:
    return componentwise(lambda x: x / _norm(v), v)


def _smooth_step(low: float, high: float, x: float) -> float:
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def _refracted(i: Value, n: Value, eta: float) -> Value:
    cosine = sum(a * b for a, b in zip(i, n, strict=True))
    k = 1.0 - eta * eta * (1.0 - cosine * cosine)
    if k < 0.05:
        raise Undefined("refract")
    return tuple(eta * a - (eta * cosine + math.sqrt(k)) * b for a, b in zip(i, n, strict=True))


SMOOTH_WHOLE: dict[str, Callable[..., Any]] = {
    "length": _norm, "normalize": _normalized, "dot": lambda a, b: sum(x * y for x, y in zip(a, b, strict=True)),
    "distance": lambda a, b: _norm(componentwise(lambda x, y: x - y, a, b)), "refract": _refracted,
    "cross": lambda a, b: tuple(a[i] * b[j] - b[i] * a[j] for i, j in ((1, 2), (2, 0), (0, 1))),
}  # fmt: skip

WRITES = {"modf", "frexp", "uaddCarry", "usubBorrow", "umulExtended", "imulExtended"}
"""The builtins with `out` parameters."""


def computed(name: str, kind_: str, rounded: bool) -> Callable[..., Value]:
    """A builtin without `out` parameters for a first argument of this kind; `rounded` for results of `~float`."""
    if name in ("bitfieldExtract", "bitfieldInsert", "bitfieldReverse"):
        signed = kind_ == "int"
        table: dict[str, Callable[..., int]] = {
            "bitfieldExtract": _extract(signed), "bitfieldInsert": _insert, "bitfieldReverse": _reversed,
        }  # fmt: skip
        of_bits = table[name]
        return lambda *args: componentwise(lambda *parts: wrapped(kind_, of_bits(*parts)), *args)
    if rounded:
        if name == "smoothstep":
            return _rounded(_smooth_step)
        return _rounded(SMOOTH[name]) if name in SMOOTH else SMOOTH_WHOLE[name]
    if name in WHOLE:
        return WHOLE[name]
    function = COMPONENTWISE[name]
    return lambda *args: componentwise(function, *args)


def writing(name: str, *args: Value) -> tuple[Value, ...]:
    """The result of a builtin with `out` parameters, and their values in order."""

    def scalar(*parts: Any) -> tuple[Any, ...]:
        if name == "modf":
            whole = float(math.trunc(parts[0]))
            return exact(parts[0] - whole), whole
        if name == "frexp":
            return math.frexp(parts[0])
        if name == "uaddCarry":
            total = parts[0] + parts[1]
            return total & 0xFFFFFFFF, total >> 32
        if name == "usubBorrow":
            return (parts[0] - parts[1]) & 0xFFFFFFFF, int(parts[0] < parts[1])
        kind_ = "int" if name == "imulExtended" else "uint"
        whole_product = parts[0] * parts[1]
        return wrapped(kind_, whole_product >> 32), wrapped(kind_, whole_product)  # most significant first

    if not isinstance(args[0], tuple):
        results = scalar(*args)
    else:
        results = tuple(zip(*[scalar(*parts) for parts in zip(*args, strict=True)], strict=True))
    if name in ("umulExtended", "imulExtended"):
        return (None, *results)
    return results


__all__ = ["WRITES", "computed", "product", "writing"]
