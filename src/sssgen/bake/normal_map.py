"""Normal maps from heights."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.support.diagnostics import did_you_mean, failure

Array: TypeAlias = npt.NDArray[np.float64]

GREENS = ("opengl", "directx")


def from_height(height: Array, strength: float, tileable: bool = True, green: str = "opengl") -> Array:
    """The tangent-space normals of heights (height, width), as colours 0..1, (height, width, 3), row 0 at the top.

    strength: the height of white (1) above black (0), in widths of the picture; negative for depths. Texels are square.
    Slopes are central differences of texels, which wrap around if tileable, and otherwise one-sided at the border.

    n = normalize(-dh/du, -dh/dv, 1), v up, is stored as 0.5 n + 0.5, as glTF 2.0 and the technique normal_map expect.
    green: "opengl", slopes that face up (+v) are greener; "directx", those that face down. In 8 bits a flat normal
    becomes (128, 128, 255), as usual: 128 is half a step from 0.5, a constant tilt of 0.3 degrees. With 16 bits the
    tilt is 0.001 degrees.

    Raises SssgenError for a wrong shape, values that are not finite, and an unknown convention of green.
    """
    if green not in GREENS:
        raise failure(
            f"'{green}' is not a convention of the green channel", did_you_mean(green, GREENS) or ", ".join(GREENS)
        )
    if height.ndim != 2 or 0 in height.shape:
        raise failure(f"an array of shape {height.shape} has no heights", "(height, width)")
    if not math.isfinite(strength):
        raise failure(f"the normals' strength is {strength}", "a finite number: height in widths of the picture")
    if not np.isfinite(height).all():
        raise failure("some heights are not finite numbers", "repair the picture")
    per_texel = strength * height.shape[1]
    up = 1.0 if green == "opengl" else -1.0
    normals = np.empty((*height.shape, 3))
    normals[..., 0] = -per_texel * _difference(height, 1, tileable)
    normals[..., 1] = up * per_texel * _difference(height, 0, tileable)  # rows run down, so this is -dh/dv
    normals[..., 2] = 1.0
    normals /= np.sqrt(np.einsum("...i,...i", normals, normals))[..., None]
    normals *= 0.5
    normals += 0.5
    return normals


def _difference(height: Array, axis: int, tileable: bool) -> Array:
    """The increase of the height per texel along an axis."""
    if height.shape[axis] == 1:
        return np.zeros_like(height)
    if tileable:
        return 0.5 * (np.roll(height, -1, axis) - np.roll(height, 1, axis))
    slope: Array = np.gradient(height, axis=axis)
    return slope
