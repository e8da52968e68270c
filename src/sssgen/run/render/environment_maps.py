"""The cube maps of a scene's surroundings that a shell reads: irradiance, and reflections by roughness.

Split sum with the view from the front: Karis, Real Shading in Unreal Engine 4, 2013. Each texel is an integral over all
pixels of the picture, weighted with their solid angles; there are no random samples.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.scene.environment import Environment
from sssgen.targets.runtime.numpy_textures import Texture, cube_directions

Array = npt.NDArray[Any]

IRRADIANCE_SIDE = 16
REFLECTION_SIDE = 64
LEVELS = 5
"""Of the reflections: roughness 0, 1/4, 1/2, 3/4 and 1. The last has faces of 4 × 4 texels."""
_BLOCK = 1 << 17
"""The number of weights that are computed at once."""


@lru_cache(4)
def irradiance_map(environment: Environment) -> Texture:
    """The mean light over the hemisphere around each direction, weighted with the cosine."""
    pixels, ways, angles = _pixels(environment, 2 * IRRADIANCE_SIDE)

    def cosine(facing: Array) -> Array:
        result: Array = np.maximum(facing, 0.0)
        return result

    return Texture(_mean(IRRADIANCE_SIDE, pixels, ways, angles, cosine), wrap="clamp", dim="Cube")


@lru_cache(4)
def reflection_map(environment: Environment, face: int = REFLECTION_SIDE) -> Texture:
    """The light in a mirror: level i is for the roughness i / (LEVELS - 1). The faces have `face`² texels."""
    levels = [_sharp(environment, face)]
    for number in range(1, LEVELS):
        side = face >> number
        pixels, ways, angles = _pixels(environment, max(2 * side, 32))
        alpha = (number / (LEVELS - 1)) ** 2

        def mirrored(facing: Array, alpha: float = alpha) -> Array:
            """GGX's density of the light at this cosine to the mirrored direction, times that cosine."""
            halfway = 0.5 + 0.5 * facing  # the square of the cosine to the half vector
            spread = halfway * (alpha * alpha - 1.0) + 1.0
            result: Array = np.maximum(facing, 0.0) / (spread * spread)
            return result

        levels.append(_mean(side, pixels, ways, angles, mirrored))
    return Texture.of_levels(levels, wrap="clamp", dim="Cube")


def _sharp(environment: Environment, side: int) -> Array:
    """The light itself: the mean of 4 × 4 places in each texel."""
    fine = 4 * side
    light = environment.sky()(cube_directions(fine).reshape(-1, 3)).reshape(6, side, 4, side, 4, 3)
    result: Array = light.mean(axis=(2, 4))
    return result


def _pixels(environment: Environment, height: int) -> tuple[Array, Array, Array]:
    """The light, directions and solid angles of a picture of this height or less: (n, 3), (n, 3) and (n,)."""
    values = environment.values()
    while values.shape[0] > height and values.shape[0] % 2 == 0 and values.shape[1] % 2 == 0:
        values = 0.25 * (values[::2, ::2] + values[1::2, ::2] + values[::2, 1::2] + values[1::2, 1::2])
    rows, columns = (count * max(1, -(-height // count)) for count in values.shape[:2])
    columns = max(columns, 2 * height)
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    y = (v.ravel() * values.shape[0]).astype(int)
    x = (u.ravel() * values.shape[1]).astype(int)
    polar, around = np.pi * v.ravel(), 2.0 * np.pi * (u.ravel() - 0.5)
    ways = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=1)
    edges = np.cos(np.pi * np.arange(rows + 1) / rows)
    angles = np.repeat((edges[:-1] - edges[1:]) * 2.0 * np.pi / columns, columns)
    return values[y, x], ways, angles


def _mean(side: int, pixels: Array, ways: Array, angles: Array, weight: Callable[[Array], Array]) -> Array:
    """(6, side, side, 3): the mean of the pixels around each texel's direction, weighted by the cosine between them."""
    directions, across = cube_directions(side).reshape(-1, 3).astype(np.float32), ways.T.astype(np.float32)
    # the light and, last, the weight itself, in single precision as the weights: the products are most of the time
    summed = (np.column_stack([pixels, np.ones(len(pixels))]) * angles[:, None]).astype(np.float32)
    result = np.zeros((len(directions), 3))
    step = max(1, _BLOCK // len(ways))
    for start in range(0, len(directions), step):
        part = slice(start, start + step)
        sums = (weight(directions[part] @ across) @ summed).astype(np.float64)
        result[part] = sums[:, :3] / sums[:, 3:]
    return result.reshape(6, side, side, 3)
