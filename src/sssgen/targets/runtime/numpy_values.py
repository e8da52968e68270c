"""Values for Python printed from a shader: their layout, constructors, parts and operators, on NumPy arrays.

The components are on the first axes and the lanes of the batch (one per pixel or point) on the last, so that scalars
broadcast against vectors and `m[i]` is a column:

- a scalar has the shape () or (n,), a vector of K components (K, n), a matrix (columns,
  rows, n); n may be 1 for a value that is the same in all lanes. An array has its length as an axis before these.
- a struct is a `Record`.

The element type follows the inputs: float64 for the oracle, float32 or float16 to see the rounding of a target. Plain
Python numbers adapt to the other operands. Where no operand determines it (a conversion from int, a vector of literals)
it is that of `with precision(numpy.float32):`, float64 by default, which also silences NumPy's warnings about overflow,
NaN and division by 0; the functions of the runtime are silent everywhere. int is int32, uint is uint32, and both wrap.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = [
    "Record",
    "array",
    "diagonal",
    "divide",
    "equals",
    "grid",
    "index",
    "int_divide",
    "int_remainder",
    "mat",
    "mat_mul",
    "mat_vec",
    "precision",
    "resize",
    "select",
    "shift_left",
    "shift_right",
    "splat",
    "store_index",
    "store_swizzle",
    "swizzle",
    "to_bool",
    "to_float",
    "to_int",
    "to_uint",
    "vec",
    "vec_mat",
]

Value: TypeAlias = Any
"""A Python number or an array, in the layout above."""

_precision: ContextVar[str] = ContextVar("precision", default="float64")
image_shape: ContextVar[tuple[int, int] | None] = ContextVar("grid", default=None)


@contextmanager
def precision(dtype: npt.DTypeLike) -> Iterator[None]:
    """Computes in this floating-point type where the inputs do not determine one, and without NumPy's warnings."""
    token = _precision.set(np.dtype(dtype).name)
    try:
        with np.errstate(all="ignore"):
            yield
    finally:
        _precision.reset(token)


def working() -> np.dtype[Any]:
    """The floating-point type where the inputs do not determine one."""
    return np.dtype(_precision.get())


@contextmanager
def grid(height: int, width: int) -> Iterator[None]:
    """Declares the lanes to be the pixels of an image, row by row from the bottom: derivatives need neighbours."""
    token = image_shape.set((height, width))
    try:
        yield
    finally:
        image_shape.reset(token)


class Record:
    """A struct: its fields are attributes. It is immutable: `replace` returns a changed copy."""

    def __init__(self, **fields: Value) -> None:
        self.__dict__.update(fields)

    def replace(self, **fields: Value) -> Record:
        return Record(**{**self.__dict__, **fields})

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Value: ...

    def __repr__(self) -> str:
        return f"Record({', '.join(f'{name}={value!r}' for name, value in self.__dict__.items())})"


def arrays(values: tuple[Value, ...]) -> list[Value]:
    """The values as arrays; Python numbers take the type of the first array of their kind, negative ones are ints."""
    floating: np.dtype[Any] = working()
    integer: np.dtype[Any] = np.dtype(np.int32)
    for value in reversed(values):
        if isinstance(value, np.ndarray | np.generic):
            if value.dtype.kind == "f":
                floating = value.dtype
            elif value.dtype.kind in "iu":
                integer = value.dtype
    kinds = {float: floating, int: integer, bool: np.dtype(np.bool_)}
    return [
        np.asarray(value, np.int32 if type(value) is int and value < 0 else kinds.get(type(value))) for value in values
    ]


def silent(function: Callable[..., Value]) -> Callable[..., Value]:
    """A function that gets arrays for its arguments and runs without NumPy's warnings."""

    @wraps(function)
    def call(*values: Value) -> Value:
        with np.errstate(all="ignore"):
            return function(*arrays(values))

    return call


# Constructors and conversions


def _stack(parts: tuple[Value, ...]) -> Value:
    wide = [part if part.ndim > 1 else part.reshape(1, -1) for part in arrays(parts)]
    lanes = np.broadcast_shapes(*(part.shape[-1:] for part in wide))
    flat = [part.reshape(-1, part.shape[-1]) for part in wide]
    return np.concatenate([np.broadcast_to(part, (len(part), *lanes)) for part in flat])


def vec(*parts: Value) -> Value:
    """A vector of all components of the scalars and vectors, which are of one kind (see `to_float`)."""
    return _stack(parts)


def splat(size: int, value: Value) -> Value:
    """A vector with the scalar in each component."""
    return _stack((value,) * size)


def mat(columns: int, *parts: Value) -> Value:
    """A matrix from its columns, or from its scalars column by column."""
    numbers = _stack(parts)
    return numbers.reshape(columns, -1, numbers.shape[-1])


def diagonal(columns: int, value: Value, rows: int = 0) -> Value:
    """A matrix with the scalar on the diagonal and 0 elsewhere; without `rows` it is square."""
    (value,) = arrays((value,))
    return np.eye(columns, rows or columns, dtype=value.dtype)[..., None] * value


def resize(columns: int, matrix: Value, rows: int = 0) -> Value:
    """A matrix of another size from the upper left part of this one, as the identity beyond it; without `rows` it is
    square."""
    result = np.repeat(np.eye(columns, rows or columns, dtype=matrix.dtype)[..., None], matrix.shape[-1], axis=-1)
    result[: len(matrix), : matrix.shape[1]] = matrix[: len(result), : result.shape[1]]
    return result


def array(*elements: Value) -> Value:
    """A fixed array; elements that are the same in all lanes are widened. Of structs it is a struct of arrays."""
    if isinstance(elements[0], Record):
        return Record(**{name: array(*[getattr(element, name) for element in elements]) for name in vars(elements[0])})
    return np.stack(np.broadcast_arrays(*[np.atleast_1d(element) for element in arrays(elements)]))


def to_float(value: Value) -> Value:
    """`float(x)` and `vec3(ivec3)`: in the working precision; a Python number is kept as one."""
    if isinstance(value, int | float):
        return float(value)
    return value if value.dtype.kind == "f" else value.astype(working())


def to_int(value: Value) -> Value:
    """`int(x)`: truncated, and clamped to the range of int; NaN gives 0. From uint: the same bits."""
    return _to_integer(value, np.dtype(np.int32))


def to_uint(value: Value) -> Value:
    """`uint(x)`: truncated, and clamped to the range of uint; NaN gives 0. From int: the same bits."""
    return _to_integer(value, np.dtype(np.uint32))


def _to_integer(value: Value, dtype: np.dtype[Any]) -> Value:
    value = np.asarray(value)
    if value.dtype.kind == "f":
        limits = np.iinfo(dtype)
        value = np.clip(np.trunc(np.nan_to_num(value.astype(np.float64))), limits.min, limits.max)
    return value.astype(np.int64).astype(dtype)


def to_bool(value: Value) -> Value:
    """`bool(x)`: whether it is not 0."""
    return np.asarray(value) != 0


# Access to parts


def swizzle(vector: Value, components: str) -> Value:
    """`v.zyx`; a scalar for one component."""
    places = ["xyzw".index(component) for component in components]
    return vector[places[0]] if len(places) == 1 else vector[places]


def store_swizzle(vector: Value, components: str, value: Value) -> Value:
    """The vector after `v.xy = value`."""
    vector, value = arrays((vector, value))
    result = np.broadcast_to(vector, (len(vector), *np.broadcast_shapes(vector.shape[-1:], value.shape[-1:]))).copy()
    result[["xyzw".index(component) for component in components]] = value
    return result


def index(value: Value, place: Value) -> Value:
    """`value[place]`, where each lane may have its own place; the nearest element where the place is out of range."""
    if isinstance(value, Record):
        return Record(**{name: index(part, place) for name, part in vars(value).items()})
    place = np.clip(place, 0, len(value) - 1)
    if place.ndim == 0:
        return value[place]
    lanes = np.arange(max(len(place), value.shape[-1]))
    return np.moveaxis(value[place, ..., lanes if value.shape[-1] > 1 else 0 * lanes], 0, -1)


def store_index(value: Value, place: Value, element: Value) -> Value:
    """The value after `value[place] = element`; nothing is stored where the place is out of range."""
    if isinstance(value, Record):
        return Record(**{name: store_index(part, place, getattr(element, name)) for name, part in vars(value).items()})
    element, value = np.asarray(element, value.dtype), np.asarray(value)
    places = np.arange(len(value)).reshape(-1, *(1,) * (value.ndim - 1))
    return np.where(places == place, element, value)


# Operators that differ from Python's


def select(mask: Value, yes: Value, no: Value) -> Value:
    """`mask ? yes : no` lane by lane, over all components, array elements and fields."""
    if isinstance(yes, Record):
        return Record(**{name: select(mask, value, getattr(no, name)) for name, value in yes.__dict__.items()})
    yes, no = arrays((yes, no))
    return np.where(mask, yes, no)


def equals(x: Value, y: Value) -> Value:
    """`x == y`: one bool for scalars, vectors, matrices and structs alike."""
    if isinstance(x, Record):
        fields = [equals(value, getattr(y, name)) for name, value in x.__dict__.items()]
        return np.logical_and.reduce(np.broadcast_arrays(*fields))
    same = np.asarray(x) == np.asarray(y)
    return np.logical_and.reduce(same, axis=tuple(range(same.ndim - 1))) if same.ndim > 1 else same


@silent
def divide(x: Value, y: Value) -> Value:
    """`x / y` of floats; a division by 0 gives infinity or NaN, also for Python numbers."""
    return x / y


@silent
def int_divide(x: Value, y: Value) -> Value:
    """`x / y` of integers, truncated; x / 0 is x, and -2147483648 / -1 is -2147483648, as in WGSL."""
    divisor = np.where(y == 0, y.dtype.type(1), y)
    return (x - np.fmod(x, divisor)) // divisor


@silent
def int_remainder(x: Value, y: Value) -> Value:
    """`x % y` of integers, with the sign of x; x % 0 and -2147483648 % -1 are 0, as in WGSL."""
    return np.fmod(x, np.where(y == 0, y.dtype.type(1), y))


def _shifted(x: Value, count: Value) -> tuple[Value, Value]:
    """The shifted value as an array, and the low five bits of the count as an array of the same type."""
    (shifted,), (bits,) = arrays((x,)), arrays((count,))
    return shifted, (bits & 31).astype(shifted.dtype)


def shift_left(x: Value, count: Value) -> Value:
    """`x << count`; only the low five bits of the count matter, as in WGSL and HLSL."""
    x, count = _shifted(x, count)
    return x << count


def shift_right(x: Value, count: Value) -> Value:
    """`x >> count`; fills with the sign for int. Only the low five bits of the count matter."""
    x, count = _shifted(x, count)
    return x >> count


@silent
def mat_mul(x: Value, y: Value) -> Value:
    """The matrix product."""
    return np.add.reduce(x[None] * y[:, :, None], axis=1)


@silent
def mat_vec(x: Value, y: Value) -> Value:
    """Matrix times column vector."""
    return np.add.reduce(x * y[:, None], axis=0)


@silent
def vec_mat(x: Value, y: Value) -> Value:
    """Row vector times matrix."""
    return np.add.reduce(y * x[None], axis=1)
