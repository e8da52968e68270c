"""A bust: a head with hair that is bound to a knot, on shoulders that end in a curve, before a wall and columns."""

from __future__ import annotations

import dataclasses

import numpy as np
import trimesh
from hero_stage import human
from hero_stage.mesh import Mesh, merged
from hero_stage.shapes import Array, ellipsoid, joined, meshed, noise, smooth_step, sphere
from scipy.spatial.transform import Rotation

TARGETS = {
    "macrodetails/caucasian-female-young": 1.0,
    "macrodetails/universal-female-young-averagemuscle-averageweight": 1.0,
    "nose/nose-greek-incr": 0.8,
    "eyeBlinkLeft": 0.05,
    "eyeBlinkRight": 0.05,
    "mouthPressLeft": 0.3,
    "mouthPressRight": 0.3,
}
MIDDLE = np.array([0.0, 6.61, 0.45])
KNOT = np.array([0.0, 0.12, -0.78])
"""Where the hair is bound"""
SCALP = np.array([0.0, 0.35, -0.05])
"""The middle of the head, around which hair is combed"""


def turned(p: Array) -> Array:
    """The head looks to its left and down a little, and the neck follows."""
    share = smooth_step(-1.5, -0.5, p[:, 1])
    pivot = np.array([0.0, -0.6, -0.1])
    turns = Rotation.from_euler("YXZ", np.stack([34.0 * share, 5.0 * share, -6.0 * share], axis=-1), degrees=True)
    return turns.apply(p - pivot) + pivot


def hairline(p: Array) -> Array:
    """Positive where hair grows; about the distance to its edge."""
    y, z = p[:, 1], p[:, 2]
    places = [-1.2, -0.55, -0.3, -0.12, 0.1, 0.22, 0.3, 0.42, 0.62, 0.8, 0.9]
    edge = np.interp(z, places, [-0.6, -0.5, -0.35, -0.1, 0.12, 0.06, 0.12, 0.4, 0.62, 0.74, 0.86])
    return y - edge + 0.02 * noise(p, 3.0, 2)


def combed(p: Array, wave: float) -> tuple[Array, Array]:
    """Of places on the scalp: the number of the strand, as an angle around the knot, and how far from the knot."""
    way = p - SCALP
    axis = KNOT - SCALP
    axis = axis / np.linalg.norm(axis)
    side = np.array([1.0, 0.0, 0.0])
    up = np.cross(axis, side)
    away = np.arccos(np.clip(way @ axis / np.linalg.norm(way, axis=1), -1.0, 1.0))
    around = np.arctan2(way @ side, way @ up)
    return around + wave * np.sin(5.5 * away + 1.2 * np.cos(2.0 * around)), away


def locks(p: Array, wave: float = 0.09) -> Array:
    """The height of the hair's relief, about 0 to 1."""
    around, away = combed(p, wave)
    height = np.zeros(len(p))
    for count, weight, seed in ((14, 0.6, 1), (31, 0.3, 2), (83, 0.1, 3)):
        bend = 0.5 * noise(np.stack([np.cos(around), np.sin(around), 0.5 * away], axis=-1), 2.0, 1, seed)
        height += weight * np.abs(np.sin(0.5 * count * around + 2.0 * bend)) ** 0.7
    return height * smooth_step(0.15, 0.5, away)


def figure(levels: int) -> Mesh:
    """Head, neck and shoulders with the relief of combed hair, closed below."""
    vertices, quads = human.body(TARGETS)
    vertices = vertices - MIDDLE
    vertices, quads = human.kept(vertices, quads, (vertices[:, 1] > -3.6) & (np.abs(vertices[:, 0]) < 2.3))
    vertices, quads = human.closed(vertices, quads)
    vertices, quads = human.subdivided(vertices, quads, levels)
    normals = human.normals(vertices, quads)
    ears = sum(human.moved_share(TARGETS, f"ears/{side}-ear-wing-incr", vertices + MIDDLE) for side in "lr")
    grown = smooth_step(-0.02, 0.16, hairline(vertices)) * (1.0 - smooth_step(0.0, 0.06, np.asarray(ears)))
    vertices = vertices + (grown * (0.06 + 0.1 * locks(vertices)))[:, None] * normals
    vertices = turned(vertices)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(vertices, triangles, human.normals(vertices, quads))


def knot(p: Array) -> Array:
    """The distance to hair that is wound up behind the head."""
    q = p - KNOT - [0.0, 0.0, -0.2]
    around = np.arctan2(q[:, 1], q[:, 0])
    away = np.linalg.norm(q[:, :2], axis=1)
    turns = 0.5 + 0.5 * np.sin(5.0 * around + 16.0 * away)
    fine = np.abs(np.sin(14.0 * around + 42.0 * away + noise(p, 4.0)))
    return (
        ellipsoid(q, (0, 0, 0), (0.36, 0.34, 0.28))
        + 0.05 * (1.0 - turns) * smooth_step(0.02, 0.12, away)
        - 0.012 * fine
    )


def block(p: Array) -> Array:
    """What the stone's bust keeps of the body."""
    lower = ellipsoid(p, (0.0, -1.55, -0.1), (1.42, 1.5, 1.0))
    return joined(lower, ellipsoid(p, (0.0, 0.0, 0.1), (1.3, 1.8, 1.8)), blend=0.1)


def column(p: Array) -> Array:
    """The shaft of a fluted column, and its foot, which stands at the origin."""
    away, around = np.hypot(p[:, 0], p[:, 2]), np.arctan2(p[:, 2], p[:, 0])
    shaft = away - 0.62 + 0.05 * np.abs(np.cos(10.0 * around)) + 0.01 * p[:, 1]
    foot = joined(np.hypot(away - 0.66, p[:, 1] - 0.5) - 0.16, np.maximum(away - 0.9, p[:, 1] - 0.3), blend=0.06)
    return 0.6 * joined(shaft, foot, blend=0.05)


def columned() -> Mesh:
    """A column with the light of the window, at its side, as its colour."""
    shape = meshed(column, (-1.0, 0.0, -1.0), (1.0, 13.0, 1.0), 170)
    n = shape.normals
    warm = np.clip(n @ [0.86, 0.2, 0.46], 0.0, 1.0) ** 1.3
    cool = 0.5 + 0.5 * n[:, 1] - 0.3 * n[:, 0]
    color = warm[:, None] * [0.85, 0.68, 0.46] + np.clip(cool, 0, 1)[:, None] * [0.09, 0.115, 0.115]
    return shape.with_colors(color, occluded=False)


def wall() -> Mesh:
    """A wall across the view, with the light of a lamp on it as the colour of its vertices."""
    u, v = np.meshgrid(np.linspace(-16.0, 16.0, 65), np.linspace(-6.0, 8.0, 33), indexing="ij")
    number = np.arange(u.size).reshape(u.shape)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    vertices = np.stack([u, v, np.full_like(u, -13.0)], axis=-1).reshape(-1, 3)
    glow = 1.0 / (1.0 + ((vertices[:, 0] - 5.5) / 4.0) ** 2 + ((vertices[:, 1] - 2.5) / 2.8) ** 2) ** 1.4
    panel = np.where(vertices[:, 1] < -2.2, 0.45, 1.0)
    color = (0.06 + glow)[:, None] * panel[:, None] * [0.16, 0.2, 0.18] + 0.05 * (glow**2)[:, None] * [1.0, 0.6, 0.25]
    shape = Mesh(vertices, faces, np.tile([0.0, 0.0, 1.0], (len(vertices), 1)))
    return shape.with_colors(4.0 * color, occluded=False)


def eyes() -> Mesh:
    """Blank eyeballs, of the size of the package's."""
    places, _ = human.body(TARGETS)
    parts = []
    for numbers in (slice(14598, 14670), slice(14670, 14742)):
        corners = places[numbers] - MIDDLE
        middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
        radius = 0.5 * float(np.ptp(corners[:, 1]))
        ball = meshed(lambda p, c=middle, r=radius: sphere(p, c, r), middle - 1.1 * radius, middle + 1.1 * radius, 48)
        vertices = turned(ball.vertices)
        parts.append(Mesh(vertices, ball.faces, human.normals(vertices, ball.faces)))
    return merged(*parts)


def cut(shape: Mesh, tool: Mesh) -> Mesh:
    """What of a shape is inside a tool."""
    both = [trimesh.Trimesh(part.vertices, part.faces, process=False) for part in (shape, tool)]
    result = trimesh.boolean.intersection(both, engine="manifold", check_volume=False)
    vertices, faces = np.array(result.vertices), np.array(result.faces)
    return Mesh(vertices, faces, human.normals(vertices, faces))


def stained(shape: Mesh) -> Mesh:
    """With the colours of veined marble, as solid as the stone, and less of them where little light arrives."""
    p = shape.vertices
    bent = p + 0.35 * np.stack([noise(p, 0.8, 4, seed) for seed in (1, 2, 3)], axis=-1)
    tint = np.tile([0.95, 0.93, 0.9], (len(p), 1)) * (1.0 + 0.05 * noise(bent, 1.1, 3, 5))[:, None]
    for frequency, width, depth, seed, color in (
        (0.5, 0.06, 0.95, 21, (0.2, 0.22, 0.26)),
        (0.9, 0.05, 0.8, 25, (0.3, 0.31, 0.34)),
        (1.7, 0.05, 0.4, 33, (0.5, 0.46, 0.41)),
    ):
        line = np.exp(-((noise(bent, frequency, 4, seed) / width) ** 2))
        halo = 0.3 * np.exp(-((noise(bent, frequency, 4, seed) / (5.0 * width)) ** 2))
        patch = np.clip(0.55 + 1.1 * noise(p, 0.5, 2, seed + 2), 0.0, 1.0)
        share = (depth * np.clip(line + halo, 0, 1) * patch)[:, None]
        tint = tint * (1.0 - share) + share * np.array(color)
    seen = shape.with_colors(tint)
    dark = np.clip(seen.colors[:, 3:], 0.03, 1.0) ** [0.6, 0.64, 0.68]
    return dataclasses.replace(seen, colors=np.column_stack([np.clip(tint * dark, 0, 1), seen.colors[:, 3]]))


def meshes(cells: int) -> dict[str, Mesh]:
    tool = meshed(block, (-1.6, -3.2, -2.0), (1.6, 2.0, 2.0), 150)
    tie = meshed(knot, (-0.45, -0.3, -1.4), (0.45, 0.55, -0.6), 110)
    tie_vertices = turned(tie.vertices)
    tie = Mesh(tie_vertices, tie.faces, human.normals(tie_vertices, tie.faces))
    bust = merged(cut(figure(cells), tool), tie, eyes())
    return {
        "bust": stained(bust),
        "column": columned(),
        "wall": wall(),
    }
