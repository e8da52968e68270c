"""A pillar candle, 1.3 units high, that has burnt for a while; a brass dish, a table and far lights of a room."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, capsule, cut, cylinder, ellipsoid, joined, meshed, noise, planks, sheet, sphere

RUNS = [
    (20, 0.5, 0.05),
    (75, 0.95, 0.062),
    (112, 0.28, 0.045),
    (160, 0.7, 0.055),
    (230, 0.4, 0.05),
    (265, 1.05, 0.06),
    (318, 0.62, 0.05),
]
"""Of wax: an angle in degrees, a length, a radius."""


def wax(p: Array) -> Array:
    angle = np.arctan2(p[:, 2], p[:, 0])
    rim = 1.3 + 0.05 * np.sin(angle + 0.7) + 0.025 * np.sin(3.0 * angle + 1.0) + 0.02 * noise(p * [1, 0, 1], 3.0, 2)
    q = p + np.stack([0.015 * noise(p, 1.1, 1, seed) for seed in (1, 2, 3)], axis=-1)
    body = cylinder(q, (0, 0.5, 0), 0.4, 0.9, 0.05)
    body = -joined(-body, rim - p[:, 1], blend=0.09)
    for degrees, length, radius in RUNS:
        way = np.array([np.cos(np.radians(degrees)), 0.0, np.sin(np.radians(degrees))])
        top, side = 1.26, np.array([-way[2], 0.0, way[0]])
        bend = 0.03 * np.sin(3.0 * (top - length) + degrees)
        start, end = 0.36 * way + [0, top, 0], 0.4 * way + bend * side + [0, max(top - length, 0.06), 0]
        run = capsule(p, start, end, 0.8 * radius, 0.72 * radius)
        drop = ellipsoid(p, end - [0, 0.02, 0], (radius, 1.5 * radius, radius))
        body = joined(body, joined(run, drop, blend=0.05), blend=0.07)
    pool = ellipsoid(p, (0.03, 0.0, 0.03), (0.62, 0.075, 0.57)) + 0.025 * noise(p * [1, 0, 1], 2.6, 2, seed=8)
    body = joined(body, pool, blend=0.09)
    hollow = joined(ellipsoid(p, (0, 1.36, 0), (0.31, 0.23, 0.31)), sphere(p, (0.05, 1.36, 0.03), 0.2), blend=0.1)
    body = cut(body, hollow, 0.05)
    body = cut(body, p[:, 1], 0.015)
    return body + 0.004 * noise(p, 5.0, 3, seed=4) + 0.0006 * noise(p, 40.0, 2, seed=5)


def flame(p: Array) -> Array:
    up = np.clip((p[:, 1] - 1.33) / 0.46, 0.0, 1.0)
    radius = 0.15 * np.sqrt(up + 0.03) * (1.0 - up) ** 0.8
    return 0.6 * (
        np.linalg.norm(p - np.stack([0.02 * up, np.clip(p[:, 1], 1.33, 1.79), 0 * up], axis=-1), axis=-1) - radius
    )


def dish(p: Array) -> Array:
    away = np.hypot(p[:, 0], p[:, 2])
    plate = np.abs(p[:, 1] + 0.05 - 0.06 * np.clip((away - 0.72) / 0.2, 0, 1) ** 2) - 0.014
    plate = np.maximum(plate, away - 0.93)
    ring = np.hypot(away - 0.93, p[:, 1] - 0.012) - 0.03
    foot = np.hypot(away - 0.55, p[:, 1] + 0.08) - 0.035
    return joined(plate, ring, foot, blend=0.03) * 0.9


def meshes(cells: int) -> dict[str, Mesh]:
    light = meshed(flame, (-0.2, 1.25, -0.2), (0.25, 1.9, 0.2), 90)
    up = np.clip((light.vertices[:, 1] - 1.32) / 0.46, 0.0, 1.0)
    blue, warm = np.array([0.1, 0.12, 0.5]), np.array([1.0, 0.62, 0.22])
    share = np.clip(up / 0.22, 0.0, 1.0)[:, None]
    color = blue * (1 - share) * 0.25 + warm * share * (1.0 - 0.35 * up[:, None])
    wick = meshed(
        lambda p: capsule(p, (0, 1.1, 0), (0.015, 1.42, 0.0), 0.016, 0.011),
        (-0.06, 1.05, -0.06),
        (0.08, 1.48, 0.06),
        60,
    )
    bead = meshed(lambda p: sphere(p, (0, 0, 0), 1.0), (-1.1,) * 3, (1.1,) * 3, 20)
    return {
        "wax": meshed(wax, (-0.75, -0.03, -0.72), (0.75, 1.5, 0.72), cells).with_colors(),
        "flame": light.with_colors(color, occluded=False),
        "wick": wick,
        "dish": meshed(dish, (-1.0, -0.14, -1.0), (1.0, 0.08, 1.0), cells).with_colors(),
        "table": sheet(16.0, -0.115),
        "bead": bead,
    }


def pictures() -> dict[str, np.ndarray]:
    """The wood of the table."""
    return {"wood": planks(512, color=(0.16, 0.075, 0.035), seed=3)}
