"""The values of GLSL in Python: integers of 32 bits, floats, and tuples for everything that has parts.

A matrix is a tuple of columns; arrays and structs are tuples too. What GLSL leaves undefined raises `Undefined`.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable
from functools import cache
from typing import Any

Value = Any
KINDS = {"i": "int", "u": "uint", "b": "bool"}
ZERO = {"int": 0, "uint": 0, "bool": False, "float": 0.0}


class Undefined(Exception):
    """The program does what GLSL leaves undefined, or computes a float that would be rounded."""


@cache
def vector_size(type_: str) -> int:
    """2 to 4 for a vector, else 0."""
    return int(type_[-1]) if re.fullmatch("~?[iub]?vec[234]", type_) else 0


@cache
def matrix_size(type_: str) -> int:
    """2 to 4 for a matrix, else 0."""
    return int(type_[3]) if re.fullmatch("mat[234]", type_) else 0


@cache
def kind(type_: str) -> str:
    """The kind of the components of a scalar, vector or matrix type."""
    type_ = type_.removeprefix("~")
    if type_ in ZERO:
        return type_
    return KINDS.get(type_[0], "float")


def vector(kind_: str, size: int) -> str:
    """The type of `size` components."""
    prefix = {"int": "ivec", "uint": "uvec", "bool": "bvec", "float": "vec", "~float": "~vec"}[kind_]
    return kind_ if size == 1 else f"{prefix}{size}"


def element(type_: str) -> tuple[str, int]:
    """The type and number of an array's elements."""
    inner, _, length = type_.partition("[")
    return inner, int(length[:-1])


def wrapped(kind_: str, number: Any) -> Any:
    """A result of integer arithmetic in 32 bits; other kinds stay."""
    if kind_ == "int":
        return ((number + 0x80000000) & 0xFFFFFFFF) - 0x80000000
    if kind_ == "uint":
        return number & 0xFFFFFFFF
    return number


@cache
def exact(number: float) -> float:
    """A float that float32 represents without rounding."""
    if number != number or abs(number) > 1 << 24 or number * 2048.0 != int(number * 2048.0):
        raise Undefined("inexact")
    if struct.unpack("f", struct.pack("f", number))[0] != number:
        raise Undefined("inexact")
    return number + 0.0


def convert(from_: str, to: str, number: Any) -> Any:
    """A scalar of another kind, as a constructor converts it."""
    if to == "bool":
        return number != 0
    if to == "float":
        return exact(float(number))
    if from_ == "float":
        if to == "uint" and number <= -1.0:
            raise Undefined("a negative float as uint")
        return int(number)
    return wrapped(to, int(number))


def flat(value: Value) -> list[Any]:
    """The components of a value, in order."""
    if isinstance(value, tuple):
        return [component for part in value for component in flat(part)]
    return [value]


def construct(type_: str, args: list[tuple[str, Value]]) -> Value:
    """A constructor of a scalar, vector or matrix."""
    to = kind(type_)
    size, columns = vector_size(type_), matrix_size(type_)
    components = [convert(kind(from_), to, part) for from_, value in args for part in flat(value)]
    if columns:
        if len(args) == 1 and not isinstance(args[0][1], tuple):
            return tuple(tuple(components[0] if i == j else 0.0 for j in range(columns)) for i in range(columns))
        if len(args) == 1 and matrix_size(args[0][0]):
            other = args[0][1]
            return tuple(
                tuple(other[i][j] if i < len(other) and j < len(other) else float(i == j) for j in range(columns))
                for i in range(columns)
            )
        return tuple(tuple(components[i * columns : (i + 1) * columns]) for i in range(columns))
    if not size:
        return components[0]
    return tuple(components * size if len(components) == 1 else components[:size])


def zero(type_: str, structs: dict[str, list[tuple[str, str]]]) -> Value:
    """The zero of any type."""
    if "[" in type_:
        inner, length = element(type_)
        return (zero(inner, structs),) * length
    if type_ in structs:
        return tuple(zero(field, structs) for field, _ in structs[type_])
    if size := matrix_size(type_):
        return ((0.0,) * size,) * size
    size = vector_size(type_)
    return (ZERO[kind(type_)],) * size if size else ZERO[kind(type_)]


def _divided(kind_: str, a: Any, b: Any) -> Any:
    if b == 0:
        raise Undefined("division by zero")
    if kind_ == "float":
        return a / b
    quotient = abs(a) // abs(b)
    if (a < 0) != (b < 0):
        quotient = -quotient
    if wrapped(kind_, quotient) != quotient:
        raise Undefined("INT_MIN / -1")
    return quotient


def _remainder(kind_: str, a: Any, b: Any) -> Any:
    if b <= 0 or a < 0:
        raise Undefined("remainder of negative numbers")
    return a % b


def _count(number: int) -> int:
    if not 0 <= number < 32:
        raise Undefined("shift")
    return number


ARITHMETIC: dict[str, Callable[[str, Any, Any], Any]] = {
    "+": lambda kind_, a, b: a + b,
    "-": lambda kind_, a, b: a - b,
    "*": lambda kind_, a, b: a * b,
    "/": _divided,
    "%": _remainder,
    "&": lambda kind_, a, b: a & b,
    "|": lambda kind_, a, b: a | b,
    "^": lambda kind_, a, b: a ^ b,
    "<<": lambda kind_, a, b: a << _count(b),
    ">>": lambda kind_, a, b: a >> _count(b),
}
COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "^^": lambda a, b: a != b,
}


def componentwise(function: Callable[..., Any], *args: Value) -> Value:
    """`function` over the components; a scalar is repeated."""
    size = next((len(arg) for arg in args if isinstance(arg, tuple)), 0)
    if not size:
        return function(*args)
    rows = [arg if isinstance(arg, tuple) else (arg,) * size for arg in args]
    return tuple(componentwise(function, *parts) for parts in zip(*rows, strict=True))


def operation(op: str, type_: str, left: str, right: str) -> Callable[[Value, Value], Value]:
    """A binary operator for operands of these types; `type_` is that of the result."""
    if op in COMPARISONS:
        return COMPARISONS[op]
    kind_ = kind(type_)
    arithmetic = ARITHMETIC[op]
    rounded = type_.startswith("~")

    def scalar(a: Any, b: Any) -> Any:
        result = arithmetic(kind_, a, b)
        if kind_ == "float":
            return result if rounded else exact(result)
        return wrapped(kind_, result)

    if op == "*" and (matrix_size(left) or matrix_size(right)):
        return lambda a, b: product(a, b, bool(matrix_size(left)), bool(matrix_size(right)))
    if not any(vector_size(operand) or matrix_size(operand) for operand in (left, right)):
        return scalar
    return lambda a, b: componentwise(scalar, a, b)


def _dot(a: Value, b: Value) -> float:
    total = 0.0
    for x, y in zip(a, b, strict=True):
        total = exact(total + exact(x * y))
    return total


def product(a: Value, b: Value, left: bool, right: bool) -> Value:
    """A product with a matrix; `left` and `right` say which operand is one."""
    if not isinstance(a, tuple) or not isinstance(b, tuple):
        return componentwise(lambda x, y: exact(x * y), a, b)
    if left and right:
        return tuple(product(a, column, True, False) for column in b)
    if left:
        return tuple(_dot([column[i] for column in a], b) for i in range(len(b)))
    return tuple(_dot(a, column) for column in b)


def transpose(matrix: Value) -> Value:
    """Rows become columns."""
    return tuple(zip(*matrix, strict=True))


def determinant(matrix: Value) -> float:
    """By the first column."""
    if len(matrix) == 1:
        return float(matrix[0][0])
    total = 0.0
    for i, value in enumerate(matrix[0]):
        minor = tuple(tuple(x for j, x in enumerate(column) if j != i) for column in matrix[1:])
        total = exact(total + exact((-1.0) ** i * value * determinant(minor)))
    return total


def bits_of(number: float) -> int:
    """The bits of a float32."""
    bits: int = struct.unpack("<I", struct.pack("<f", number))[0]
    return bits


def float_of(bits: int) -> float:
    """The float32 of bits."""
    number: float = struct.unpack("<f", struct.pack("<I", bits & 0xFFFFFFFF))[0]
    if math.isnan(number) or math.isinf(number):
        raise Undefined("not finite")
    return number
