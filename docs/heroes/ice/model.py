"""Three ice cubes, 0.85 units wide, with frosted edges, that begin to melt on a bar; far lights behind it."""

from __future__ import annotations

import dataclasses

import numpy as np
from hero_stage.mesh import Mesh
from hero_stage.shapes import Array, box, ellipsoid, joined, meshed, noise, sheet, smooth_step
from scipy.spatial.transform import Rotation

CUBES = (
    ((-0.5, 0.4, 0.1), (0, 27, 0), 0.42),
    ((0.5, 0.4, -0.1), (0, -21, 2), 0.42),
    ((0.0, 1.15, 0.0), (7, 38, 12), 0.39),
)
"""The middle, the angles in degrees about x, y and z, and half the width of each."""


def local(p: Array, number: int) -> Array:
    middle, angles, half = CUBES[number]
    return (p - middle) @ Rotation.from_euler("xyz", angles, degrees=True).as_matrix() / half


def cubes(p: Array) -> Array:
    bodies = []
    for number, (_, _, half) in enumerate(CUBES):
        q = local(p, number)
        melted = q * (1.0 + 0.04 * (q**2).sum(axis=-1, keepdims=True) / 3.0)
        dent = 0.12 * np.exp(-((q[:, 0] - 0.1) ** 2 + q[:, 2] ** 2) / 0.3) * (q[:, 1] > 0)
        bodies.append(half * (box(melted, (0, 0, 0), (1, 1, 1), 0.26) + dent) * 0.9)
    body = joined(bodies[0], *bodies[1:], blend=0.03)
    pool = joined(
        ellipsoid(p, (-0.3, 0.0, 0.35), (0.95, 0.05, 0.5)),
        ellipsoid(p, (0.55, 0.0, 0.1), (0.8, 0.05, 0.55)),
        ellipsoid(p, (1.32, 0.0, 0.55), (0.1, 0.05, 0.07)),
        ellipsoid(p, (-1.25, 0.0, -0.1), (0.07, 0.04, 0.06)),
        blend=0.03,
    )
    body = np.maximum(joined(body, pool, blend=0.05), 0.004 - p[:, 1])
    return body + 0.018 * smooth_step(0.03, 0.2, p[:, 1]) * noise(p, 1.7, 2, seed=3)


def frost(p: Array) -> Array:
    """How much of the surface is rough and white: the edges of the cubes, in patches."""
    shares = []
    for number in range(len(CUBES)):
        turned = local(p, number)
        q = np.abs(turned)
        edge = (
            smooth_step(-1.3, 0.9, turned[:, 1])
            * smooth_step(0.6, 0.9, np.sort(q, axis=-1)[:, 1])
            * (q.max(axis=-1) < 1.2)
        )
        shares.append(edge * smooth_step(-0.5, 0.35, noise(p, 3.0, 4, seed=21, gain=0.75)))
    return np.max(shares, axis=0) * smooth_step(0.05, 0.16, p[:, 1])


def wall() -> Mesh:
    """The lights of a bar at night, far out of focus: discs on a dark wall, in the colours of its vertices."""
    across, up = np.meshgrid(np.linspace(-8.0, 8.0, 480), np.linspace(-3.0, 5.0, 240))
    light = np.array([0.012, 0.03, 0.05]) * np.exp(-(((up - 1.0) / 2.2) ** 2))[..., None]
    random = np.random.default_rng(5)
    hues = np.array([[1.0, 0.45, 0.1], [1.0, 0.62, 0.25], [1.0, 0.3, 0.07], [0.12, 0.55, 0.7], [0.75, 0.85, 1.0]])
    for _ in range(85):
        x, y = random.uniform(-7.5, 7.5), 0.6 + random.normal() * 1.1
        away = np.hypot(across - x, up - y) / random.uniform(0.14, 0.42)
        disc = smooth_step(1.0, 0.86, away) * (0.72 + 0.28 * smooth_step(0.6, 0.95, away))
        hue = hues[random.choice(len(hues), p=[0.32, 0.26, 0.14, 0.18, 0.1])]
        light = light + disc[..., None] * hue * random.uniform(0.06, 0.5)
    light = light + random.uniform(-0.5, 0.5, across.shape)[..., None] / 255.0  # hides the steps of 8 bits
    number = np.arange(across.size).reshape(across.shape)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    vertices = np.stack([across, up, np.full_like(up, -9.0)], axis=-1).reshape(-1, 3)
    colors = np.column_stack([np.clip(light, 0.0, 1.0).reshape(-1, 3), np.ones(across.size)])
    return Mesh(vertices, faces, np.tile([0.0, 0.0, 1.0], (across.size, 1)), colors=colors)


def meshes(cells: int) -> dict[str, Mesh]:
    ice = meshed(cubes, (-1.5, -0.05, -0.8), (1.5, 1.8, 1.0), cells).with_colors()
    white = frost(ice.vertices)
    stained = np.column_stack([np.repeat(white[:, None], 3, axis=1), ice.colors[:, 3]])
    return {
        "ice": dataclasses.replace(ice, colors=stained),
        "wall": wall(),
        "panel": sheet(1.0),
        "table": sheet(6.4),
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
