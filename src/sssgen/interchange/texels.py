"""Reads the pictures of foreign materials, and computes the values that a quantity has in each texel."""

from __future__ import annotations

import io
import warnings
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.interchange.surface_model import Image, Picture, Quantity
from sssgen.scene.pictures.images import LARGEST_SIDE, decode_srgb
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need

Texels = npt.NDArray[np.float32]

_FORMATS = ["PNG", "JPEG", "WEBP", "TIFF", "TGA", "BMP"]


@lru_cache(maxsize=4)
def read_texels(picture: Picture) -> Texels:
    """The stored values 0..1 of a picture, (height, width, 4), row 0 at the top. A missing alpha is 1.

    Raises SssgenError for a picture that cannot be read or is too large.
    """
    pillow = need("PIL.Image", "pillow")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pillow.open(io.BytesIO(picture.content), formats=_FORMATS) as image:
                if max(image.size) > LARGEST_SIDE:
                    raise failure(f"the picture has more than {LARGEST_SIDE} texels on a side", file=picture.name)
                image.load()
                return _as_four(image)
    except pillow.UnidentifiedImageError:
        hint = f"readable formats are {', '.join(_FORMATS)}"
        raise failure("the format of this picture is unknown", hint, picture.name) from None
    except (OSError, SyntaxError, ValueError, Warning, MemoryError, pillow.DecompressionBombError) as error:
        raise failure(f"the picture cannot be read: {error}", "export it again", picture.name) from None


def _as_four(image: Any) -> Texels:
    if image.mode.startswith("I"):  # 16 bits of grey
        grey = np.clip(np.asarray(image, np.float64) / 65535.0, 0.0, 1.0)
        return np.stack([grey, grey, grey, np.ones_like(grey)], axis=-1).astype(np.float32)
    values: Texels = np.asarray(image.convert("RGBA"), np.float32) / np.float32(255.0)
    return values


def texel_values(image: Image) -> Texels:
    """What an image contributes to its quantity, (height, width, components): decoded, scaled and moved."""
    places = ["rgba".index(channel) for channel in image.channels]
    values = read_texels(image.picture)[..., places]
    if image.srgb:
        color = np.array([channel != "a" for channel in image.channels])
        values = np.where(color, decode_srgb(values), values)
    return np.asarray(image.scale * values + image.bias, np.float32)


def values_on(quantity: Quantity, size: tuple[int, int]) -> Texels:
    """The quantity in each texel of a grid of width × height, (height, width, components)."""
    width, height = size
    factor = np.asarray(quantity.factor, np.float32)
    if quantity.image is None:
        return np.broadcast_to(factor, (height, width, len(factor)))
    return factor * resize(texel_values(quantity.image), size)


def resize(values: Texels, size: tuple[int, int]) -> Texels:
    """The values on another grid, by bilinear interpolation."""
    width, height = size
    if values.shape[:2] == (height, width):
        return values
    pillow = need("PIL.Image", "pillow")
    layers = [
        np.asarray(
            pillow.fromarray(np.ascontiguousarray(values[..., index])).resize(size, pillow.Resampling.BILINEAR),
            np.float32,
        )
        for index in range(values.shape[-1])
    ]
    return np.stack(layers, axis=-1)


def mean_of(quantity: Quantity) -> tuple[float, ...]:
    """The quantity's mean over its texels, per component."""
    if quantity.image is None:
        return quantity.factor
    mean = texel_values(quantity.image).reshape(-1, len(quantity.factor)).mean(axis=0, dtype=np.float64)
    return tuple(float(factor * part) for factor, part in zip(quantity.factor, mean, strict=True))
