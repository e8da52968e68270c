"""The textures that a program draws of the body (ir/view_textures.py), cast on the CPU."""

from __future__ import annotations

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.bounds import world_corners
from sssgen.scene.geometry import Geometry
from sssgen.scene.inside_intervals import in_object_space, intervals
from sssgen.scene.light_view import LightView, directional_view, point_view

BLOCK = 1 << 18
"""The number of rays that are cast at once: many, as a march goes on for its last ray with few rays left."""
TEXELS = 512
"""Width and height of a light's depth map."""


def back_faces(geometry: Geometry, origin: Array, directions: Array) -> Array:
    """The distance from the eye at `origin` (3,) to the nearest back face along each ray, (n,); 0 without one."""
    nearest = _nearest(geometry, np.broadcast_to(origin, directions.shape), directions, 1)[:, 0]
    result: Array = np.where(np.isfinite(nearest), nearest, 0.0)
    return result


def light_depth(geometry: Geometry, light: Array, layers: bool = False) -> tuple[LightView, Array]:
    """The view of a light, (4,): w = 1 where it is, w = 0 the unit direction towards it; and its map.

    The map is (rows, columns, 1); with `layers` it has the first entry, the first exit and the second entry: (rows,
    columns, 3). A texel without a surface has the depth of the body's end, as a larger step would be blurred
    differently by filters. Raises SssgenError for a light at the body.
    """
    corners, size = world_corners(geometry), (TEXELS, TEXELS)
    view = point_view(corners, light[:3], size) if light[3] else directional_view(corners, light[:3], size)
    distances = _nearest(geometry, view.origins, view.directions, 0, 2 if layers else 1)
    if layers:
        distances = np.insert(distances, 1, _nearest(geometry, view.origins, view.directions, 1)[:, 0], axis=1)
    end = float((corners @ view.matrix[2, :3] + view.matrix[2, 3]).max())
    view = view._replace(far=end)
    depth = np.where(np.isfinite(distances), distances * view.slopes[:, None], end)
    return view, depth.reshape(TEXELS, TEXELS, -1)


def _nearest(geometry: Geometry, origins: Array, directions: Array, side: int, count: int = 1) -> Array:
    """The distances to the nearest entries (side 0) or exits (1) in front of each origin, (n, count); inf for none."""
    nearest = np.full((len(directions), count), np.inf)
    needed = 2 * count - 1 + side
    for start in range(0, len(directions), BLOCK):
        part = slice(start, start + BLOCK)
        ends = geometry.scale * intervals(geometry, *in_object_space(geometry, origins[part], directions[part]), needed)
        ahead = (ends[..., 0] < ends[..., 1]) & (ends[..., side] > 0.0)
        distances = np.sort(np.where(ahead, ends[..., side], np.inf), axis=1)[:, :count]
        nearest[part, : distances.shape[1]] = distances
    return nearest
