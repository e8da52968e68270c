"""Where a mesh does not suit a material: what the commands and the preview warn of."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import INSIDE, MIXED, MeshDistance, mixed_sides, open_edges
from sssgen.support.extras import need

FEW_PATHS = 1.0
"""The mean chord in mean free paths below which light passes a body almost without scattering."""
MOST_SHELLS = 64
"""The number of shells, the largest, that are searched for others inside them."""


class MeshNeeds(NamedTuple):
    """What a material needs of a mesh."""

    inside: bool = False
    """Whether it follows light through the body"""
    textures: tuple[str, ...] = ()
    """The techniques that read textures by the mesh's own coordinates"""
    paths: float | None = None
    """The mean chord of the body in mean free paths of its medium, where light inside is computed at one point or few;
    None where it is traced, or where nothing scatters"""


def mesh_warnings(mesh: Mesh, needs: MeshNeeds) -> list[str]:
    """Warnings for people, the gravest first. Raises SssgenError for a mesh that cannot be read."""
    places, corners = mesh.triangles.places, mesh.triangles.corners
    messages = []
    if needs.inside:
        messages += _holes(corners)
        if mixed_sides(corners):
            messages.append(MIXED)
        messages += _nested_shells(places, corners)
    if mesh.inside_out:
        messages.append("the mesh is inside out: its normals are reversed here; reverse them in the file for engines")
    if needs.textures and mesh.triangles.uv is None:
        reading = ", ".join(needs.textures)
        messages.append(f"the mesh has no texture coordinates, and {reading} reads a texture: unwrap the mesh")
    return messages + ([] if needs.paths is None else size_warnings(needs.paths))


def _holes(corners: npt.NDArray[np.int64]) -> list[str]:
    count = open_edges(corners)
    if not count:
        return []
    edges = f"{count} open edge{'s' if count > 1 else ''}"
    return [f"the mesh has holes ({edges}): light inside needs a closed body, and is wrong near them"]


def _nested_shells(places: Array, corners: npt.NDArray[np.int64]) -> list[str]:
    shells = list(_shells(corners))
    inner = _count_inside(places, shells[:MOST_SHELLS])
    if not inner:
        return []
    parts = f"{inner} of the mesh's {len(shells)} parts {'are' if inner > 1 else 'is'} inside another"
    return [f"{parts}: lengths inside the body are wrong there; make one surface of them, or delete the inner ones"]


def _shells(corners: npt.NDArray[np.int64]) -> Iterable[npt.NDArray[np.int64]]:
    """The triangles of each connected part, the largest first."""
    number = np.asarray(need("igl", "libigl").facet_components(corners)[1]).ravel()
    sizes = np.bincount(number)
    for part in np.argsort(-sizes, kind="stable"):
        yield corners[number == part]


def _count_inside(places: Array, shells: list[npt.NDArray[np.int64]]) -> int:
    """The number of shells of which a corner is inside another one."""
    if len(shells) < 2:
        return 0
    points = np.array([places[shell[0, 0]] for shell in shells])
    low, high = (np.array([ends(places[shell.ravel()], axis=0) for shell in shells]) for ends in (np.min, np.max))
    inside = np.zeros(len(shells), np.bool_)
    for number, shell in enumerate(shells):
        near = ((points > low[number]) & (points < high[number])).all(axis=1)
        near[number] = False
        if near.any():
            used, renamed = np.unique(shell, return_inverse=True)
            solid = MeshDistance(places[used], renamed.reshape(shell.shape))
            inside[near] |= solid.winding_number(points[near]) > INSIDE
    return int(inside.sum())


def size_warnings(paths: float) -> list[str]:
    """The warnings for a body whose mean chord is so many mean free paths."""
    if paths >= FEW_PATHS:
        return []
    return [
        f"the body is {paths:.2g} mean free paths thick: light passes it almost unscattered, and edges of its far "
        "side can be seen; make it larger, or bake its light"
    ]
