"""Three ice cubes, 0.85 units wide, that begin to melt on slate; bubbles inside are a mesh of their own."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, box, ellipsoid, joined, meshed, noise, sheet, smooth_step
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

CUBES = (
    ((-0.5, 0.4, 0.1), (0, 24, 0), 0.42),
    ((0.52, 0.4, -0.1), (0, -18, 2), 0.42),
    ((0.02, 1.16, 0.0), (8, 40, 14), 0.39),
)
"""The middle, the angles in degrees about x, y and z, and half the width of each."""


def local(p: Array, number: int) -> Array:
    middle, angles, half = CUBES[number]
    return (p - middle) @ Rotation.from_euler("xyz", angles, degrees=True).as_matrix() / half


def cubes(p: Array) -> Array:
    bodies = []
    for number, (_, _, half) in enumerate(CUBES):
        q = local(p, number)
        melted = q * (1.0 + 0.05 * (q**2).sum(axis=-1, keepdims=True) / 3.0)
        dent = 0.16 * np.exp(-((q[:, 0] - 0.1) ** 2 + q[:, 2] ** 2) / 0.25) * (q[:, 1] > 0)
        bodies.append(half * (box(melted, (0, 0, 0), (1, 1, 1), 0.42) + dent) * 0.9)
    body = joined(bodies[0], *bodies[1:], blend=0.03)
    pool = joined(
        ellipsoid(p, (-0.3, 0.0, 0.35), (0.95, 0.06, 0.5)),
        ellipsoid(p, (0.55, 0.0, 0.1), (0.8, 0.06, 0.55)),
        blend=0.03,
    )
    body = np.maximum(joined(body, pool, blend=0.06), 0.004 - p[:, 1])
    return (
        body + 0.022 * smooth_step(0.03, 0.2, p[:, 1]) * noise(p, 2.4, 2, seed=3) + 0.0015 * noise(p, 12.0, 2, seed=9)
    )


def bubbles(p: Array) -> Array:
    """A cloud in the middle of each cube, and rows of bubbles that run outwards from it."""
    random, centers, radii = np.random.default_rng(8), [], []
    for middle, angles, half in CUBES:
        turn = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
        ways = random.normal(size=(260, 3)) * [0.1, 0.34, 0.12]
        rows = random.normal(size=(22, 1, 3))
        rows /= np.linalg.norm(rows, axis=-1, keepdims=True)
        rows = (rows * np.linspace(0.3, 0.72, 9)[None, :, None]).reshape(-1, 3)
        inside = np.concatenate([ways, rows])
        centers.append(np.array(middle) + half * inside @ turn.T)
        radii.append(np.concatenate([random.uniform(0.002, 0.008, 260), random.uniform(0.002, 0.005, len(rows))]))
    away, nearest = cKDTree(np.concatenate(centers)).query(p)
    return away - np.concatenate(radii)[nearest]


def meshes(cells: int) -> dict[str, Mesh]:
    return {
        "ice": meshed(cubes, (-1.4, -0.05, -0.8), (1.5, 1.85, 1.0), cells).with_colors(),
        "bubbles": meshed(bubbles, (-0.9, 0.02, -0.5), (0.95, 1.6, 0.5), 300),
        "table": sheet(24.0),
    }


def pictures() -> dict[str, np.ndarray]:
    """Slate: dark layers with dust."""
    side = 512
    rows, columns = (np.indices((side, side)) + 0.5) / side * 48
    p = np.stack([columns, rows, 0 * rows], axis=-1).reshape(-1, 3)
    layers = noise(p + 0.8 * noise(p, 0.25, 2, 3)[:, None], 0.5, 4, 5)
    dust = np.clip(noise(p, 1.0, 3, 11) - 0.4, 0.0, 1.0)
    return {
        "slate": (np.clip(0.05 + 0.022 * layers + 0.06 * dust, 0.01, 1.0)[:, None] * [0.85, 0.95, 1.1]).reshape(
            side, side, 3
        )
    }
