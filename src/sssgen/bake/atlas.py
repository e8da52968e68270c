"""A mesh's texture coordinates as a map: the surface point of each texel."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.bake.voxel_distance import BLOCK
from sssgen.bake.voxel_grid import Array
from sssgen.scene.mesh import Triangles, barycentric
from sssgen.scene.mesh_rays import MeshRays
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need
from sssgen.support.paths import posix

Indices: TypeAlias = npt.NDArray[np.int64]

SHARED = 0.02
"""The share of texels with several surface points beyond which a warning is reported."""


class Atlas(NamedTuple):
    """The texels of a map that have a surface point."""

    texels: Indices
    """(n,): indices of the texels, row by row, row 0 at the top"""
    places: Array
    """(n, 3): the points of their centres"""
    flat: Array
    """(n, 3): the unit normals of the triangles there"""
    shared: float
    """The share of texels with more than one surface point"""


def atlas(mesh: Triangles, uv: Array, size: tuple[int, int], path: str) -> Atlas:
    """The surface points at the centres of a map's texels.

    `uv` is (f, 3, 2), v up; coordinates outside 0..1 belong to the next tile. Raises SssgenError for texture
    coordinates that repeat the map or cover no texel.
    """
    width, height = size
    tiles = np.floor(uv.min(axis=(0, 1)) + 0.5 / np.array(size)), np.ceil(uv.max(axis=(0, 1)) - 0.5 / np.array(size))
    if (tiles[0] < -1).any() or (tiles[1] > 2).any():
        hint = "--unwrap makes new ones"
        raise failure(
            "the texture coordinates repeat the map: its texels have several surface points", hint, posix(path)
        )
    layout = uv * np.array([width, height])
    edges = layout[:, 1:] - layout[:, :1]
    areas = 0.5 * (edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    solid = np.flatnonzero(areas != 0.0)
    if not len(solid):
        raise failure("the texture coordinates have no area", "--unwrap makes new ones", posix(path))
    # a ray onto the flat map finds the triangle that covers the centre of a texel, on this or on the next tile
    raised = np.concatenate([layout[solid], np.zeros((len(solid), 3, 1))], axis=2)
    rays = MeshRays(raised.reshape(-1, 3), np.arange(3 * len(solid)).reshape(-1, 3))
    faces = np.full(width * height, -1)
    shown = np.zeros((width * height, 3))
    for across in range(int(tiles[0][0]), int(tiles[1][0])):
        for up in range(int(tiles[0][1]), int(tiles[1][1])):
            for start in range(0, len(faces), BLOCK):
                number = np.arange(start, min(start + BLOCK, len(faces)))
                number = number[faces[number] < 0]
                x, y = number % width + 0.5 + across * width, height - number // width - 0.5 + up * height
                shown[number] = np.stack([x, y, np.zeros(len(number))], axis=1)
                down = np.broadcast_to(np.array([0.0, 0.0, -1.0]), (len(number), 3))
                faces[number] = rays.first(shown[number] - down, down)
    texels = np.flatnonzero(faces >= 0)
    if not len(texels):
        raise failure("no texel's centre is covered by the mesh", "use a larger --size", posix(path))
    face = solid[faces[texels]]
    places = np.einsum("nv,nvc->nc", barycentric(shown[texels], raised[faces[texels]]), mesh.places[mesh.corners[face]])
    covered = float(np.abs(areas).sum())
    return Atlas(texels, places, mesh.flat[face], max(0.0, 1.0 - len(texels) / covered))


def fill_map(values: Array, texels: Indices, size: tuple[int, int]) -> Array:
    """The map (height, width, …) of values (n, …) at texels (n,); every other texel has the value of the nearest of
    them, so that filters and mipmaps do not mix the surface with the background.
    """
    width, height = size
    nearest = need("scipy.ndimage", "scipy", "bake")
    empty = np.ones(width * height, np.bool_)
    empty[texels] = False
    sparse = np.zeros((width * height, *values.shape[1:]))
    sparse[texels] = values
    rows, columns = nearest.distance_transform_edt(
        empty.reshape(height, width), return_distances=False, return_indices=True
    )
    dilated: Array = sparse.reshape(height, width, *values.shape[1:])[rows, columns]
    return dilated
