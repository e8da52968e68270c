"""A leaf, 2 units long, with its veins as shape and as a picture, and the twig that leaves grow on."""

from __future__ import annotations

from functools import cache

import numpy as np
from hero_stage.mesh import Mesh, merged
from hero_stage.shapes import Array, capsule, joined, meshed, noise, smooth_step
from scipy.spatial import cKDTree

PAIRS = 9
SIDE = 1536
"""Of the picture, in pixels."""


def width(u: Array) -> Array:
    """Half the width at the share `u` of the length."""
    return 0.56 * np.clip(u, 0, 1) ** 0.62 * np.clip(1.0 - u, 0, 1) ** 0.78 * 1.75


def side_veins(u: Array, v: Array) -> tuple[Array, Array]:
    """The distance to the nearest side vein, and how far along it is, for places u along and v across, in units."""
    root = u - 0.42 * np.abs(v) - 0.16 * v**2  # where the vein through a place leaves the middle
    number = root * (PAIRS + 1.5) + 0.25 * (v > 0.0)
    return np.abs(number - np.round(number)) / (PAIRS + 1.5) * 0.85, np.abs(v)


@cache
def cells() -> tuple[Array, Array]:
    """For each pixel of the picture: the gap between its nearest two cells, and a random number of the cell."""
    random = np.random.default_rng(2)
    seeds = random.uniform(-0.02, 1.02, (7000, 2)) * [1.0, 1.0]
    rows, columns = (np.indices((SIDE, SIDE)) + 0.5) / SIDE
    places = np.stack([columns, rows], axis=-1).reshape(-1, 2)
    distances, nearest = cKDTree(seeds * [2.0, 1.3]).query(places * [2.0, 1.3], k=2)
    gap, shade = distances[:, 1] - distances[:, 0], random.uniform(size=7000)[nearest[:, 0]]
    return gap.reshape(SIDE, SIDE), shade.reshape(SIDE, SIDE)


def leaf_color() -> Array:
    """What comes through, linear; u along the columns, v down the rows."""
    rows, columns = (np.indices((SIDE, SIDE)) + 0.5) / SIDE
    u, v = columns, (0.5 - rows) * 1.3
    p = np.stack([3.0 * u, 3.0 * v, 0.0 * u], axis=-1).reshape(-1, 3)
    wobble = 0.006 * noise(p, 5.0, 3).reshape(u.shape)
    side, _ = side_veins(u + wobble, v)
    taper = np.clip(1.0 - 0.8 * np.abs(v) / np.maximum(width(u), 0.05), 0.1, 1.0)
    middle = np.abs(v + 0.5 * wobble) / np.maximum(0.02 * (1.15 - u), 0.003)
    gap, shade = cells()
    veins = (
        np.exp(-(middle**2)) + 0.9 * np.exp(-((side / (0.0075 * taper)) ** 2)) + 0.5 * np.exp(-((gap / 0.0035) ** 2))
    )
    halo = 0.35 * np.exp(-((side / 0.03) ** 2))
    mottled = 0.5 + 0.35 * noise(p, 2.2, 4, seed=5).reshape(u.shape) + 0.22 * (shade - 0.5)
    young, old = np.array([0.36, 0.62, 0.03]), np.array([0.12, 0.36, 0.015])
    color = old + (young - old) * np.clip(mottled + halo, 0, 1)[..., None]
    edge = np.abs(v) / np.maximum(width(u), 1e-3)
    rust = smooth_step(0.93, 1.0, edge + 0.1 * noise(p, 7.0, 3, seed=9).reshape(u.shape))[..., None]
    color = color * (1 - rust) + rust * np.array([0.3, 0.16, 0.03])
    spots = smooth_step(0.8, 0.95, noise(p, 6.0, 2, seed=15).reshape(u.shape))[..., None]
    color = color * (1 - 0.7 * spots) + 0.7 * spots * np.array([0.22, 0.12, 0.02])
    vein = np.clip(veins, 0, 1)[..., None]
    return color * (1 - vein) + vein * np.array([0.3, 0.42, 0.1]) * 0.42


def leaf(count: int, seed: int) -> Mesh:
    """The blade, which hangs from 0 to -2 along y, its upper side towards z; each seed bends it in its own way."""
    random = np.random.default_rng(seed)
    u, s = np.meshgrid(np.linspace(0.0, 1.0, 2 * count), np.linspace(-1.0, 1.0, count), indexing="ij")
    teeth = 1.0 + 0.03 * np.abs(((u - 0.42 * 0.3) * (PAIRS + 1.5) * 2) % 1.0 - 0.5) * smooth_step(0.02, 0.2, u)
    v = s * width(u) * teeth
    side, _ = side_veins(u, v)
    quilt = 0.03 * np.sqrt(np.minimum(side / 0.045, 1.0)) * np.minimum(np.abs(v) / 0.08, 1.0) * (1.0 - np.abs(s) ** 3)
    fold, droop, twist = random.uniform(0.25, 0.5), random.uniform(0.2, 0.7), random.uniform(-0.35, 0.35)
    p = np.stack([u, v, 0 * u], axis=-1).reshape(-1, 3)
    wave = 0.05 * noise(p + 3.0 * seed, 2.0, 2).reshape(u.shape) * np.abs(s)
    height = quilt + fold * np.abs(v) ** 1.3 - droop * u**2 * 0.8 + wave + twist * v * u
    vertices = np.stack([2.0 * v, -2.0 * u, 2.0 * height], axis=-1)
    ahead, across = np.gradient(vertices, axis=0), np.gradient(vertices, axis=1)
    normals = np.cross(ahead, across)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-9)
    number = np.arange(u.size).reshape(u.shape)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    uv = np.stack([u, 0.5 + v / 1.3], axis=-1)
    stalk = meshed(
        lambda q: capsule(q, (0, 0.4, 0.08), (0, -0.12, 0.0), 0.022, 0.016),
        (-0.05, -0.2, -0.06),
        (0.05, 0.45, 0.14),
        40,
    )
    stalk = Mesh(stalk.vertices, stalk.faces, stalk.normals, uv=np.tile([0.3, 0.5], (len(stalk.vertices), 1)))
    return merged(Mesh(vertices.reshape(-1, 3), faces, normals.reshape(-1, 3), uv=uv.reshape(-1, 2)), stalk)


def twig(p: Array) -> Array:
    bent = p + np.stack([0.0 * p[:, 0], 0.1 * np.sin(1.7 * p[:, 0]), 0.06 * np.sin(2.3 * p[:, 0])], axis=-1)
    wood = capsule(bent, (-3.6, 0.9, -0.1), (3.4, -0.25, 0.05), 0.06, 0.03)
    knots = [
        capsule(bent, (x, 0.31 - 0.164 * x, 0), (x + 0.1, 0.35 - 0.164 * x, 0.0), 0.07, 0.03)
        for x in (-2.4, -1.3, -0.2, 0.9, 2.0)
    ]
    return joined(wood, *knots, blend=0.06) + 0.008 * noise(p * [1.0, 4.0, 4.0], 6.0, 3)


def meshes(cells: int) -> dict[str, Mesh]:
    return {f"leaf{seed}": leaf(cells // 2, seed) for seed in (1, 2, 3)} | {
        "twig": meshed(twig, (-3.7, -0.5, -0.3), (3.6, 1.2, 0.3), cells)
    }


def pictures() -> dict[str, np.ndarray]:
    return {"leaf": leaf_color()}
