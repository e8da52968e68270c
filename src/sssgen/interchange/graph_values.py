"""The values that a graph of a MaterialX document has: constants, pictures, texture coordinates, normals.

A node computes with constants, or with the texels of pictures that are placed alike. Everything else, such as noise at
a position, has no form in a material: its mean takes its place, and `cause` names the node.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.interchange.surface_model import Image, Picture, Quantity, UvTransform, Wrap
from sssgen.interchange.texels import Texels, read_texels, resize, values_on
from sssgen.scene.pictures.images import encode_srgb, png_bytes

MAX_SIDE = 2048
"""Texels on a side of a computed picture; larger ones are computed at this size."""

Array: TypeAlias = npt.NDArray[Any]


class Placement(NamedTuple):
    """Where the texels of a picture are."""

    uv_set: int
    transform: UvTransform
    wrap: Wrap


@dataclass(frozen=True)
class Constant:
    """One number, or several: a vector, a colour, or a matrix in rows."""

    values: tuple[float, ...]
    cause: str = ""


@dataclass(frozen=True)
class Texture:
    """A picture as it is in its file, some of its channels, times constants."""

    quantity: Quantity
    cause: str = ""

    @property
    def image(self) -> Image:
        """The picture."""
        assert self.quantity.image is not None
        return self.quantity.image

    @property
    def placement(self) -> Placement:
        """Where its texels are."""
        return Placement(self.image.uv_set, self.image.transform, self.image.wrap)


@dataclass(frozen=True)
class TexelGrid:
    """Texels that nodes computed, linear, (height, width, components)."""

    texels: Texels
    placement: Placement
    cause: str = ""


@dataclass(frozen=True)
class Coordinates:
    """Texture coordinates matrix · uv + offset, v up."""

    uv_set: int = 0
    matrix: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    offset: tuple[float, float] = (0.0, 0.0)
    cause: str = ""

    @property
    def transform(self) -> UvTransform | None:
        """The same as tiling, rotation and offset; None where the axes are not perpendicular."""
        (a, b), (c, d) = self.matrix
        tiling = math.hypot(a, c)
        if tiling == 0.0 or abs(a * b + c * d) > 1e-5 * tiling * max(math.hypot(b, d), 1e-9):
            return None
        return UvTransform((tiling, (a * d - b * c) / tiling), self.offset, math.degrees(math.atan2(c, a)))


@dataclass(frozen=True)
class Normal:
    """The surface's normal; with the texels of a normal map, times its strength, where there is one."""

    texels: Texture | TexelGrid | None = None
    strength: float = 1.0
    cause: str = ""


@dataclass(frozen=True)
class Words:
    """A text or a file's name, and the element that has it."""

    text: str
    element: Any
    cause: str = ""


Value: TypeAlias = Constant | Texture | TexelGrid | Coordinates | Normal | Words
Textured: TypeAlias = Texture | TexelGrid


def mean(value: Value) -> tuple[float, ...]:
    """The mean of a value, one number per component."""
    if isinstance(value, Constant):
        return value.values
    if isinstance(value, Texture | TexelGrid):
        texels = _texels(value, _size([value]))
        return tuple(texels.reshape(-1, texels.shape[-1]).mean(axis=0, dtype=np.float64).tolist())
    return (0.0, 0.0, 1.0) if isinstance(value, Normal) else (0.5, 0.5)


def estimate(value: Value, cause: str) -> Constant:
    """The mean in place of a value that a material cannot express because of the node `cause`."""
    return Constant(mean(value), value.cause or cause)


def pointwise(function: Callable[..., Array], operands: Sequence[Value], node: str) -> Constant | TexelGrid:
    """A function of arrays, whose last axis are the components, on each texel. `node` is named where it is a mean."""
    cause = next((operand.cause for operand in operands if operand.cause), "")
    textures = [operand for operand in operands if isinstance(operand, Texture | TexelGrid)]
    if any(not isinstance(operand, Constant | Texture | TexelGrid) for operand in operands):
        textures, cause = [], cause or node
    if len({texture.placement for texture in textures}) > 1:
        textures, cause = [], cause or node
    with np.errstate(all="ignore"):
        if not textures:
            result = function(*(np.asarray(mean(operand), np.float64) for operand in operands))
            return Constant(tuple(np.nan_to_num(np.atleast_1d(result)).tolist()), cause)
        size = _size(textures)
        arrays = [
            _texels(operand, size)
            if isinstance(operand, Texture | TexelGrid)
            else np.asarray(mean(operand), np.float32)
            for operand in operands
        ]
        texels = np.nan_to_num(np.asarray(function(*arrays), np.float32))
    return TexelGrid(texels, textures[0].placement, cause)


def scale_texture(texture: Texture, factors: Sequence[float], cause: str = "") -> Texture:
    """A picture times constants, one or one for each component."""
    factor = texture.quantity.factor
    each = tuple(factors) if len(factors) > 1 else tuple(factors) * len(factor)
    product = tuple(a * b for a, b in zip(factor, each, strict=True))
    return Texture(texture.quantity._replace(factor=product), texture.cause or cause)


def select_components(value: Value, places: Sequence[int], node: str) -> Value:
    """Some components of a value, in another order or repeated."""
    if isinstance(value, Texture) and max(places) < len(value.image.channels):
        channels = "".join(value.image.channels[place] for place in places)
        factor = tuple(value.quantity.factor[place] for place in places)
        return Texture(Quantity(factor, value.image._replace(channels=channels)), value.cause)
    return pointwise(lambda array: array[..., [min(place, array.shape[-1] - 1) for place in places]], [value], node)


def join_components(values: Sequence[Value], node: str) -> Value:
    """The components of several values, one after the other."""
    first = values[0]
    if isinstance(first, Texture):
        same = [value for value in values if isinstance(value, Texture)]
        alike = {value.image._replace(channels="") for value in same}
        if len(same) == len(values) and len(alike) == 1:
            channels = "".join(value.image.channels for value in same)
            factor = tuple(part for value in same for part in value.quantity.factor)
            cause = next((value.cause for value in same if value.cause), "")
            return Texture(Quantity(factor, first.image._replace(channels=channels)), cause)
    return pointwise(_concatenate, values, node)


def quantity_of(value: Value, name: str, color: bool, most: float = 1.0) -> Quantity:
    """A value as a quantity of the record; `name` is that of the picture which is written for computed texels.

    Constants and computed texels are limited to 0 and `most`.
    """
    if isinstance(value, Texture):
        return value.quantity
    if isinstance(value, TexelGrid):
        components = value.texels.shape[-1]
        largest = min(max(float(value.texels.max()), 1.0), most)
        texels = np.clip(value.texels / largest, 0.0, 1.0)
        content = png_bytes(encode_srgb(texels) if color else texels)
        channels = "rgba"[:components] if components > 2 else "ra"[:components]
        image = Image(Picture(f"{name}.png", content), channels, color, *value.placement)
        return Quantity((largest,) * components, image)
    return Quantity(tuple(min(max(part, 0.0), most) for part in mean(value)))


def with_cause(value: Value, cause: str) -> Value:
    """The value, estimated because of a node."""
    return replace(value, cause=value.cause or cause)


def _concatenate(*arrays: Array) -> Array:
    shape = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    return np.concatenate([np.broadcast_to(array, (*shape, array.shape[-1])) for array in arrays], axis=-1)


def _size(textures: Sequence[Textured]) -> tuple[int, int]:
    """The width and height on which texels are computed."""
    shapes = [
        value.texels.shape[:2] if isinstance(value, TexelGrid) else read_texels(value.image.picture).shape[:2]
        for value in textures
    ]
    heights, widths = zip(*shapes, strict=True)
    return min(max(widths), MAX_SIDE), min(max(heights), MAX_SIDE)


def _texels(value: Textured, size: tuple[int, int]) -> Texels:
    if isinstance(value, TexelGrid):
        return resize(value.texels, size)
    return values_on(value.quantity, size)
