"""What a baked texture notes about its body, so that a render can tell whether its scene has the same one."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import numpy as np

from sssgen.scene.arrays import Array, Indices
from sssgen.scene.bounds import bounds
from sssgen.scene.geometry import Distance, Geometry, Mesh, Union
from sssgen.scene.mesh_distance import volume_of
from sssgen.support import cache

SAME = 1e-4
"""The difference of two measures of a mesh, relative to its size, up to which they are the same."""
PLACEMENT = ("position", "rotation", "scale")


class BodyIdentity(TypedDict):
    """The entry `body` of a JSON file."""

    key: str
    """A digest of the shape in object space"""
    name: str
    box_min: list[float]
    """In object space; so is `box_max`"""
    box_max: list[float]
    scale: NotRequired[float]
    """Only if the texture depends on it"""


class BodyMeasures(TypedDict):
    """Numbers by which a mesh is known again in another file of it, also with other texture coordinates."""

    area: float
    volume: float
    centre: list[float]
    """The mean place of its surface"""


def measures(places: Array, corners: Indices) -> BodyMeasures:
    """The measures of triangles, in their own units."""
    first, second, third = np.moveaxis(places[corners], 1, 0)
    areas = 0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=1)
    area = float(areas.sum())
    centre = areas @ ((first + second + third) / 3.0) / area
    return {"area": area, "volume": abs(volume_of(places, corners)), "centre": centre.tolist()}


def has_measures(noted: Mapping[str, Any], places: Array, corners: Indices) -> bool:
    """Whether triangles have the measures of a JSON file, but for the rounding of file formats; true without any."""
    own = measures(places, corners)
    length = math.sqrt(own["area"])
    units = {"area": length**2, "volume": length**3, "centre": length}
    return all(
        np.shape(noted[key]) == np.shape(own[key])  # type: ignore[literal-required]
        and bool((np.abs(np.subtract(noted[key], own[key])) <= SAME * unit).all())  # type: ignore[literal-required]
        for key, unit in units.items()
        if key in noted
    )


def identity(geometry: Geometry, scaled: bool) -> BodyIdentity:
    """The identity of a body; `scaled` is whether the texture depends on its scale."""
    low, high = bounds(geometry)
    entry: BodyIdentity = {
        "key": key(geometry),
        "name": name(geometry),
        "box_min": low.tolist(),
        "box_max": high.tolist(),
    }
    return {**entry, "scale": geometry.scale} if scaled else entry


def key(geometry: Geometry) -> str:
    """A digest of a shape in object space: of the contents of its files and not of their paths."""
    return cache.digest(repr(_shape(geometry)).encode())[:16]


def name(geometry: Geometry) -> str:
    """The name of a shape in messages."""
    if isinstance(geometry, Mesh):
        return os.path.basename(geometry.path)
    if isinstance(geometry, Distance):
        return os.path.basename(geometry.technique)
    return type(geometry).__name__.lower()


def contents(geometry: Geometry) -> str:
    """A digest of the files of a shape, '' without files."""
    if isinstance(geometry, Union):
        return "".join(contents(part) for part in geometry.parts)
    if isinstance(geometry, Mesh):
        return cache.digest(Path(geometry.path).read_bytes())
    if isinstance(geometry, Distance):
        file = geometry.technique.rpartition(":")[0] or geometry.technique
        path = Path(geometry.folder, file)
        return cache.digest(path.read_bytes()) if path.is_file() else ""
    return ""


def _shape(geometry: Geometry, placed: bool = False) -> Any:
    """The values that determine a shape; its own placement only if `placed`, as a part of another shape."""
    if isinstance(geometry, Mesh):
        own: dict[str, Any] = {}
    elif isinstance(geometry, Union):
        own = {"parts": [_shape(part, True) for part in geometry.parts]}
    else:
        own = {field.name: getattr(geometry, field.name) for field in fields(geometry)}
        own.pop("folder", None)
        if isinstance(geometry, Distance):
            own["technique"] = name(geometry)
            own["parameters"] = sorted(geometry.parameters.items())
    for field in PLACEMENT:
        own.pop(field, None)
        if placed:
            own[field] = getattr(geometry, field)
    return type(geometry).__name__, sorted(own.items()), contents(geometry)
