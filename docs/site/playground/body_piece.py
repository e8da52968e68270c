"""A body's triangles as a small file: shared corners, whole numbers, differences, and bytes of equal weight together.

The page's `pieces.js` reads it. Positions and texture coordinates keep 14 bits, normals 11 along each axis of their
octahedron, so that no difference is visible in a picture of a few thousand pixels.
"""

from __future__ import annotations

import struct

import numpy as np
import numpy.typing as npt

POSITION_BITS, NORMAL_BITS, UV_BITS = 14, 11, 14
HEADER = "<II10f"
"""Corners, triangles, then the lowest position and the extent (3 + 3), and the same of the coordinates (2 + 2)."""

Array = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]


def packed_body(triangles: bytes) -> bytes:
    """The file of a body from `BodyTriangles.pack()`: position, normal and uv of each corner as 8 float32."""
    rows = np.frombuffer(triangles, "<f4").reshape(-1, 8).astype(np.float64)
    position, low, extent = _whole(rows[:, :3], POSITION_BITS)
    uv, uv_low, uv_extent = _whole(rows[:, 6:], UV_BITS)
    corners = np.concatenate([position, _octahedral(rows[:, 3:6]), uv], axis=1)
    _, first, index = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    index, corners = rank[index.ravel()], corners[first[order]]
    newest = np.maximum.accumulate(np.concatenate([[-1], index[:-1]])) + 1  # the next corner that is not yet used
    columns = np.diff(corners, axis=0, prepend=0).T
    header = struct.pack(HEADER, len(corners), len(index) // 3, *low, *extent, *uv_low, *uv_extent)
    return header + b"".join(_planes(column, 2) for column in columns) + _planes(newest - index, 3)


def _whole(values: Array, bits: int) -> tuple[Whole, Array, Array]:
    """The columns as whole numbers from 0 to 2^bits - 1, with their lowest values and extents."""
    low, extent = values.min(axis=0), np.maximum(np.ptp(values, axis=0), 1e-9)
    return np.rint((values - low) / extent * (2**bits - 1)).astype(np.int64), low, extent


def _octahedral(normals: Array) -> Whole:
    """Unit vectors on the unfolded octahedron: two whole numbers from 0 to 2^bits - 1."""
    flat = normals / np.maximum(np.abs(normals).sum(axis=1, keepdims=True), 1e-9)
    x, y = flat[:, 0], flat[:, 1]
    sign_x, sign_y = np.where(x >= 0.0, 1.0, -1.0), np.where(y >= 0.0, 1.0, -1.0)
    below = flat[:, 2] < 0.0
    folded = np.where(below, (1.0 - np.abs(y)) * sign_x, x), np.where(below, (1.0 - np.abs(x)) * sign_y, y)
    result: Whole = np.rint((np.stack(folded, axis=1) * 0.5 + 0.5) * (2**NORMAL_BITS - 1)).astype(np.int64)
    return result


def _planes(numbers: Whole, size: int) -> bytes:
    """Numbers with signs as whole ones (0, -1, 1, -2 …), then first all their low bytes, then the next ones."""
    coded = np.where(numbers < 0, -2 * numbers - 1, 2 * numbers)
    return b"".join((coded >> (8 * place) & 255).astype(np.uint8).tobytes() for place in range(size))
