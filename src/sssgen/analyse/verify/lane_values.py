"""The interpreter's values: arrays whose last axis is the lanes, or has length 1 where all lanes have the same value.

Structs are records of such arrays; a texture is the same in all lanes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from sssgen.ir.intrinsics.table import LARGEST
from sssgen.ir.types import Array as ArrayType
from sssgen.ir.types import Struct, Type, kind_of
from sssgen.run.backends import Array
from sssgen.run.backends import call_program as calls
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.targets import numpy_runtime as rt
from sssgen.targets.runtime.numpy_textures import Texture

Value: TypeAlias = Any
FAR = 1024.0
"""The largest coordinate of a texture."""
DTYPES: dict[str, np.dtype[Any]] = {
    "float": np.dtype(np.float64), "int": np.dtype(np.int32), "uint": np.dtype(np.uint32), "bool": np.dtype(bool),
}  # fmt: skip


def zero(type_: Type) -> Value:
    """The value 0 of a type, in one lane."""
    return build_value(type_, lambda shape, kind: np.zeros((*shape, 1), DTYPES[kind]))


def build_value(type_: Type, numbers: Callable[[tuple[int, ...], str], Array]) -> Value:
    """A value of a type whose parts are the `numbers` of a shape, without lanes, and a kind."""
    if isinstance(type_, Struct):
        return rt.Record(**{field.name: build_value(field.type, numbers) for field in type_.fields})
    if isinstance(type_, ArrayType):
        return rt.array(*[build_value(type_.element, numbers) for _ in range(type_.length)])
    return numbers(shape_of(type_), kind_of(type_))


def narrow(value: Value, chosen: Array, lanes: int) -> Value:
    """The value in the chosen lanes, which are numbers."""
    if isinstance(value, rt.Record):
        return rt.Record(**{name: narrow(part, chosen, lanes) for name, part in vars(value).items()})
    return value[..., chosen] if np.shape(value)[-1:] == (lanes,) else value


def widen(old: Value, new: Value, chosen: Array, lanes: int) -> Value:
    """A value of all lanes: the new one in the chosen lanes, the old one in the others."""
    if isinstance(new, rt.Record):
        return rt.Record(**{name: widen(getattr(old, name), part, chosen, lanes) for name, part in vars(new).items()})
    wide = np.empty((*np.shape(new)[:-1], lanes), new.dtype)
    wide[...] = old
    wide[..., chosen] = new
    return wide.view(type(new))


def is_readable(texture: Texture, coord: Array) -> Array:
    """Where drivers agree on a read: not far away, where a texel is less than the last place, nor beyond the layers."""
    axes = texture.axes
    holds = np.abs(coord[:axes]).max(axis=0) <= (LARGEST if texture.dim == "Cube" else FAR)
    if texture.layers:
        holds = holds & (coord[axes] > -0.5) & (coord[axes] < len(texture.levels[0]) - 0.5)
    if texture.compare and len(coord) > axes:
        holds = holds & (coord[-1] >= 0.0) & (coord[-1] <= 1.0)
    return np.asarray(holds)


def spread_to_quads(lanes: Array, shape: calls.Grid) -> Array:
    """The lanes of all quads in which one of these lanes is."""
    image = np.zeros((shape.rows, shape.width + shape.width % 2), bool)
    flat = np.zeros(shape.rows * shape.width, bool)
    flat[: len(lanes)] = lanes
    image[:, : shape.width] = flat.reshape(shape.rows, shape.width)
    quads = image.reshape(shape.rows // 2, 2, -1, 2).any(axis=(1, 3))
    image = np.repeat(np.repeat(quads, 2, axis=0), 2, axis=1)[:, : shape.width]
    spread: Array = image.reshape(-1)[: len(lanes)]
    return spread
