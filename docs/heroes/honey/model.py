"""Honey that runs from a wooden dipper, whose barrel is 0.8 units wide, onto a plate of stoneware."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import (
    Array,
    capsule,
    cut,
    ellipsoid,
    joined,
    meshed,
    noise,
    planks,
    sheet,
    smooth_step,
    sphere,
)
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

MIDDLE = np.array([0.3, 1.8, 0.0])
"""Of the dipper's barrel."""
TILT = 56.0
"""Of the dipper from the vertical, in degrees."""
TIP = np.array([-0.02, 1.4, 0.0])
"""Where the honey leaves the dipper."""
FLOOR, LEVEL = 0.09, 0.22
"""Of the plate and of the honey on it."""
BUBBLES = 26


def along_dipper(p: Array) -> tuple[Array, Array]:
    """The place along the dipper's axis, from the barrel's middle to the handle, and the distance from the axis."""
    q = (p - MIDDLE) @ Rotation.from_euler("z", -TILT, degrees=True).as_matrix()
    return q[:, 1], np.hypot(q[:, 0], q[:, 2])


def dipper(p: Array) -> Array:
    up, away = along_dipper(p)
    share = np.clip(up / 0.5, -1.0, 1.0)
    barrel = 0.4 * np.sqrt(np.maximum(1.0 - share**2, 0.0)) ** 0.55
    core = 0.17 + 0.0 * up
    groove = np.cos(2.0 * np.pi * up / 0.143)
    radius = np.where(groove > -0.35, barrel, np.minimum(core, barrel))
    wood = np.maximum(away - radius, np.abs(up) - 0.47) * 0.6
    handle = np.maximum(np.abs(away) - 0.075 - 0.02 * smooth_step(1.5, 3.0, up), 0.3 - up) * 0.9
    return joined(wood, handle, blend=0.06) + 0.0015 * noise(p, 14.0, 2)


def plate(p: Array) -> Array:
    away = np.hypot(p[:, 0], p[:, 2])
    rise = 0.17 * smooth_step(1.2, 1.65, away) + 0.004 * np.sin(60.0 * away) * smooth_step(0.3, 0.5, away)
    disc = np.maximum(np.abs(p[:, 1] - rise - FLOOR + 0.035) - 0.035, away - 1.6) * 0.85
    lip = np.hypot(away - 1.6, p[:, 1] - rise - FLOOR + 0.035) - 0.04
    foot = np.hypot(away - 0.8, p[:, 1] - 0.03) - 0.045
    return joined(disc, lip, foot, blend=0.04) + 0.0015 * noise(p, 7.0, 3)


def coat(p: Array) -> Array:
    """The honey on the dipper: in its grooves, and hanging below."""
    up, away = along_dipper(p)
    share = np.clip(up / 0.56, -1.0, 1.0)
    radius = 0.435 * np.sqrt(np.maximum(1.0 - share**2, 0.0)) ** 0.5 + 0.012 * np.cos(2.0 * np.pi * up / 0.143)
    around = 0.8 * np.maximum(away - radius, np.abs(up) - 0.53)
    low = ellipsoid(p, MIDDLE + np.array((-0.16, -0.17, 0.0)), (0.42, 0.3, 0.36), (0, 0, -20))
    low = joined(low, ellipsoid(p, TIP + np.array((0.06, 0.12, 0.0)), (0.24, 0.24, 0.22)), blend=0.2)
    drip = joined(
        capsule(p, MIDDLE + np.array((0.3, -0.22, 0.06)), MIDDLE + np.array((0.31, -0.42, 0.06)), 0.09, 0.045),
        sphere(p, MIDDLE + np.array((0.31, -0.46, 0.06)), 0.07),
        blend=0.06,
    )
    return joined(joined(around, low, blend=0.16), drip, blend=0.12) + 0.01 * noise(p, 2.5, 2, seed=3)


def rope(p: Array) -> Array:
    """The thread, which gets thinner as it falls, and its coils on the heap."""
    height = TIP[1] - p[:, 1]
    radius = 0.042 + 0.16 * np.exp(-np.maximum(height, 0.0) / 0.16) + 0.012 * smooth_step(0.6, 1.0, height)
    sway = 0.012 * np.sin(5.0 * p[:, 1])
    thread = (
        np.maximum(
            np.hypot(p[:, 0] - TIP[0] - sway, p[:, 2] - TIP[2]) - radius, np.maximum(-height - 0.1, 0.4 - p[:, 1])
        )
        * 0.75
    )
    turn = np.linspace(0.0, 7.0 * np.pi, 150)
    wide = 0.2 - 0.15 * (turn / turn[-1]) ** 1.6
    line = np.stack([TIP[0] + wide * np.cos(turn), LEVEL + 0.06 + 0.27 * turn / turn[-1], wide * np.sin(turn)], axis=-1)
    near = np.full(len(p), 9.0)
    close = (np.hypot(p[:, 0], p[:, 2]) < 0.5) & (np.abs(p[:, 1] - LEVEL) < 0.5)
    if close.any():
        fine = np.stack(
            [np.interp(np.linspace(0, 149, 1500), np.arange(150), line[:, part]) for part in range(3)], axis=-1
        )
        near[close] = cKDTree(fine).query(p[close])[0] - 0.058
    return joined(thread, near, blend=0.05)


def puddle(p: Array) -> Array:
    angle = np.arctan2(p[:, 2], p[:, 0])
    edge = 1.0 + 0.06 * np.sin(2.0 * angle + 1.0) + 0.04 * np.sin(3.0 * angle) + 0.02 * np.sin(5.0 * angle + 2.0)
    share = np.hypot(p[:, 0], p[:, 2]) / edge
    away = np.hypot(p[:, 0] - TIP[0], p[:, 2])
    height = FLOOR + (LEVEL - FLOOR) * (1.0 - share**5) + 0.14 * np.exp(-((away / 0.28) ** 2))
    rings = 0.008 * np.cos(28.0 * away) * np.exp(-(((away - 0.38) / 0.16) ** 2))
    return -joined((height + rings - p[:, 1]) * 0.75, p[:, 1] - FLOOR + 0.006, blend=0.02)


def honey(p: Array) -> Array:
    body = joined(coat(p), rope(p), blend=0.05)
    body = joined(body, puddle(p), blend=0.05)
    body = np.maximum(body, 0.003 - dipper(p))
    random = np.random.default_rng(5)
    for number in range(BUBBLES):
        angle, away = random.uniform(0, 2 * np.pi), random.uniform(0.3, 0.8)
        place = (away * np.cos(angle), LEVEL - random.uniform(0.035, 0.08), away * np.sin(angle))
        if number < 6:
            place = tuple(MIDDLE + random.uniform(-0.25, 0.25, 3) + [-0.12, -0.2, 0.22])
        body = cut(body, sphere(p, place, random.uniform(0.01, 0.024)), 0.004)
    return body


def meshes(cells: int) -> dict[str, Mesh]:
    return {
        "honey": meshed(honey, (-1.2, 0.02, -1.2), (1.2, 2.5, 1.2), cells).with_colors(),
        "dipper": meshed(dipper, (-0.3, 1.2, -0.5), (3.2, 4.0, 0.5), cells).with_colors(),
        "plate": meshed(plate, (-1.75, -0.05, -1.75), (1.75, 0.4, 1.75), 2 * cells).with_colors(floor=0.0),
        "table": sheet(24.0),
    }


def pictures() -> dict[str, np.ndarray]:
    """The wood of the table and of the dipper."""
    return {"wood": planks(768, color=(0.3, 0.17, 0.085), seed=4)}
