"""Random inputs for functions of which only the types are known.

Floats are in [-2, 2] or in [0, 1], and some are exactly 0, 1 or -1. Integers are small and not negative, as they are
often the trip count of a loop. Well-known names have ranges of their own: times, sizes of the picture.
"""

from __future__ import annotations

from zlib import crc32

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.evaluate.evaluation import shape_of
from sssgen.harness.evaluate.random_inputs import texture
from sssgen.ir.types import Sampler, Type, kind_of
from sssgen.targets.runtime.numpy_textures import Texture

SPECIAL, WITHIN = 0.12, 0.5
"""The shares of numbers that are 0, 1 or -1, and of those in [0, 1]."""
INTEGER_LIMIT = 8
"""Integers are below this."""

RANGES = {
    "iResolution": (32.0, 64.0), "iTime": (0.0, 20.0), "iGlobalTime": (0.0, 20.0), "iTimeDelta": (0.01, 0.02),
    "iMouse": (0.0, 64.0), "iFrameRate": (30.0, 60.0), "fragCoord": (0.0, 64.0), "sssgen_coordinates": (0.0, 64.0),
    "u_resolution": (32.0, 64.0), "u_time": (0.0, 20.0), "u_mouse": (0.0, 64.0),
}  # fmt: skip
"""The ranges of Shadertoy's inputs and similar ones: pixels and seconds."""


def numbers(name: str, type_: Type, lanes: int, seed: int) -> Array:
    """`lanes` values of a scalar, vector or matrix type, lanes last; floats are exact in float32.

    They depend on the name, the type and the seed only.
    """
    rng = _rng(f"{name} {type_}", seed)
    shape = (*shape_of(type_), lanes)
    kind = kind_of(type_)
    if kind == "bool":
        return rng.random(shape) < 0.5
    if kind != "float":
        return rng.integers(0, INTEGER_LIMIT, shape).astype(np.int32 if kind == "int" else np.uint32)
    if ends := RANGES.get(name):
        values = rng.uniform(*ends, shape)
    else:
        chance = rng.random(shape)
        values = np.where(chance < WITHIN, rng.uniform(0.0, 1.0, shape), rng.uniform(-2.0, 2.0, shape))
        values = np.where(chance > 1.0 - SPECIAL, rng.choice([0.0, 1.0, -1.0], shape), values)
    return values.astype(np.float32).astype(np.float64)


def picture(name: str, type_: Sampler, seed: int) -> Texture:
    """A small texture: one half is smooth, the other has hard edges; in 3-D a distance field."""
    return texture(type_.dim, _rng(name, seed))


def _rng(name: str, seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, crc32(name.encode())])
