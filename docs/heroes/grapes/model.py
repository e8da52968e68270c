"""A grape with its bloom, 1 unit wide, the stalk of a bunch, and a stone ledge."""

from __future__ import annotations

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, capsule, ellipsoid, joined, meshed, noise, planks, sheet, smooth_step


def grape(p: Array) -> Array:
    body = ellipsoid(p, (0, 0, 0), (0.46, 0.5, 0.46))
    scar = ellipsoid(p, (0, 0.5, 0), (0.05, 0.035, 0.05))
    return joined(body, scar, blend=0.05) + 0.006 * noise(p, 2.2, 2) + 0.0012 * noise(p, 14.0, 2, seed=4)


def stalk(p: Array) -> Array:
    bent = p + np.stack([0.06 * np.sin(2.0 * p[:, 1]), 0.0 * p[:, 0], 0.05 * np.sin(3.0 * p[:, 1])], axis=-1)
    wood = capsule(bent, (0.25, 1.3, -0.1), (0.1, 3.3, -0.35), 0.045, 0.075)
    arms = [
        capsule(bent, (0.2, 1.6 + 0.1 * number, -0.1), place, 0.035, 0.024)
        for number, place in enumerate([(-0.45, 1.66, 0.15), (0.42, 1.7, 0.25), (0.75, 2.3, -0.2), (-0.05, 2.4, 0.0)])
    ]
    return joined(wood, *arms, blend=0.08) + 0.01 * noise(p * [2.0, 0.7, 2.0], 5.0, 3)


def meshes(cells: int) -> dict[str, Mesh]:
    body = meshed(grape, (-0.53, -0.55, -0.53), (0.53, 0.57, 0.53), cells)
    p = body.vertices
    bloom = smooth_step(-0.25, 0.6, noise(p, 1.6, 4, seed=8)) * (
        1.0 - 0.8 * smooth_step(0.2, 0.7, noise(p, 6.0, 2, seed=12))
    )
    tint = np.array([1.0, 1.0, 1.0]) - 0.3 * bloom[:, None] * np.array([1.0, 0.9, 0.6])
    return {
        "grape": body.with_colors(tint, occluded=False),
        "stalk": meshed(stalk, (-0.8, 1.2, -0.6), (1.0, 3.4, 0.5), cells),
        "table": sheet(16.0),
    }


def pictures() -> dict[str, np.ndarray]:
    """The wood of the table."""
    return {"wood": planks(768, color=(0.3, 0.2, 0.12), seed=5, count=3)}
