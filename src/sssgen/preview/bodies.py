"""The bodies that a material is shown on besides its scene's own: simple shapes, a head, a mesh of the user's."""

from __future__ import annotations

import copy
import dataclasses
import hashlib
import os
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.interchange.material_writer import mean_chord
from sssgen.pipeline.emitted_cache import installation
from sssgen.presets.preset_stages import BodySize
from sssgen.preview.body_triangles import body_triangles
from sssgen.scene.geometry import Ball, Box, Distance, Geometry, Mesh, Slab, Torus
from sssgen.scene.mesh_files import FileContent
from sssgen.support import cache
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import CachedResult, noted_files, remember

SHAPES: Mapping[str, Geometry] = {
    "ball": Ball(radius=1.0),
    "cube": Box(size=(1.5, 1.5, 1.5)),
    "sheet": Slab(width=2.2, height=2.2, thickness=0.06),
    "head": Distance(technique="head.sss", folder=os.path.dirname(__file__), reach=1.8),
}
OWN_MESH = "mesh"
"""The name of the user's own mesh among the shapes."""
MOST_TRIANGLES = 2_000_000
"""The largest mesh: a triangle takes 96 bytes on the page."""
_MARGIN = 1.12
"""By how much the view of a shape is larger than the shape."""


class Extent(NamedTuple):
    """The box around a body in world space."""

    center: npt.NDArray[np.float64]
    size: float
    """Its longest side"""
    radius: float
    """The largest distance of a corner from the centre"""


def dropped_mesh(name: str, data: bytes) -> Mesh:
    """The mesh of a file's bytes. Raises SssgenError for a file that is none, or that has too many triangles."""
    if not data:
        raise failure("the file is empty", file=name)
    return checked_mesh(Mesh(path=os.path.basename(name.replace("\\", "/")) or "mesh", data=data))


def checked_mesh(mesh: Mesh) -> Mesh:
    """The mesh, which is read. Raises SssgenError for a faulty file, or for too many triangles."""
    if (count := len(mesh.triangles.corners)) > MOST_TRIANGLES:
        hint = f"at most {MOST_TRIANGLES} are shown: simplify the mesh"
        raise failure(f"the mesh has {count} triangles", hint, mesh.path)
    return mesh


def fit(geometry: Geometry, own: Geometry) -> Geometry:
    """A shape at the place of the scene's own body, and as large: lengths in the material keep their meaning."""
    place, shape = extent(own), extent(geometry)
    scale = place.size / shape.size
    return dataclasses.replace(geometry, scale=scale, position=tuple((place.center - scale * shape.center).tolist()))


def extent(geometry: Geometry) -> Extent:
    """The box around a body."""
    corners = np.frombuffer(packed_triangles(geometry), "<f4").reshape(-1, 8)[:, :3]
    matrix = geometry.to_world()
    places = corners @ matrix[:3, :3].T + matrix[:3, 3]
    low, high = places.min(axis=0), places.max(axis=0)
    center = 0.5 * (low + high)
    return Extent(center, float((high - low).max()), float(np.linalg.norm(places - center, axis=1).max()))


def frame(geometry: Geometry, towards: npt.ArrayLike, field_of_view: float) -> tuple[list[float], list[float]]:
    """The eye that sees the whole body from the direction `towards`, and the point that it looks at."""
    box = extent(geometry)
    direction = np.asarray(towards, float) / np.linalg.norm(towards)
    away = _MARGIN * box.radius / np.sin(np.radians(0.5 * field_of_view))
    return (box.center + away * direction).tolist(), box.center.tolist()


def packed_triangles(geometry: Geometry) -> bytes:
    """The packed triangles; those of the last bodies are kept until a file of theirs changes.

    Those that are cut out of a grid of distances, which takes seconds, are in the cache folder, too.
    """
    at_origin, key = _at_origin(geometry), body_key(geometry)
    if isinstance(at_origin, Distance | Torus):
        return remember(_bodies, key, lambda: _load_triangles(at_origin, key), MOST_BODIES)
    return remember(_bodies, key, lambda: body_triangles(copy.deepcopy(at_origin)).pack(), MOST_BODIES)


def body_key(geometry: Geometry) -> str:
    """The same text for bodies that differ in their places alone, while their files stay as they are."""
    content = hashlib.sha256(geometry.data).hexdigest() if isinstance(geometry, Mesh) and geometry.data else ""
    return repr(_at_origin(geometry)) + content


def _at_origin(geometry: Geometry) -> Geometry:
    return dataclasses.replace(geometry, position=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0), scale=1.0)


def body_size(geometry: Geometry, longest_mm: float) -> BodySize:
    """The size of a body whose longest side is so many millimetres."""
    corners = np.frombuffer(packed_triangles(geometry), "<f4").reshape(-1, 8)[:, :3].astype(np.float64)
    content = FileContent(corners, np.arange(len(corners)).reshape(-1, 3), None)
    return BodySize(longest_mm / extent(geometry).size, geometry.scale * mean_chord(content))


MOST_BODIES = 6
"""The number of bodies that are kept in memory, each of some 10 MB."""
_bodies: dict[str, CachedResult] = {}


def _load_triangles(geometry: Distance | Torus, key: str) -> bytes:
    """The packed triangles, from the cache folder if the files of the body and sssgen itself are as they were."""
    with noted_files() as read:
        if isinstance(geometry, Distance):
            _ = geometry.function
    files = sorted((path, state.modified, state.size) for path, state in read.items())
    name = f"body_{hashlib.sha256(key.encode()).hexdigest()[:24]}"
    result: bytes = cache.load_or_make(name, [installation(), files], lambda: body_triangles(geometry).pack())
    return result
