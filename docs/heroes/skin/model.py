"""A head with closed eyes and hair as short as a brush; the middle between its ears is the origin."""

from __future__ import annotations

import numpy as np
from hero_stage import hair, human
from hero_stage.mesh import Mesh, merged, mirrored
from hero_stage.shapes import Array, noise, smooth_step
from scipy.spatial.transform import Rotation

TARGETS = {
    "macrodetails/caucasian-female-young": 1.0,
    "macrodetails/universal-female-young-averagemuscle-averageweight": 1.0,
    "eyeBlinkLeft": 1.0,
    "eyeBlinkRight": 1.0,
    "ears/l-ear-wing-incr": 0.5,
    "mouthPressLeft": 0.8,
    "mouthPressRight": 0.8,
}
MIDDLE = np.array([0.0, 6.61, 0.45])
VIEW = np.array([0.866, 0.0, 0.5])
"""The way to the camera"""
SUN = np.array([0.24, 0.16, -0.96])
"""The way to the sun"""
# fmt: off
LIDS = np.array([
    [0.175, 0.122, 0.802], [0.225, 0.1, 0.812], [0.278, 0.094, 0.814], [0.323, 0.092, 0.812], [0.36, 0.093, 0.8],
    [0.39, 0.1, 0.785], [0.41, 0.108, 0.775],
])
# fmt: on
"""Where the lashes of the left eye grow"""
BROW = [0.08, 0.2, 0.36, 0.56], [0.345, 0.395, 0.43, 0.35]
"""x and y of the left brow"""


def cage() -> tuple[Array, np.ndarray]:
    """The quads of head, neck and shoulders, closed below."""
    vertices, quads = human.body(TARGETS)
    vertices = vertices - MIDDLE
    vertices, quads = human.kept(vertices, quads, (vertices[:, 1] > -2.2) & (np.abs(vertices[:, 0]) < 1.9))
    return human.closed(vertices, quads)


def hairline(p: Array) -> Array:
    """Positive where hair grows; about the distance to its edge."""
    y, z = p[:, 1], p[:, 2]
    edge = np.interp(
        z,
        [-1.2, -0.55, -0.3, -0.12, 0.1, 0.22, 0.3, 0.42, 0.62, 0.8, 0.9],
        [-0.8, -0.75, -0.45, 0.0, 0.25, 0.0, 0.05, 0.45, 0.72, 0.88, 1.05],
    )
    return y - edge + 0.05 * noise(p, 3.0, 2)


def head(levels: int) -> Mesh:
    """The skin, subdivided, with its colours."""
    shape = human.mesh(*human.subdivided(*cage(), levels))
    p = shape.vertices
    bumps = 0.0035 * noise(p, 9.0, 3, seed=3) + 0.0012 * noise(p, 40.0, 2, seed=4)
    shape = Mesh(p + bumps[:, None] * shape.normals, shape.faces, shape.normals)
    shape = Mesh(shape.vertices, shape.faces, human.normals(shape.vertices, shape.faces))
    lip = sum(
        human.moved_share(TARGETS, f"mouth/mouth-{part}lip-volume-incr", p + MIDDLE) for part in ("upper", "lower")
    )
    lips = smooth_step(0.1, 0.5, np.asarray(lip))
    ear = smooth_step(0.6, 0.75, np.abs(p[:, 0])) * (np.abs(p[:, 1]) < 0.45)
    cheek = np.exp(-((p - [0.5, -0.05, 0.75]) ** 2).sum(axis=1) / 0.09)
    nose = np.exp(-((p - [0.0, 0.0, 1.15]) ** 2).sum(axis=1) / 0.03)
    tint = np.ones((len(p), 3)) * (0.9 + 0.08 * noise(p, 6.0, 3, seed=8))[:, None]
    tint *= 1.0 - np.clip(0.55 * (cheek + nose) + 1.6 * ear, 0, 2)[:, None] * [0.0, 0.2, 0.18]
    tint *= 1.0 - lips[:, None] * [0.1, 0.42, 0.36]
    spots = smooth_step(0.62, 0.9, noise(p, 16.0, 2, seed=21)) * smooth_step(-0.2, 0.5, noise(p, 2.0, 2, seed=22))
    tint *= 1.0 - spots[:, None] * [0.22, 0.38, 0.45]
    stubble = smooth_step(-0.03, 0.1, hairline(p))
    tint *= 1.0 - stubble[:, None] * [0.62, 0.6, 0.54]
    seen = shape.with_colors(tint)
    # the picture of diffuse light has no occlusion: the colour has it, less in red, which the skin spreads
    dark = np.clip(seen.colors[:, 3:], 0.02, 1.0) ** [0.7, 1.05, 1.15]
    return Mesh(seen.vertices, seen.faces, seen.normals, np.column_stack([tint * dark, seen.colors[:, 3]]))


def facing(shape: Mesh) -> Array:
    """The cosine between the normal and the way to the camera."""
    return shape.normals @ VIEW


def brush(shape: Mesh, count: int) -> Mesh:
    """Hair as short as a brush, where the camera may see it."""
    grown = smooth_step(0.0, 0.06, hairline(shape.vertices)) * (facing(shape) > -0.3)
    ear = (np.abs(shape.vertices[:, 0]) > 0.7) & (shape.vertices[:, 1] < 0.34) & (shape.vertices[:, 2] > -0.25)
    roots, ways = hair.scattered(shape, grown * ~ear, count, 1)
    random = np.random.default_rng(2)
    lie = np.array([0.0, -0.5, -0.9]) - ways * (ways @ [0.0, -0.5, -0.9])[:, None]
    bent = ways + 0.9 * lie + 0.2 * random.normal(size=roots.shape)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    lengths = random.uniform(0.05, 0.11, count)
    return hair.strands(roots - 0.01 * ways, bent, lengths, 0.0009, 0.25 * lie, 2)


def fuzz(shape: Mesh, count: int) -> Mesh:
    """Fine hairs, which are seen against the light alone."""
    p = shape.vertices
    edge = 1.0 - smooth_step(0.1, 0.4, np.abs(facing(shape)))
    wanted = edge * smooth_step(0.0, 0.3, shape.normals @ SUN) * (hairline(p) < 0.0) * (p[:, 1] > -1.2)
    roots, ways = hair.scattered(shape, wanted, count, 5)
    random = np.random.default_rng(6)
    lie = np.array([0.0, -0.8, -0.4]) - ways * (ways @ [0.0, -0.8, -0.4])[:, None]
    bent = ways + 1.2 * lie + 0.25 * random.normal(size=roots.shape)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    return hair.strands(roots, bent, random.uniform(0.01, 0.028, count), 0.0003, 0.2 * lie, 2)


def lashes() -> Mesh:
    """Of both eyes."""
    random = np.random.default_rng(9)
    share = np.sort(random.uniform(0.0, 1.0, 170))
    at = np.linspace(0.0, 1.0, len(LIDS))
    roots = np.stack([np.interp(share, at, LIDS[:, part]) for part in range(3)], axis=-1)
    ways = np.stack([1.5 * (roots[:, 0] - 0.27), -0.45 + 0.0 * share, 0.8 + 0.0 * share], axis=-1)
    ways += 0.12 * random.normal(size=roots.shape)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    droop = np.tile([0.0, 0.45, 0.1], (len(roots), 1))
    lengths = (0.055 + 0.045 * share) * random.uniform(0.75, 1.1, len(share))
    one = hair.strands(roots, ways, lengths, 0.0007, droop, 6)
    return merged(one, mirrored(one))


def brows(shape: Mesh, count: int) -> Mesh:
    """Hairs of both brows: upwards near the nose, then outwards."""
    p = shape.vertices
    middle = np.interp(p[:, 0], *BROW)
    width = np.interp(p[:, 0], [0.06, 0.1, 0.3, 0.56], [0.0, 0.045, 0.04, 0.012])
    near = np.exp(-(((p[:, 1] - middle) / np.maximum(width, 1e-3)) ** 2)) * (p[:, 0] > 0.07) * (p[:, 0] < 0.56)
    roots, ways = hair.scattered(shape, near * (p[:, 2] > 0.4), count, 11)
    random = np.random.default_rng(12)
    above = roots[:, 1] - np.interp(roots[:, 0], *BROW)
    upward = np.clip(1.0 - (roots[:, 0] - 0.1) / 0.2, 0.0, 1.0) - above / 0.042
    lie = np.stack([0.9 + 0.0 * upward, 0.1 + 0.35 * upward - 0.5 * (roots[:, 0] > 0.36), -0.2 + 0.0 * upward], axis=-1)
    lie -= ways * (lie * ways).sum(axis=1, keepdims=True)
    bent = 0.35 * ways + lie + 0.15 * random.normal(size=roots.shape)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    one = hair.strands(
        roots - 0.004 * ways, bent, random.uniform(0.045, 0.09, count), 0.0005, 0.1 * lie - 0.25 * ways, 4
    )
    return merged(one, mirrored(one))


def raised(mesh: Mesh) -> Mesh:
    """With the chin up."""
    turn = Rotation.from_euler("x", -9.0, degrees=True).as_matrix().T
    vertices = mesh.vertices @ turn
    # the frame for pores: texture coordinates across the view, so that no face that is seen lies along one of them
    uv = np.stack([vertices @ np.cross([0.0, 1.0, 0.0], VIEW), vertices[:, 1]], axis=-1)
    return Mesh(vertices, mesh.faces, mesh.normals @ turn, mesh.colors, uv if len(mesh.colors) else mesh.uv)


def mouth(skin: Mesh) -> Mesh:
    """What is seen between the lips, over the skin there."""
    p = skin.vertices
    inside = (skin.colors[:, 3] < 0.16) & (np.abs(p[:, 0]) < 0.3) & (np.abs(p[:, 1] + 0.4) < 0.2) & (p[:, 2] > 0.5)
    return Mesh(p + 0.004 * skin.normals, skin.faces[inside[skin.faces].all(axis=1)], skin.normals)


def meshes(cells: int) -> dict[str, Mesh]:
    skin = head(cells)
    parts = {
        "head": skin,
        "mouth": mouth(skin),
        "brush": brush(skin, 42000),
        "fuzz": fuzz(skin, 4000),
        "brows": merged(brows(skin, 640), lashes()),
    }
    return {name: raised(mesh) for name, mesh in parts.items()}
