"""The encoding of distances in a texture, and its error."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.bake.voxel_distance import Distances
from sssgen.scene.pictures import volumes
from sssgen.scene.pictures.volumes import Encoding
from sssgen.scene.scene import encode_distance

ENCODINGS = {encoding.name: encoding for encoding in volumes.ENCODINGS if encoding.channels == 1}
"""By the names of the command line: unsigned normalised integers, and floats."""


def encode(distance: Distances, inside: npt.NDArray[np.bool_], reach: float, encoding: Encoding) -> npt.NDArray[Any]:
    """The texels of unsigned distances, (z, y, x)."""
    texels = np.empty(distance.shape, encoding.dtype)
    for layer in range(len(distance)):  # layer by layer, because the intermediate values are float64
        value = encode_distance(np.where(inside[layer], -1.0, 1.0) * distance[layer], reach)
        texels[layer] = np.rint(value * encoding.unit) if encoding.dtype.kind == "u" else value
    return texels


def error_at_texels(reach: float, encoding: Encoding, diagonal: float) -> float:
    """The largest error of a decoded distance up to `reach`: half a step plus the rounding of the distances."""
    step = 1.0 / encoding.unit if encoding.dtype.kind == "u" else 0.5 * float(np.finfo(encoding.dtype).eps)
    return reach * step + 2.0**-23 * diagonal
