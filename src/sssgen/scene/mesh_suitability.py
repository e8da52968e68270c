"""Where a mesh does not suit a material: what the commands and the preview warn of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.scene.arrays import Array
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import (
    INSIDE,
    MIXED,
    MeshDistance,
    is_inside_out,
    is_sheet,
    mixed_sides,
    open_edges,
    turned_text,
)
from sssgen.scene.mesh_repair import has_inside
from sssgen.support.extras import need

_SHEETS = "choose the quality fast, or the preset leaf or paper"
"""What to do with a mesh that is no body."""
FEW_PATHS = 1.0
"""The mean chord in mean free paths below which light passes a body almost without scattering."""
MANY_PATHS = 300.0
"""The same above which a body looks opaque; presets have 4 to 58 in the sizes that they assume."""
FAR_AWAY = 1e3
"""The distance from the origin, relative to the mesh's longest side, at which float32 has four digits of its shape"""
BELOW = 1e-4
"""How deep below the surface a point is inside, relative to the mesh's longest side."""
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
    written: str = ""
    """The file that the mesh is written to as it is here, where engines do not get the user's own"""


def mesh_warnings(mesh: Mesh, needs: MeshNeeds) -> list[str]:
    """Warnings for people, the gravest first. Raises SssgenError for a mesh that cannot be read."""
    places, corners = mesh.triangles.places, mesh.triangles.corners
    messages = _mended(mesh, needs) + _far_away(places)
    shells = _shells(corners) if needs.inside else []
    if shells and all(is_sheet(places, shell) for shell in shells[:MOST_SHELLS]):
        messages.append(f"the mesh encloses no volume, and light inside needs a body: {_SHEETS}")
    elif needs.inside:
        messages += _holes(corners)
        if mixed_sides(corners):
            messages.append(MIXED)
        messages += _parts(mesh, shells)
    if needs.textures and mesh.triangles.uv is None:
        reading = ", ".join(needs.textures)
        messages.append(f"the mesh has no texture coordinates, and {reading} reads a texture: unwrap the mesh")
    return messages + ([] if needs.paths is None else size_warnings(needs.paths))


def _mended(mesh: Mesh, needs: MeshNeeds) -> list[str]:
    """What is drawn otherwise than the file has it."""
    place = f"here and in {needs.written}" if needs.written else "here; do so in the file for engines"
    turned = mesh.triangles.turned
    messages = [f"{turned_text(turned)}: turned {place}"] if turned else []
    if copies := mesh.triangles.repeated:
        times = "1 triangle is there twice: it is" if copies == 1 else f"{copies} triangles are there twice: they are"
        messages.append(f"{times} left out {place}")
    if mesh.triangles.reversed or (mesh.inside_out and needs.inside):  # of a sheet there is no inside
        messages.append(f"the mesh is inside out: all its triangles are turned {place}")
    return messages


def _far_away(places: Array) -> list[str]:
    """The warning for a mesh at places whose float32 numbers are coarse for its size."""
    away = float(np.abs(places).max() / np.ptp(places, axis=0).max())
    if away < FAR_AWAY:
        return []
    return [
        f"the mesh is {away:.3g} times its size away from the origin, where the numbers of engines are coarse: move it "
        "to the origin"
    ]


def _holes(corners: npt.NDArray[np.int64]) -> list[str]:
    count = open_edges(corners)
    if not count:
        return []
    edges = f"{count} open edge{'s' if count > 1 else ''}"
    return [
        f"the mesh has holes ({edges}): light inside needs a closed body, and is wrong near them; close them, or for a "
        f"sheet {_SHEETS}"
    ]


def _parts(mesh: Mesh, shells: list[npt.NDArray[np.int64]]) -> list[str]:
    """The warnings for parts inside each other, and for closed parts that are inside out where others are not."""
    places = mesh.triangles.places
    messages, inside = [], _inside_others(places, shells[:MOST_SHELLS])
    if inner := int(inside.sum()):
        messages.append(
            f"{_of_parts(inner, len(shells))} inside another: lengths inside the body are wrong there; make one "
            "surface of them, or delete the inner ones"
        )
    alone = [shell for shell, is_inner in zip(shells, inside, strict=False) if not is_inner and has_inside(shell)]
    if reversed_parts := sum(is_inside_out(places, shell) != mesh.inside_out for shell in alone):
        messages.append(f"{_of_parts(reversed_parts, len(shells))} inside out: turn the triangles in the file")
    return messages


def _of_parts(number: int, all_parts: int) -> str:
    return f"{number} of the mesh's {all_parts} parts {'are' if number > 1 else 'is'}"


def _shells(corners: npt.NDArray[np.int64]) -> list[npt.NDArray[np.int64]]:
    """The triangles of each connected part, the largest first."""
    number = np.asarray(need("igl", "libigl").facet_components(corners)[1]).ravel()
    ends = np.cumsum(np.bincount(number))[:-1]
    return sorted(np.split(corners[np.argsort(number, kind="stable")], ends), key=len, reverse=True)


def _inside_others(places: Array, shells: list[npt.NDArray[np.int64]]) -> npt.NDArray[np.bool_]:
    """The shells (s,) of which a corner is inside another one."""
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
    return inside


def overlap(mesh: Mesh) -> float:
    """The share of the surface that is inside another part of the mesh; the inner wall of a cavity is not."""
    triangles, side = mesh.triangles, -1.0 if mesh.inside_out else 1.0
    corners = triangles.places[triangles.corners]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    below = side * BELOW * float(np.ptp(triangles.places, axis=0).max())
    windings = mesh.solid.winding_number(corners.mean(axis=1) - below * triangles.flat)
    return float(areas[windings > 1.0 + INSIDE].sum() / areas.sum())


def size_warnings(paths: float) -> list[str]:
    """The warnings for a body whose mean chord is so many mean free paths."""
    if paths > MANY_PATHS:
        return [
            f"the body is {paths:.3g} mean free paths thick: almost no light comes through, and it looks as if it were "
            "opaque; make it smaller (--size)"
        ]
    if paths >= FEW_PATHS:
        return []
    return [
        f"the body is {paths:.2g} mean free paths thick: light passes it almost unscattered, and edges of its far "
        f"side can be seen; make it larger, or bake its light (the quality best); for a sheet {_SHEETS}"
    ]
