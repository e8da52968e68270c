"""Modelling with distance functions: bodies as functions of points, and meshes of them.

A distance function takes points, (n, 3) in world units, and returns (n,): negative inside. Blends and noise make it a
bound rather than the distance; `meshed` moves the vertices onto its surface all the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import numpy.typing as npt
from scipy.ndimage import map_coordinates
from scipy.spatial.transform import Rotation

from hero_stage.mesh import Mesh

Array = npt.NDArray[np.float64]
Distance = Callable[[Array], Array]
_LATTICE = 48
"""The period of the noise in cells."""
_CHUNK = 2_000_000


def ellipsoid(p: Array, center: Sequence[float], radii: Sequence[float], turn: Sequence[float] = (0, 0, 0)) -> Array:
    """An ellipsoid, turned by angles in degrees about x, y and z; the distance near its surface."""
    local = (p - center) @ Rotation.from_euler("xyz", turn, degrees=True).as_matrix()
    scaled = local / radii
    length = np.linalg.norm(scaled, axis=-1)
    slope = np.linalg.norm(scaled / radii, axis=-1)
    return length * (length - 1.0) / np.maximum(slope, 1e-9)


def sphere(p: Array, center: Sequence[float], radius: float) -> Array:
    return np.linalg.norm(p - center, axis=-1) - radius


def capsule(p: Array, start: Sequence[float], end: Sequence[float], first: float, last: float | None = None) -> Array:
    """A round limb, whose radius goes from `first` to `last`."""
    axis = np.subtract(end, start)
    along = np.clip((p - start) @ axis / max(float(axis @ axis), 1e-12), 0.0, 1.0)
    radius = first + ((first if last is None else last) - first) * along
    return np.linalg.norm(p - start - along[:, None] * axis, axis=-1) - radius


def box(p: Array, center: Sequence[float], half: Sequence[float], edge: float = 0.0) -> Array:
    """A box with round edges of the radius `edge`."""
    q = np.abs(p - center) - np.subtract(half, edge)
    return np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0) - edge


def cylinder(p: Array, center: Sequence[float], radius: float, half_height: float, edge: float = 0.0) -> Array:
    """A cylinder about the y axis with round edges."""
    local = p - center
    q = np.stack([np.hypot(local[:, 0], local[:, 2]) - radius, np.abs(local[:, 1]) - half_height], axis=-1) + edge
    return np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0) - edge


def joined(first: Array, *others: Array, blend: float) -> Array:
    """The union, whose parts flow together over `blend` units (Quilez, Smooth minimum, cubic)."""
    for other in others:
        h = np.maximum(blend - np.abs(first - other), 0.0) / blend
        first = np.minimum(first, other) - h**3 * blend / 6.0
    return first


def cut(body: Array, tool: Array, blend: float) -> Array:
    """The body without the tool, with a soft edge."""
    return -joined(-body, tool, blend=blend)


@cache
def _lattice(seed: int) -> Array:
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (_LATTICE,) * 3)


def noise(p: Array, frequency: float, octaves: int = 1, seed: int = 0, gain: float = 0.5) -> Array:
    """Smooth noise, about -1 to 1: a cubic spline over random numbers of a lattice; each octave has half the size."""
    total, weight = np.zeros(len(p)), 1.0
    for octave in range(octaves):
        place = (p * frequency * 2.0**octave).T + 7.3 * octave
        total += weight * map_coordinates(_lattice(seed + octave), place, order=3, mode="grid-wrap", prefilter=False)
        weight *= gain
    return 2.0 * total


def meshed(distance: Distance, low: Sequence[float], high: Sequence[float], cells: int) -> Mesh:
    """The surface in a box as triangles, with normals by the function's slope; `cells` along the longest side."""
    from skimage.measure import marching_cubes

    step = float(np.ptp([low, high], axis=0).max()) / cells
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    values = np.concatenate([distance(part) for part in np.array_split(grid, len(grid) // _CHUNK + 1)])
    vertices, faces, _, _ = marching_cubes(values.reshape([len(axis) for axis in axes]), 0.0)
    vertices = vertices * step + low
    for _ in range(2):
        value, slope = distance(vertices), sloped(distance, vertices, 0.2 * step)
        square = np.maximum((slope**2).sum(axis=-1), 1e-4)
        vertices -= slope * np.clip(value / square, -step, step)[:, None]
    normals = sloped(distance, vertices, 0.5 * step)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    return Mesh(vertices, faces.astype(np.int64), normals)


def sloped(distance: Distance, p: Array, step: float) -> Array:
    """The gradient by central differences, (n, 3)."""
    shifts = step * np.eye(3)
    return np.stack([(distance(p + s) - distance(p - s)) / (2.0 * step) for s in shifts], axis=-1)


def sheet(side: float, height: float = 0.0) -> Mesh:
    """A square floor; its picture is repeated on every unit."""
    corners = np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]) * [0.5 * side, 1.0, 0.5 * side]
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    uv = corners[:, [0, 2]] * [1.0, -1.0]
    return Mesh(corners + np.array([0.0, height, 0.0]), faces, np.tile([0.0, 1.0, 0.0], (4, 1)), uv=uv)


def smooth_step(low: float, high: float, x: Array) -> Array:
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def lattice_points(mesh: Mesh, cells: int) -> tuple[Array, tuple[int, int, int]]:
    """The points of a lattice over the box of a mesh, x fastest, and its shape (z, y, x)."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    counts = np.maximum(np.rint(cells * (high - low) / (high - low).max()).astype(int), 2)
    axes = [np.linspace(a, b, count) for a, b, count in zip(low, high, counts, strict=True)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), (counts[2], counts[1], counts[0])


def planks(side: int, color: Sequence[float], seed: int, count: int = 4) -> Array:
    """A picture of boards, (side, side, 3), that repeats: fibres along x, a gap between boards."""
    across, along = (np.indices((side, side)) + 0.5) / side
    board = np.floor(across * count)
    random = np.random.default_rng(seed).uniform(size=(count, 3))[board.astype(int)]
    place = np.stack(
        [_LATTICE / 8 * along + 9.0 * random[..., 0], _LATTICE * across, 5.0 * random[..., 1]], axis=-1
    ).reshape(-1, 3)
    rings = np.sin(14.0 * (place[:, 1] * 0.18 + 0.6 * noise(place * [0.35, 0.12, 1.0], 1.0, 2, seed)))
    fibre = noise(place * [0.8, 5.0, 1.0], 1.0, 3, seed + 7)
    gap = np.exp(-((np.abs(across * count - np.round(across * count)) / 0.02) ** 2)).ravel()
    light = (0.85 + 0.12 * rings + 0.22 * fibre + 0.35 * (random[..., 2].ravel() - 0.5)) * (1.0 - 0.85 * gap)
    return np.clip(light[:, None] * np.array(color), 0.0, 1.0).reshape(side, side, 3)
