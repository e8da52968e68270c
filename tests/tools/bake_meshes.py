"""Meshes for the tests of `sssgen bake`, with known closed forms, and their files."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest

from folders import MESHES
from sssgen.cli.main import main

Array: TypeAlias = npt.NDArray[np.float64]
Faces: TypeAlias = npt.NDArray[np.int64]

SPOT, SUZANNE = MESHES / "spot.obj", MESHES / "suzanne.obj"
needs_meshes = pytest.mark.skipif(
    not (SPOT.is_file() and SUZANNE.is_file()), reason="the meshes of shared/data/meshes are not part of the project"
)


class MeshData(NamedTuple):
    """A mesh: vertices (v, 3), faces (f, 3), counter-clockwise seen from outside, and optionally uv (f, 3, 2)"""

    vertices: Array
    faces: Faces
    uv: Array | None = None

    @property
    def triangles(self) -> Array:
        """(f, 3, 3)"""
        result: Array = self.vertices[self.faces]
        return result

    def moved(self, by: npt.ArrayLike) -> MeshData:
        return self._replace(vertices=self.vertices + np.asarray(by, float))

    def inverted(self) -> MeshData:
        return self._replace(faces=self.faces[:, ::-1])

    def without(self, *faces: int) -> MeshData:
        return self._replace(faces=np.delete(self.faces, faces, axis=0))


def joined(*parts: MeshData) -> MeshData:
    """The meshes as a single mesh."""
    offsets = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = [part.faces + offset for part, offset in zip(parts, offsets, strict=False)]
    return MeshData(np.concatenate([part.vertices for part in parts]), np.concatenate(faces))


def box(size: npt.ArrayLike = (1.0, 1.0, 1.0), gap: float = 0.04) -> MeshData:
    """A box about the origin; its faces are charts, three by two, that are `gap` apart. Each face has two triangles."""
    vertices, faces, uv = [], [], []
    half = 0.5 * np.asarray(size, float)
    for number, (axis, sign) in enumerate((axis, sign) for axis in range(3) for sign in (1.0, -1.0)):
        normal, side = sign * np.eye(3)[axis], np.eye(3)[(axis + 1) % 3]
        up = np.cross(normal, side)
        corners = [(normal + a * side + b * up) * half for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        low = np.array([number % 3 / 3, number // 3 / 2]) + gap
        high = np.array([(number % 3 + 1) / 3, (number // 3 + 1) / 2]) - gap
        chart = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
        vertices += corners
        for turn in ((0, 1, 2), (0, 2, 3)):
            faces.append([4 * number + at for at in turn])
            uv.append(chart[list(turn)])
    return MeshData(np.array(vertices), np.array(faces), np.array(uv))


def icosphere(radius: float, level: int) -> MeshData:
    """A ball of 20 · 4^level triangles."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    ring = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    vertices = np.array([np.roll(corner, turn) for turn in range(3) for corner in ring], float)
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    # edges join the nearest vertices, and three vertices that are joined by edges are a face
    near = np.linalg.norm(vertices[:, None] - vertices, axis=2) < 1.1
    threes = [
        (a, b, c) for a in range(12) for b in range(a) for c in range(b) if near[a, b] and near[b, c] and near[a, c]
    ]
    faces = np.array([three if np.linalg.det(vertices[list(three)]) > 0.0 else three[::-1] for three in threes])
    for _ in range(level):
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique_edges, edge_of = np.unique(edges[:, 0] * len(vertices) + edges[:, 1], return_inverse=True)
        first, second = unique_edges // len(vertices), unique_edges % len(vertices)
        middles = vertices[first] + vertices[second]
        ab, bc, ca = (len(vertices) + edge_of).reshape(3, -1)
        a, b, c = faces.T
        vertices = np.concatenate([vertices, middles / np.linalg.norm(middles, axis=1, keepdims=True)])
        quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        faces = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])
    return MeshData(radius * vertices, faces)


def globe(radius: float, across: int, up: int) -> MeshData:
    """A ball with faces along longitude and latitude, which are its uv."""
    u, v = np.meshgrid(np.arange(across + 1) / across, np.arange(up + 1) / up)
    uv = np.stack([u.ravel(), v.ravel()], axis=1)
    longitude, latitude = 2.0 * np.pi * (uv[:, 0] % 1.0), np.pi * (uv[:, 1] - 0.5)
    flat = np.where(np.isin(uv[:, 1], (0.0, 1.0)), 0.0, np.cos(latitude))
    vertices = radius * np.stack([flat * np.cos(longitude), np.sin(latitude), -flat * np.sin(longitude)], axis=1)
    row, column = np.mgrid[:up, :across].reshape(2, -1)
    a = row * (across + 1) + column
    b, c, d = a + 1, a + across + 2, a + across + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1)[row > 0], np.stack([a, c, d], axis=1)[row < up - 1]])
    return MeshData(vertices, faces, uv[faces])


def torus(major: float, minor: float, around: int, about: int) -> MeshData:
    """A torus about y."""
    row, column = np.mgrid[:around, :about].reshape(2, -1)
    a, b = 2.0 * np.pi * row / around, 2.0 * np.pi * column / about
    ring = major + minor * np.cos(b)
    vertices = np.stack([ring * np.cos(a), minor * np.sin(b), -ring * np.sin(a)], axis=1)
    start, next_start = row * about, (row + 1) % around * about
    up = (column + 1) % about
    quad = start + column, next_start + column, next_start + up, start + up
    faces = np.concatenate(
        [np.stack([quad[0], quad[1], quad[2]], axis=1), np.stack([quad[0], quad[2], quad[3]], axis=1)]
    )
    return MeshData(vertices, faces)


def write(path: Path, result: MeshData) -> str:
    """Writes the mesh as .obj, or without uv as binary .ply; returns the path."""
    if path.suffix == ".ply":
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(result.vertices)}"]
        head += [f"property double {axis}" for axis in "xyz"]
        head += [f"element face {len(result.faces)}", "property list uchar int vertex_indices", "end_header", ""]
        rows: npt.NDArray[Any] = np.zeros(len(result.faces), [("count", "u1"), ("corners", "<i4", 3)])
        rows["count"], rows["corners"] = 3, result.faces
        path.write_bytes("\n".join(head).encode() + result.vertices.astype("<f8").tobytes() + rows.tobytes())
        return str(path)
    lines = ["v {!r} {!r} {!r}".format(*place) for place in result.vertices.tolist()]
    if result.uv is None:
        lines += ["f {} {} {}".format(*face) for face in (result.faces + 1).tolist()]
    else:
        lines += ["vt {!r} {!r}".format(*place) for place in result.uv.reshape(-1, 2).tolist()]
        for at, (a, b, c) in enumerate((result.faces + 1).tolist()):
            lines.append(f"f {a}/{3 * at + 1} {b}/{3 * at + 2} {c}/{3 * at + 3}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


def crossings(
    triangles: Array, origins: Array, ways: Array, at_once: int = 2**22
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Distances along rays (n, 3) to triangles (f, 3, 3), and whether they are hit: (n, f) (Möller, Trumbore 1997)."""
    first_edge, second_edge = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    lengths, met = [], []
    for chunk in np.array_split(np.arange(len(origins)), max(1, len(origins) * len(triangles) // at_once)):
        across = np.cross(ways[chunk, None], second_edge)
        scale = np.einsum("nfc,fc->nf", across, first_edge)
        with np.errstate(divide="ignore", invalid="ignore"):
            from_corner = origins[chunk, None] - triangles[:, 0]
            u = np.einsum("nfc,nfc->nf", from_corner, across) / scale
            turned = np.cross(from_corner, first_edge)
            v = np.einsum("nc,nfc->nf", ways[chunk], turned) / scale
            t = np.einsum("fc,nfc->nf", second_edge, turned) / scale
            met.append((u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > 0.0))
        lengths.append(t)
    return np.concatenate(lengths), np.concatenate(met)


def bake(*arguments: str) -> None:
    """Runs `sssgen bake`, which must succeed."""
    assert main(["bake", *arguments]) == 0


def facts(path: str) -> Any:
    """The contents of the JSON file of a baked file."""
    return json.loads(Path(path + ".json").read_text(encoding="utf-8"))


def to_exit(size: Array, places: Array, ways: Array) -> Array:
    """The length inside a box about the origin, from places within it on."""
    with np.errstate(divide="ignore"):
        result: Array = ((0.5 * size * np.sign(ways) - places) / ways).min(axis=-1)
    return np.maximum(result, 0.0)


def by_quadrature(size: Array, place: Array, normal: Array, of: Callable[[Array], Array], count: int = 200) -> float:
    """The mean of what `of` makes of lengths inward, weighted by their cosine: midpoints of the unit disk."""
    square, turn = np.meshgrid((np.arange(count) + 0.5) / count, 2.0 * np.pi * (np.arange(count) + 0.5) / count)
    side = np.roll(normal, 1)
    across = np.cross(normal, side)
    ways = (
        np.sqrt(square)[..., None] * (np.cos(turn)[..., None] * side + np.sin(turn)[..., None] * across)
        - np.sqrt(1.0 - square)[..., None] * normal
    )
    return float(of(to_exit(size, place, ways)).mean())
