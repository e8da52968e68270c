"""What a baked texture notes about its body, so that a render can tell whether its scene has the same one."""

from __future__ import annotations

import os
from dataclasses import fields
from pathlib import Path
from typing import Any, NotRequired, TypedDict

from sssgen.scene.bounds import bounds
from sssgen.scene.geometry import Distance, Geometry, Mesh, Union
from sssgen.support import cache

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


def mesh_key(content: bytes) -> str:
    """The key of a mesh by the content of its file."""
    return cache.digest(repr(("Mesh", [], cache.digest(content))).encode())[:16]


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
