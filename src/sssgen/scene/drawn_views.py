"""The textures that a program draws of the body (ir/frame_passes.py), cast on the CPU."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sssgen.ir.frame_passes import DISTANT_VIEWS, FAR, FRAME_PASSES
from sssgen.scene.arrays import Array
from sssgen.scene.bounds import world_corners
from sssgen.scene.geometry import Geometry
from sssgen.scene.inside_intervals import in_object_space, intervals
from sssgen.scene.light_view import LightView, directional_view, point_view

BLOCK = 1 << 18
"""The number of rays that are cast at once: many, as a march goes on for its last ray with few rays left."""
SIDES = ("entry", "exit")
"""The ends of an interval inside a body, in the order of `intervals`."""
SHADOW_BIAS = 1e-3
"""How far above the surface the rays of shadows start, in diagonals of the body's box."""
TEXELS = 512
"""Width and height of a light's depth map."""
TILES = 2
"""The number of tiles along a side of a map for several lights."""


def eye_layers(geometry: Geometry, origin: Array, directions: Array, name: str) -> Array:
    """The distances from the eye at `origin` (3,) along each ray that the pass `name` draws, (n, layers)."""
    drawn = FRAME_PASSES[name]
    distances = _distances(geometry, np.broadcast_to(origin, directions.shape), directions, drawn.layers)
    result: Array = np.where(np.isfinite(distances), distances, FAR if drawn.empty == "far" else 0.0)
    return result


def matt_light(geometry: Geometry, points: Array, normals: Array, lights: Array, colors: Array) -> Array:
    """What a white matt surface in place of a body reflects of lights (k, 4) with colours (k, 3), (n, 3).

    `points` and `normals` are (n, 3). The body shadows itself.
    """
    corners = world_corners(geometry)
    away = SHADOW_BIAS * float(np.linalg.norm(np.ptp(corners, axis=0)))
    result = np.zeros(points.shape)
    for light, color in zip(lights, colors, strict=True):
        ways = light[:3] - points * light[3]
        lengths = np.linalg.norm(ways, axis=1)
        ways /= np.maximum(lengths, 1e-9)[:, None]
        cosines = np.einsum("nc,nc->n", normals, ways)
        lit = np.flatnonzero(cosines > 0.0)
        nearest = _nearest(geometry, points[lit] + away * normals[lit], ways[lit], 0)[:, 0]
        reach = np.where(light[3] > 0.0, lengths[lit], np.inf)
        lit = lit[nearest >= reach]
        fall = np.where(light[3] > 0.0, 1.0 / np.maximum(lengths[lit] ** 2, 1e-4), 1.0)
        result[lit] += (cosines[lit] * fall)[:, None] * color
    return result


def light_depth(geometry: Geometry, light: Array, layers: Sequence[str] = ("entry 1",)) -> tuple[LightView, Array]:
    """The view of a light, (4,): w = 1 where it is, w = 0 the unit direction towards it; and its map.

    The map is (rows, columns, channels): the `layers` of a pass (`ir.frame_passes`). A texel without a surface has the
    depth of the body's end, as a larger step would be blurred differently by filters. Raises SssgenError for a light at
    the body.
    """
    corners, size = world_corners(geometry), (TEXELS, TEXELS)
    view = point_view(corners, light[:3], size) if light[3] else directional_view(corners, light[:3], size)
    distances = _distances(geometry, view.origins, view.directions, layers)
    end = float((corners @ view.matrix[2, :3] + view.matrix[2, 3]).max())
    view = view._replace(far=end)
    depth = np.where(np.isfinite(distances), distances * view.slopes[:, None], end)
    return view, depth.reshape(TEXELS, TEXELS, -1)


def light_layers(geometry: Geometry, lights: Array, layers: Sequence[str]) -> tuple[list[Array], Array]:
    """The matrices (4, 4) of lights (n, 4), as in `light_depth`, and their maps as the tiles of one picture.

    It is (rows, columns, channels). The first light's tile is at u = v = 0, the second beside it in u. Raises
    SssgenError for a light at the body.
    """
    matrices: list[Array] = []
    picture = np.zeros((TILES * TEXELS, TILES * TEXELS, len(layers)))
    for index, light in enumerate(lights):
        row, column = divmod(index, TILES)
        view, depth = light_depth(geometry, light, layers)
        matrix = view.matrix.copy()
        matrix[0] = (matrix[0] + column * matrix[3]) / TILES
        matrix[1] = (matrix[1] + row * matrix[3]) / TILES
        matrices.append(matrix)
        picture[row * TEXELS : (row + 1) * TEXELS, column * TEXELS : (column + 1) * TEXELS] = depth
    return matrices, picture


def shown_lights(name: str, center: Array, lights: Array, colors: Array) -> list[int]:
    """The indices of the lights (n, 4) that a pass shows: the brightest at the body's center (3,), or the first that
    it is for.
    """
    if FRAME_PASSES[name].seen_from == "each light":
        return brightest(center, lights, colors)
    return [index for index, light in enumerate(lights) if not (light[3] and name in DISTANT_VIEWS)][:1]


def brightest(center: Array, lights: Array, colors: Array) -> list[int]:
    """The indices of the lights (n, 4) that are brightest at a body's center (3,), at most `TILES` squared, the
    brightest first.
    """
    near = lights[:, 3] > 0.0
    fall = np.where(near, np.maximum(np.sum((lights[:, :3] - center) ** 2, axis=1), 1e-6), 1.0)
    strength = colors.max(axis=1) / fall
    order = np.argsort(-strength, kind="stable")[: TILES * TILES]
    return [int(index) for index in order if strength[index] > 0.0]


def _distances(geometry: Geometry, origins: Array, directions: Array, layers: Sequence[str]) -> Array:
    """The distance of each layer along each ray, (n, layers); inf for none."""
    places = [(SIDES.index(side), int(place)) for side, place in map(str.split, layers)]
    counts = {side: max(place for other, place in places if other == side) for side, _ in places}
    nearest = {side: _nearest(geometry, origins, directions, side, count) for side, count in counts.items()}
    return np.stack([nearest[side][:, place - 1] for side, place in places], axis=1)


def _nearest(geometry: Geometry, origins: Array, directions: Array, side: int, count: int = 1) -> Array:
    """The distances to the nearest surfaces of a side in front of each origin, (n, count); inf for none."""
    nearest = np.full((len(directions), count), np.inf)
    needed = 2 * count - 1 + side
    for start in range(0, len(directions), BLOCK):
        part = slice(start, start + BLOCK)
        ends = geometry.scale * intervals(geometry, *in_object_space(geometry, origins[part], directions[part]), needed)
        ahead = (ends[..., 0] < ends[..., 1]) & (ends[..., side] > 0.0)
        distances = np.sort(np.where(ahead, ends[..., side], np.inf), axis=1)[:, :count]
        nearest[part, : distances.shape[1]] = distances
    return nearest
