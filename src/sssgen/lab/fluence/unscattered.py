"""Light inside a body that has not been scattered: exact, as texels like those of scattered light."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from sssgen.lab.fluence.traced_body import projection_of, tracer
from sssgen.scene.measured.measured_scene import MeasuredScene

Array = npt.NDArray[np.float64]


def shares(scene: MeasuredScene, towards: Array, extinctions: Sequence[float], voxels: int) -> Array:
    """The texels of the share of light from the directions `towards` (d, 3) that arrives, for each extinction, in the
    units of object space: (extinctions, d, counting voxels)."""
    projection, rays = projection_of(scene, voxels), tracer(scene, voxels)
    points = projection.points(rays.grid)
    texels = []
    for direction in towards:
        lengths = rays.lengths(points, direction[None])[:, 0].astype(np.float64)
        arriving = np.exp(-np.outer(extinctions, lengths))
        texels.append(projection.texels(projection.integrals(arriving)))
    return np.stack(texels, axis=1)


def trace_shares(
    scene: MeasuredScene, towards: tuple[tuple[float, float, float], ...], extinction: float, voxels: int
) -> np.ndarray:
    """The same of one extinction, as a work item: (d, counting voxels) in float32."""
    texels: np.ndarray = shares(scene, np.array(towards), [extinction], voxels)[0].astype(np.float32)
    return texels
