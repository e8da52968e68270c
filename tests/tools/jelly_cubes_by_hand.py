"""42yeah's scene written by hand: jelly cubes on a floor, in float64, as a reference for the compiled jelly_cubes.

It is written from the formulas (`sssgen show TECHNIQUE`, docs/errata.md; 42yeah, Raymarching Cheap Subsurface
Scattering) and imports nothing of the project. Arrays have their rays first and their components last: (n, 3).

    picture = image(160, 120)
    picture.color[0]                 # the bottom row of pixels, encoded for the display
    picture.silhouette               # the pixels that depend on rounding errors
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

Array: TypeAlias = np.ndarray[Any, Any]

# Cubes: turned by 45 degrees about y, so their sides face (1, 0, -1) and (1, 0, 1). Rows are their axes.
TURN = np.array([[1.0, 0.0, -1.0], [0.0, np.sqrt(2.0), 0.0], [1.0, 0.0, 1.0]]) / np.sqrt(2.0)
CENTERS = np.array([[0.0, 0.48, 0.0], [1.45, 0.48, 0.0]])
HALF_SIZE = 0.5
JELLY = np.array([1.0, 0.5, 0.0])
SKY = np.array([0.67, 0.86, 0.98])

TOLERANCE = 1.0e-3
"""The tolerance of a hit; the differences for normals have the same length."""
STEPS, FARTHEST = 200, 50.0
TETRAHEDRON = np.array([[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]])
KEY = np.ones(3) / np.sqrt(3.0)
SHADOW_STEPS, SHARPNESS = 25, 20.0
SHADOW_REACH = 4.0
REACH, TAPS, NOTHING = 0.4, 4, 0.004
GLOW = 0.6

LEVEL = 1.0 / 255.0
RAY_ROUNDING = 2.0**-20
"""The largest error of a ray on the image in float32: eight units in the last place of 1."""
WAY_ROUNDING = 2.0**-18
"""The largest error of a distance in float32: a unit in the last place of a way of 32 to 64, the longest."""


class Scene(NamedTuple):
    """A picture; row 0 is at the bottom."""

    color: Array
    """(height, width, 3), encoded."""
    silhouette: Array
    """(height, width), bool: the pixel is ill-posed for float32.

    An exact picture too would change here by more than 1/255 if the ray and the hit's tolerance changed by what float32
    rounds: another object, another tile of the floor, a step more or less (the ray then ends 1e-3 away) at an edge or
    in a shadow that begins at the ray's end. Rays and tolerance are moved to the four corners of a tetrahedron, so that
    every boundary nearer than its inner sphere separates one of them.
    """


class Hits(NamedTuple):
    """The ends of rays."""

    points: Array
    """(n, 3)."""
    met: Array
    """(n,), bool: not the sky."""
    floor: Array
    """(n,), bool: the floor."""


def cube_distances(p: Array) -> Array:
    """The distances to the two cubes, (..., 2): outside to the nearest point, inside to the nearest face."""
    local = (p[..., None, :] - CENTERS) @ TURN.T
    nearest = np.clip(local, -HALF_SIZE, HALF_SIZE)
    to_face: Array = HALF_SIZE - np.abs(local).max(axis=-1)
    return np.where(to_face > 0.0, -to_face, np.linalg.norm(local - nearest, axis=-1))


def scene(p: Array) -> Array:
    """The distance to the cubes."""
    result: Array = cube_distances(p).min(axis=-1)
    return result


def rays(
    width: int, height: int, eye: Array, look_at: Array, aspect: float, shift: tuple[float, float] = (0.0, 0.0)
) -> Array:
    """Unit directions through the pixels' centers, (height * width, 3): an image of height 2, at a distance of 2.

    `shift` moves all rays on that image.
    """
    v, u = 2.0 * (np.mgrid[0:height, 0:width] + 0.5) / np.array([height, width])[:, None, None] - 1.0
    plane = np.stack([aspect * u + shift[0], v + shift[1], np.full(u.shape, 2.0)], axis=-1)
    front = look_at - eye
    right = np.cross(front, [0.0, 1.0, 0.0])
    axes = np.stack([right, np.cross(right, front), front])
    return unit(plane.reshape(-1, 3) @ unit(axes))


def unit(v: Array) -> Array:
    result: Array = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return result


def trace(eye: Array, directions: Array, tolerance: float) -> Hits:
    """Sphere tracing: each step is the distance, until it is below the tolerance, the floor is met or the way is too
    long."""
    way, cube = np.zeros(len(directions)), np.zeros(len(directions), bool)
    down = -directions[:, 1]
    end = np.minimum(np.where(down > 0.0, eye[1] / np.where(down > 0.0, down, 1.0), FARTHEST), FARTHEST)
    going = np.arange(len(directions))
    for _ in range(STEPS):
        going = going[way[going] < end[going]]
        gap = scene(eye + way[going, None] * directions[going])
        near = gap < tolerance
        cube[going[near]] = True
        going = going[~near]
        way[going] += gap[~near]
    floor = ~cube & (end < FARTHEST)
    return Hits(eye + np.where(cube, way, end)[:, None] * directions, cube | floor, floor)


def normals(p: Array, floor: Array) -> Array:
    """The gradient, from four points near each point; of the floor, upwards."""
    around = TOLERANCE * TETRAHEDRON
    return np.where(floor[:, None], [0.0, 1.0, 0.0], unit(scene(p[:, None] + around) @ TETRAHEDRON))


def shadow(p: Array) -> Array:
    """The share of the key light that reaches `p`: the minimum of 20 gap / way, along the first 4 units to the light.

    It need not stop at 0, because it remains 0.
    """
    way, least = np.full(len(p), 1.0e-3), np.ones(len(p))
    for _ in range(SHADOW_STEPS):
        gap = scene(p + way[:, None] * KEY)
        least = np.where(way < SHADOW_REACH, np.minimum(least, SHARPNESS * gap / way), least)
        way = way + np.clip(gap, 1.0e-3, 2.0)
    return np.maximum(least, 0.0)


def thinness(p: Array, n: Array) -> Array:
    """The integral of depth + distance to the cubes, by trapezoids between four depths; 1 in empty space.

    The first depth is the reach. Each other depth is halfway to the zero of the line through the last two values, the
    fourth is at that zero. Below the fourth depth, the area is a triangle.
    """

    def integrand(depth: Array) -> Array:
        result: Array = np.clip(depth + cube_distances(p - depth[:, None] * n).min(axis=-1), 0.0, 2.0 * depth)
        return result

    depths = [np.full(len(p), REACH)]
    values = [integrand(depths[0])]
    slope, area = np.full(len(p), 2.0), np.zeros(len(p))
    for tap in range(2, TAPS + 1):
        going = (values[-1] > NOTHING * REACH) & (values[-1] < 2.0 * depths[-1])
        way = np.minimum(values[-1] / slope, depths[-1])
        depth = np.where(going, depths[-1] - (way if tap == TAPS else 0.5 * way), depths[-1])
        value = np.where(going, np.minimum(integrand(depth), values[-1]), values[-1])
        area += (depths[-1] - depth) * (values[-1] + value) / 2.0
        slope = np.where(
            going, np.maximum((values[-1] - value) / np.where(going, depths[-1] - depth, 1.0), 1e-9), slope
        )
        depths.append(depth)
        values.append(value)
    area += values[-1] * np.minimum(values[-1] / slope, depths[-1]) / 2.0
    return area / REACH**2


def sky(height: Array) -> Array:
    """The sky in a direction with y = `height`; white above 0.2."""
    white = np.clip(5.0 * height, 0.0, 1.0)[:, None]
    result: Array = (1.0 - white) * SKY + white
    return result


def kinds(p: Array) -> Array:
    """The object at a point: 0 and 1 are the cubes, 2 and 3 the dark and bright tiles of the floor."""
    cubes = cube_distances(p)
    bright = (np.floor(2.0 * p[:, 0]) - np.floor(2.0 * p[:, 2])) % 2.0 == 0.0
    return np.where(p[:, 1] < cubes.min(axis=-1), np.where(bright, 3, 2), cubes.argmin(axis=-1))


def radiance(p: Array, floor: Array, directions: Array) -> Array:
    """The light from the hit points, (n, 3), linear."""
    n, kind = normals(p, floor), kinds(p)
    free, facing, up = shadow(p + TOLERANCE * n), np.maximum(n @ KEY, 0.0), n[:, 1]
    behind = np.maximum(n @ (KEY * [-1.0, 0.0, -1.0]), 0.0)
    dome, bounce = 0.2 + 0.8 * np.maximum(up, 0.0), 0.2 - 0.8 * np.minimum(up, 0.0)
    light = np.stack([free, facing * free, dome, bounce, behind])
    colors = [[0.2, 0.2, 0.2], [0.82, 0.8, 0.82], [0.26, 0.32, 0.334], [0.3, 0.21, 0.23], [0.2, 0.21, 0.23]]
    glow = np.where(kind < 2, GLOW * thinness(p, n), 0.0)[:, None] * sky(-directions[:, 1])
    albedo = np.array([JELLY, JELLY, np.full(3, 0.9), np.ones(3)])[kind]
    result: Array = albedo * (light.T @ np.array(colors) + glow)
    return result


def draw(eye: Array, directions: Array, tolerance: float) -> Array:
    """The colours of rays, (n, 3), encoded."""
    hits = trace(eye, directions, tolerance)
    color, met = sky(directions[:, 1]), hits.met
    color[met] = radiance(hits.points[met], hits.floor[met], directions[met])
    encoded: Array = color ** (1.0 / 2.2)
    return encoded


def image(
    width: int,
    height: int,
    time: float = 0.0,
    aspect: float = 1.0,
    look_at: tuple[float, float, float] = (0.65, 0.5, 0.0),
) -> Scene:
    """The scene at a time, in seconds. `aspect` is the material's uniform, 1 unless a program sets it."""
    eye, target = np.array([3.0 * np.cos(time), 2.5, 3.0 * np.sin(time)]), np.array(look_at)
    color = draw(eye, rays(width, height, eye, target, aspect), TOLERANCE)
    moved = np.zeros(len(color))
    for u, v, later in TETRAHEDRON:
        directions = rays(width, height, eye, target, aspect, shift=(u * RAY_ROUNDING, v * RAY_ROUNDING))
        other = draw(eye, directions, TOLERANCE + later * WAY_ROUNDING)
        moved = np.maximum(moved, np.abs(other - color).max(axis=1))
    return Scene(color.reshape(height, width, 3), (moved > LEVEL).reshape(height, width))
