"""Random inputs for functions of which nothing is known but their types.

Numbers lie in [-2, 2] or in [0, 1], and some are exactly 0, 1 or -1. Whole numbers are small and not negative, for they
are often the rounds of a loop. A few names say what a shader's host gives: times, sizes of the picture.
"""

from __future__ import annotations

from zlib import crc32

import numpy as np

from sssgen.harness.backends import Array
from sssgen.harness.evaluate.evaluation import shape_of
from sssgen.harness.evaluate.random_inputs import texture
from sssgen.ir.types import Sampler, Type, kind_of
from sssgen.targets.numpy_textures import Texture

SPECIAL, WITHIN = 0.12, 0.5
"""The shares of numbers that are 0, 1 or -1, and of those in [0, 1]."""
MOST = 8
"""Whole numbers are below this."""

RANGES = {
    "iResolution": (32.0, 64.0), "iTime": (0.0, 20.0), "iGlobalTime": (0.0, 20.0), "iTimeDelta": (0.01, 0.02),
    "iMouse": (0.0, 64.0), "iFrameRate": (30.0, 60.0), "fragCoord": (0.0, 64.0), "sssgen_coordinates": (0.0, 64.0),
    "u_resolution": (32.0, 64.0), "u_time": (0.0, 20.0), "u_mouse": (0.0, 64.0),
}  # fmt: skip
"""What Shadertoy's scenes and others like them are given: pixels and seconds."""


def numbers(name: str, type_: Type, lanes: int, seed: int) -> Array:
    """`lanes` values of a scalar, vector or matrix type, lanes last, in numbers that float32 has.

    They depend on the name, the type and the seed alone.
    """
    rng = _rng(f"{name} {type_}", seed)
    shape = (*shape_of(type_), lanes)
    kind = kind_of(type_)
    if kind == "bool":
        return rng.random(shape) < 0.5
    if kind != "float":
        return rng.integers(0, MOST, shape).astype(np.int32 if kind == "int" else np.uint32)
    if ends := RANGES.get(name):
        found = rng.uniform(*ends, shape)
    else:
        chance = rng.random(shape)
        found = np.where(chance < WITHIN, rng.uniform(0.0, 1.0, shape), rng.uniform(-2.0, 2.0, shape))
        found = np.where(chance > 1.0 - SPECIAL, rng.choice([0.0, 1.0, -1.0], shape), found)
    return found.astype(np.float32).astype(np.float64)


def picture(name: str, type_: Sampler, seed: int) -> Texture:
    """A small texture: a smooth half and a hard one; in 3-D a distance field."""
    return texture(type_.dim, _rng(name, seed))


def _rng(name: str, seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, crc32(name.encode())])
