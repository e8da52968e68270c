"""The length of a line inside a body: exact thickness in a direction, the target of every thickness technique.

A concave body, or one with gaps, has several intervals; thickness is the sum of their lengths.
"""

from __future__ import annotations

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.geometry import Geometry
from sssgen.scene.inside_intervals import in_object_space, intervals, lengths_ahead

SURFACE = 1e-4
"""Intervals that begin within this part of the points' extent begin at the surface."""


def thickness(geometry: Geometry, origins: Array, directions: Array) -> Array:
    """The length inside the body from `origins` along unit `directions`, (n, 3) each, in world space: (n,).

    Parts behind the origin do not count. Raises SssgenError for a mesh that cannot be read.
    """
    starts, rays = in_object_space(geometry, origins, directions)
    return geometry.scale * lengths_ahead(geometry, starts, rays)


def first_exit(geometry: Geometry, origins: Array, directions: Array) -> Array:
    """The length from surface points into the body to the first exit, as `thickness`; 0 if the ray does not enter."""
    starts, rays = in_object_space(geometry, origins, directions)
    size = float(np.ptp(origins, axis=0).max(initial=0.0)) or 1.0
    least = SURFACE * size / geometry.scale
    parts = np.maximum(intervals(geometry, starts, rays), 0.0)
    entered = (parts[..., 0] < least) & (parts[..., 1] > least)
    length: Array = geometry.scale * np.where(entered, parts[..., 1], 0.0).max(axis=1)
    return length
