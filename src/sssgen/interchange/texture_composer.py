"""Composes the textures of a material from the images of its quantities, in the channels that techniques read."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sssgen.interchange.surface_model import Image, Quantity, SurfaceModel, UvTransform, Wrap
from sssgen.interchange.texels import Texels, mean_of, read_texels, resize, texel_values, values_on
from sssgen.scene.pictures.images import encode_srgb, png_bytes

FOLDER = "textures"
_QUICKLY = 1
"""The level of compression: an import has dozens of large textures; photographs are hardly larger than at level 6."""


class Coordinates(NamedTuple):
    """A set of texture coordinates of the file, and how it is transformed."""

    uv_set: int = 0
    transform: UvTransform = UvTransform()


class ComposedTexture(NamedTuple):
    """A texture that was composed."""

    file: str
    """Relative to the material"""
    uv: str
    """`uv` or `uv2`, the set that its stage reads"""
    wrap: Wrap


class Composer:
    """The textures of one material.

    A material has two sets of texture coordinates. They are the two pairs of set and transform that most images have;
    an image with another pair is replaced by its mean.
    """

    def __init__(self, model: SurfaceModel) -> None:
        images = images_of(model)
        counted = Counter(coordinates(image) for image in images.values())
        self.sets = [pair for pair, _ in counted.most_common(2)] or [Coordinates()]
        """The coordinates that `uv` and `uv2` have"""
        self.files: dict[str, bytes] = {}
        self.substitutions: dict[str, str] = {}
        """Field of the model → why its image is replaced by a mean"""
        self.fields = {image: field for field, image in images.items()}

    def usable_quantity(self, quantity: Quantity) -> Quantity:
        """The quantity; with its mean where its image has a third pair of set and transform."""
        if quantity.image is None or coordinates(quantity.image) in self.sets:
            return quantity
        self.substitutions[self.fields[quantity.image]] = (
            "the mean of its picture: a material has two sets of coordinates"
        )
        return Quantity(mean_of(quantity))

    def align(self, *quantities: Quantity) -> list[Quantity]:
        """The quantities for one texture: those whose image is placed like the first one's, and means of the others."""
        usable = [self.usable_quantity(quantity) for quantity in quantities]
        first = next((coordinates(quantity.image) for quantity in usable if quantity.image), None)
        result = []
        for quantity in usable:
            if quantity.image is not None and coordinates(quantity.image) != first:
                reason = "the mean of its picture: it is combined with a picture that has other coordinates"
                self.substitutions[self.fields[quantity.image]] = reason
                quantity = Quantity(mean_of(quantity))
            result.append(quantity)
        return result

    def pack(self, name: str, quantities: Sequence[Quantity], srgb: bool = False) -> ComposedTexture | None:
        """A texture whose channels are the quantities' components in turn, without their factors.

        None where no quantity has an image. `srgb`: the first three channels are encoded.
        """
        images = [quantity.image for quantity in quantities if quantity.image is not None]
        if not images:
            return None
        size = _size(images)
        layers = []
        for quantity in quantities:
            if quantity.image is None:
                layers.append(np.ones((size[1], size[0], len(quantity.factor)), np.float32))
            else:
                encode = srgb and not layers
                layers.append(resize(_encode(quantity.image) if encode else texel_values(quantity.image), size))
        return self._write(name, np.concatenate(layers, axis=-1), images[0])

    def write_values(self, name: str, values: Texels, like: Image, srgb: bool = False) -> ComposedTexture:
        """A texture of computed linear values, (height, width, channels), placed like an image."""
        stored_values = values
        if srgb:
            stored_values = np.concatenate([encode_srgb(values[..., :3]), values[..., 3:]], axis=-1).astype(np.float32)
        return self._write(name, stored_values, like)

    def grid(self, *quantities: Quantity) -> tuple[list[Texels], Image] | None:
        """The values of quantities on a common grid, and the image that places it; None where all are constants."""
        images = [quantity.image for quantity in quantities if quantity.image is not None]
        return ([values_on(quantity, _size(images)) for quantity in quantities], images[0]) if images else None

    def _write(self, name: str, values: Texels, like: Image) -> ComposedTexture:
        file = f"{FOLDER}/{name}.png"
        self.files[file] = png_bytes(values, level=_QUICKLY)
        return ComposedTexture(file, "uv" if coordinates(like) == self.sets[0] else "uv2", like.wrap)


def _encode(image: Image) -> Texels:
    """The values of a texture that is encoded as sRGB; unchanged where the picture has exactly these."""
    if image.srgb and (image.scale, image.bias) == (1.0, 0.0):
        return read_texels(image.picture)[..., ["rgba".index(channel) for channel in image.channels]]
    return encode_srgb(texel_values(image)).astype(np.float32)


def _size(images: Sequence[Image]) -> tuple[int, int]:
    """The width and height of a grid that has the detail of all images."""
    heights, widths = zip(*(read_texels(image.picture).shape[:2] for image in images), strict=True)
    return max(widths), max(heights)


def coordinates(image: Image) -> Coordinates:
    """Where an image is placed."""
    return Coordinates(image.uv_set, image.transform)


def images_of(model: SurfaceModel) -> dict[str, Image]:
    """Field of the model → its image."""
    quantities = {field: value for field, value in vars(model).items() if isinstance(value, Quantity)}
    return {field: quantity.image for field, quantity in quantities.items() if quantity.image is not None}
