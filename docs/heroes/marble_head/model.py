"""A sleeping head of marble, 1.9 units high, on a plinth: MakeHuman's head with closed eyes and carved hair."""

from __future__ import annotations

import numpy as np
from hero_stage import human
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, box, cut, ellipsoid, joined, meshed, noise, sheet, smooth_step, veins

TARGETS = {
    "macrodetails/caucasian-female-young": 1.0,
    "macrodetails/universal-female-young-averagemuscle-averageweight": 1.0,
    "expression/units/caucasian/eye-left-closure": 1.0,
    "expression/units/caucasian/eye-right-closure": 1.0,
}
LOW, HIGH = np.array([-1.1, 5.3, -1.1]), np.array([1.02, 8.75, 1.9])
"""The head in decimetres of the body."""
SCALE = 0.72


def head(cells: int):  # a distance function of units of the hero
    vertices, faces = human.body(TARGETS)
    eyes = human.eyes(TARGETS)
    vertices, faces = human.smoothed(vertices, faces, LOW - 0.3, HIGH + 0.3)
    solid = human.solid(vertices, faces, LOW - 0.1, HIGH + 0.1, cells, 0.018)

    def distance(p: Array) -> Array:
        q = p / SCALE + [0.0, 5.55, 0.3]
        body = solid(q)
        for center, radius in eyes:
            body = joined(body, ellipsoid(q, center - [0, 0, 0.012], (radius, 0.86 * radius, radius)), blend=0.05)
        # hair, combed back in waves, above a line from the forehead to the neck
        away = q - [0.0, 7.35, 0.25]
        line = away[:, 1] * 0.8 - away[:, 2] * 0.62 + 0.14 * np.abs(away[:, 0]) + 0.09 - 0.04 * noise(q, 2.0)
        grown = smooth_step(0.0, 0.22, line) * smooth_step(6.5, 6.9, q[:, 1])
        ears = smooth_step(0.66, 0.74, np.abs(q[:, 0])) * smooth_step(7.75, 7.6, q[:, 1])
        grown = grown * (1.0 - ears)
        angle = np.arctan2(away[:, 0], away[:, 1] - 0.4 * away[:, 2])
        along = away[:, 2] - 0.5 * away[:, 1]
        waves = np.sin(26.0 * angle + 2.2 * np.sin(3.1 * along + 2.0 * np.abs(away[:, 0])) + 0.8 * noise(q, 1.6, 2))
        fine = np.sin(88.0 * angle + 6.0 * np.sin(3.1 * along) + 1.6 * noise(q, 3.0, 2))
        body = body - grown * (0.05 + 0.024 * waves + 0.007 * fine)
        # the neck ends on the plinth
        body = SCALE * 0.8 * body
        return cut(body, p[:, 1], 0.03) + 0.0012 * noise(p, 24.0, 2, seed=3)

    return distance


def meshes(cells: int) -> dict[str, Mesh]:
    low, high = (-0.8, -0.03, -0.95), (0.8, 2.3, 1.1)
    stone = meshed(head(min(cells, 170)), low, high, cells).with_colors()
    plinth = meshed(
        lambda p: box(p, (0, -0.42, 0.0), (0.78, 0.415, 0.78), 0.02), (-0.9, -0.9, -0.9), (0.9, 0.05, 0.9), cells // 3
    )
    return {"head": stone, "plinth": plinth, "floor": sheet(30.0, -0.84)}


def volumes(meshes: dict[str, Mesh]) -> dict[str, np.ndarray]:
    """Grey veins in the stone: factors of its albedo, over the box of the head."""
    return {"head": veins(meshes["head"], 120, color=(0.86, 0.88, 0.9), frequency=0.85, seed=4)}
