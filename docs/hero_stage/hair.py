"""Hairs on a mesh."""

from __future__ import annotations

import numpy as np

from hero_stage.mesh import Array, Mesh


def scattered(shape: Mesh, wanted: Array, count: int, seed: int) -> tuple[Array, Array]:
    """Places on a mesh, by the weights of its vertices, and the normals there."""
    random = np.random.default_rng(seed)
    corners = shape.vertices[shape.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chance = area * wanted[shape.faces].mean(axis=1)
    chosen = random.choice(len(shape.faces), count, p=chance / chance.sum())
    share = random.dirichlet([1.0, 1.0, 1.0], count)
    mixed = [(share[:, :, None] * part[shape.faces[chosen]]).sum(axis=1) for part in (shape.vertices, shape.normals)]
    return mixed[0], mixed[1] / np.linalg.norm(mixed[1], axis=1, keepdims=True)


def strands(roots: Array, ways: Array, lengths: Array, radius: float, droop: Array, segments: int = 5) -> Mesh:
    """Hairs: thin pointed prisms of three sides that leave `roots` along `ways` and bend by `droop`, (n, 3) each."""
    share = np.linspace(0.0, 1.0, segments + 1)[None, :, None]
    line = roots[:, None] + lengths[:, None, None] * (share * ways[:, None] + share**2 * droop[:, None])
    along = np.gradient(line, axis=1)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    helper = np.where(np.abs(along[..., :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    side = np.cross(along, helper)
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    other = np.cross(along, side)
    angles = 2.0 * np.pi * np.arange(3) / 3.0
    outward = np.cos(angles)[:, None] * side[..., None, :] + np.sin(angles)[:, None] * other[..., None, :]
    taper = radius * (1.0 - 0.85 * share**2)[..., None]
    vertices = line[..., None, :] + taper * outward
    number = np.arange(vertices[..., 0].size).reshape(vertices.shape[:3])
    a, b = number[:, :-1], number[:, 1:]
    quads = np.stack([a, np.roll(a, -1, axis=2), np.roll(b, -1, axis=2), b], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(vertices.reshape(-1, 3), faces, outward.reshape(-1, 3))
