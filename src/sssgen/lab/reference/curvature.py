"""Normal curvatures of a body's surface, by second differences of its distance: positive where it is convex.

Exact distance functions give the curvature itself; for meshes and edges it is the mean over the step's length.
"""

from __future__ import annotations

import numpy as np

from sssgen.run.backends import Array
from sssgen.scene.geometry import Geometry


def normal_curvature(geometry: Geometry, positions: Array, directions: Array, step: float) -> Array:
    """The curvature 1 / radius along unit tangents at surface points, (n,); both (3, n) in world space.

    `step` is the distance of the two outer points, in world units.
    """
    to_object = geometry.to_object()
    along = step * (to_object[:3, :3] @ directions)
    at = to_object[:3, :3] @ positions + to_object[:3, 3:]
    distance = geometry.distance
    second: Array = distance((at + along).T) + distance((at - along).T) - 2.0 * distance(at.T)
    return np.asarray(geometry.scale * second / step**2)
