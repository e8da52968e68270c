"""A scene's body for materials: a distance function to bind to slots, and its parameters.

Solids get a generated function with the scene's numbers. The functions of the library and of files are bound directly.
A mesh has a distance texture.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from sssgen.material import slots
from sssgen.scene.arrays import Array, Vector
from sssgen.scene.bounds import bounds
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.scene import DistanceTexture
from sssgen.support.diagnostics import failure

TEXELS = 64
"""Texels along the longest side of a distance texture."""
FILE = "body.sss"


@dataclass(frozen=True)
class Body:
    """A scene's body for materials."""

    function: str
    """The function for slots that take a position in world space"""
    files: Mapping[str, str] = field(default_factory=dict)
    """The files that it refers to, for the material's folder: name → text"""
    parameters: Mapping[str, object] = field(default_factory=dict)
    """The function's own parameters"""
    span: float = 0.0
    """A length in world space that no straight way between two points of the body exceeds"""


def body(geometry: Geometry) -> Body:
    """The body's distance function in world space. Raises SssgenError for a shape without one."""
    return replace(_body(geometry), span=span(geometry))


def span(geometry: Geometry) -> float:
    """The largest distance of two points of a shape in world space; for other shapes the diagonal of its box."""
    if isinstance(geometry, Ball):
        longest = 2.0 * geometry.radius
    elif isinstance(geometry, Torus):
        longest = 2.0 * (geometry.major + geometry.minor)
    elif isinstance(geometry, Capsule):
        longest = geometry.length + 2.0 * geometry.radius
    else:
        low, high = bounds(geometry)
        longest = float(np.linalg.norm(high - low))
    return geometry.scale * longest


def _body(geometry: Geometry) -> Body:
    if isinstance(geometry, Mesh):
        return Body(slots.body("texture", "world_position"))
    if isinstance(geometry, Distance):
        if not np.array_equal(geometry.to_world(), np.eye(4)):
            return Body(slots.body("texture", "world_position"))
        return _function_of(geometry)
    return Body(f"{FILE}:body", {FILE: text(geometry)})


def _function_of(geometry: Distance) -> Body:
    """The function of a file, with the file, or of the library."""
    file, colon, name = geometry.technique.rpartition(":")
    path = os.path.join(geometry.folder, file if colon else geometry.technique)
    if not os.path.isfile(path):
        return Body(geometry.technique, {}, geometry.parameters)
    with open(path, encoding="utf-8") as source:
        base = os.path.basename(path)
        return Body(base + (colon + name if colon else ""), {base: source.read()}, geometry.parameters)


def text(geometry: Geometry) -> str:
    """A .sss file with the function `body`: the distance to the shape, in world space."""
    lines: list[str] = []
    name = _write(geometry, lines)
    lines += [
        "/// The distance to the scene's body.",
        "float body(world_position p)",
        "{",
        f"    return {name}(vec3(p));",
        "}",
    ]
    return "\n".join(lines) + "\n"


def _write(geometry: Geometry, lines: list[str]) -> str:
    """Appends the function of a shape, after those of its parts; returns its name."""
    parts = [_write(part, lines) for part in geometry.parts] if isinstance(geometry, Union) else []
    number = sum(line.startswith("float ") for line in lines)
    name = f"{type(geometry).__name__.lower()}_{number + 1}"
    to_object = geometry.to_object()
    moved = not np.array_equal(to_object, np.eye(4))
    lines += [f"float {name}(vec3 {'at' if moved else 'p'})", "{"]
    if moved:
        turned = not np.array_equal(to_object[:3, :3], np.eye(3))
        position = f"at - {_vector(geometry.position)}"
        matrix = ", ".join(_number(value) for value in to_object[:3, :3].T.ravel())
        lines.append(f"    vec3 p = mat3({matrix}) * ({position});" if turned else f"    vec3 p = {position};")
    *statements, result = _formula(geometry, parts)
    lines += [f"    {line}" for line in statements]
    lines += [
        f"    return {_number(geometry.scale)} * ({result});" if geometry.scale != 1.0 else f"    return {result};"
    ]
    lines += ["}", ""]
    return name


def _formula(geometry: Geometry, parts: list[str]) -> list[str]:
    """The lines of a distance at `p`, the last one an expression. Raises SssgenError for a shape without one."""
    if isinstance(geometry, Ball):
        return [f"length(p) - {_number(geometry.radius)}"]
    if isinstance(geometry, Box | Slab):
        size = geometry.size if isinstance(geometry, Box) else (geometry.width, geometry.height, geometry.thickness)
        half_size = _vector([0.5 * side for side in size])
        outside = "length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0)"
        return [f"vec3 q = abs(p) - {half_size};", outside]
    if isinstance(geometry, Torus):
        return [f"length(vec2(length(p.xz) - {_number(geometry.major)}, p.y)) - {_number(geometry.minor)}"]
    if isinstance(geometry, Capsule):
        beyond = f"vec3(p.x, max(abs(p.y) - {_number(0.5 * geometry.length)}, 0.0), p.z)"
        return [f"length({beyond}) - {_number(geometry.radius)}"]
    if isinstance(geometry, Union):
        lines = [f"float nearest = {parts[0]}(p);"]
        lines += [f"nearest = min(nearest, {part}(p));" for part in parts[1:]]
        return [*lines, "nearest"]
    raise failure(f"a {type(geometry).__name__.lower()} cannot be part of a union for measurements")


def _number(value: float) -> str:
    text = repr(float(np.float32(value)))
    short = f"{value:.7g}"
    text = short if np.float32(short) == np.float32(value) else text
    return text if any(mark in text for mark in ".e") else f"{text}.0"


def _vector(values: Any) -> str:
    return f"vec3({', '.join(_number(value) for value in values)})"


def distance_texture(geometry: Geometry) -> DistanceTexture:
    """The distance texture of a shape in object space: its box with a margin, with nearly cubic texels."""
    low, high = bounds(geometry)
    margin = 0.05 * float((high - low).max())
    low, high = low - margin, high + margin
    size = high - low
    x, y, z = (max(int(side), 4) for side in np.ceil(TEXELS * size / size.max()))
    return DistanceTexture((x, y, z), _vector_of(low), _vector_of(high), 0.5 * float(size.max()))


def _vector_of(corner: Array) -> Vector:
    x, y, z = map(float, corner)
    return x, y, z


def texture_parameters(texture: DistanceTexture) -> dict[str, object]:
    """The parameters of a shape's distance texture by their names in techniques, as TOML values."""
    return {"box_min": [*texture.box_min], "box_max": [*texture.box_max], "distance_range": texture.range}
