"""A jade disc with a carved grain pattern, 2 units wide, in a stand of dark wood."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, box, capsule, cut, joined, lattice_points, meshed, noise, sheet

HEIGHT = 1.22
"""Of the disc's middle above the table."""


def disc(p: Array) -> Array:
    """The distance to the disc, which stands upright and faces z."""
    x, y, z = (p - [0.0, HEIGHT, 0.0]).T
    away, angle = np.hypot(x, y), np.arctan2(y, x)
    thickness = 0.088 - 0.012 * away
    plate = np.maximum(np.abs(z) - thickness, np.maximum(away - 1.0, 0.34 - away))
    plate = -joined(-plate, 1.0 - away, away - 0.34, thickness - np.abs(z), blend=0.05)
    for radius, height in ((0.95, 0.022), (0.39, 0.022)):
        rim = np.maximum(np.abs(away - radius) - 0.03, np.abs(z) - thickness - height)
        plate = joined(plate, rim, blend=0.03)
    # bosses with a curl, in rings, as grain in the ear
    for ring, radius in enumerate((0.485, 0.6, 0.715, 0.83)):
        count = round(2.0 * np.pi * radius / 0.118)
        turn = (angle * count / (2.0 * np.pi) + 0.5 * (ring % 2)) % 1.0 - 0.5
        u, v = turn * 2.0 * np.pi * radius / count, away - radius
        q = np.hypot(u, v)
        boss = np.maximum(np.sqrt(q**2 + (np.maximum(np.abs(z) - thickness, 0.0) * 1.4) ** 2) - 0.043, -0.02 - 0.0 * q)
        curl = np.abs(np.hypot(u - 0.012, v) - 0.047) - 0.004 + 0.02 * (v > 0.0)
        plate = joined(plate, boss, blend=0.018)
        plate = cut(plate, np.maximum(curl, np.abs(np.abs(z) - thickness) - 0.006), 0.008)
    return 0.8 * (plate + 0.0025 * noise(p, 6.0, 3, seed=2))


def stand(p: Array) -> Array:
    foot = box(p, (0, 0.05, 0), (0.62, 0.05, 0.3), 0.03)
    foot = joined(foot, box(p, (0, 0.13, 0), (0.5, 0.05, 0.2), 0.03), blend=0.03)
    side = np.abs(p) * [1.0, 0.0, 0.0] + p * [0.0, 1.0, 1.0]
    arms = [capsule(side, (0.3, 0.12, 0.17 * s), (0.44, 0.42, 0.135 * s), 0.05, 0.035) for s in (-1.0, 1.0)]
    foot = joined(foot, *arms, blend=0.06)
    groove = np.hypot(np.hypot(p[:, 0], p[:, 1] - HEIGHT) - 0.97, 0.0 * p[:, 2]) - 0.04
    return cut(foot, np.maximum(groove, np.abs(p[:, 2]) - 0.1), 0.02) + 0.0015 * noise(p * [0.6, 4.0, 4.0], 5.0, 2)


def meshes(cells: int) -> dict[str, Mesh]:
    return {
        "disc": meshed(disc, (-1.05, HEIGHT - 1.05, -0.16), (1.05, HEIGHT + 1.05, 0.16), cells).with_colors(),
        "stand": meshed(stand, (-0.7, -0.02, -0.35), (0.7, 0.5, 0.35), cells // 2).with_colors(),
        "table": sheet(20.0),
    }


def volumes(meshes: dict[str, Mesh]) -> dict[str, np.ndarray]:
    """Clouds and russet veins in the stone."""
    p, shape = lattice_points(meshes["disc"], 150)
    bent = p + 0.3 * np.stack([noise(p, 0.9, 3, seed) for seed in (1, 2, 3)], axis=-1)
    cloud = np.clip(0.5 + 0.9 * noise(bent, 1.1, 3, 7), 0.0, 1.0)[:, None]
    vein = (
        np.exp(-((noise(bent, 0.8, 4, 21) / 0.06) ** 2))[:, None]
        * np.clip(0.3 + 1.2 * noise(p, 0.7, 2, 9), 0, 1)[:, None]
    )
    speck = np.clip((noise(p, 14.0, 2, 30) - 0.75) / 0.2, 0.0, 1.0)[:, None]
    color = cloud * np.array([1.0, 1.0, 1.0]) + (1.0 - cloud) * np.array([0.9, 0.97, 0.93])
    color = color * (1.0 - vein * (1.0 - np.array([0.97, 0.84, 0.66]))) * (1.0 - 0.25 * speck)
    return {"disc": color.reshape(*shape, 3)}
