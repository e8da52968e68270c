"""Scenes: what a render shows, described in TOML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from sssgen.harness.pictures.images import read
from sssgen.harness.scenes.camera import Camera
from sssgen.harness.scenes.geometry import Geometry
from sssgen.ir.spans import Span
from sssgen.support.toml_source import Document

Vector: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True)
class Light:
    """A point light, or one from afar. Just one of `position` and `direction` is given."""

    position: Vector | None
    """World space; its light falls off with the square of the distance"""
    direction: Vector | None
    """World space, unit, towards the light"""
    color: Vector
    """Linear; of a point light at distance 1"""


@dataclass(frozen=True)
class Picture:
    """A texture from a file."""

    file: str
    """Its path; the scene's folder is in it"""
    wrap: str = ""
    """repeat or clamp; "": as the technique has it"""

    def values(self) -> npt.NDArray[np.float64]:
        """(height, width, channels), row 0 at the top, or (depth, height, width, channels). Raises SssgenError."""
        return read(self.file)


def stored(distance: npt.NDArray[np.float64], reach: float) -> npt.NDArray[np.float64]:
    """Signed distances as the technique distance_texture reads them: 0.5 + distance / (2 reach), cut to 0..1."""
    value: npt.NDArray[np.float64] = np.clip(0.5 + distance / (2.0 * reach), 0.0, 1.0)
    return value


def placement(geometry: Geometry) -> dict[str, Any]:
    """Where a body with a distance texture stands, by the names of techniques, as TOML has them."""
    return {"world_to_object": [*geometry.to_object().T.ravel()], "object_scale": geometry.scale}


@dataclass(frozen=True)
class DistanceTexture:
    """A 3-D texture of the signed distance to the scene's geometry, in the geometry's object space.

    The convention is that of the technique distance_texture: 0.5 + distance / (2 range), cut to 0..1, positive
    outside, over the box from `box_min` to `box_max`, a flat one padded as there.
    """

    texels: tuple[int, int, int]
    """Along x, y, z"""
    box_min: Vector
    box_max: Vector
    range: float

    def values(self, geometry: Geometry) -> npt.NDArray[np.float64]:
        """(depth, height, width, 1), z, y and x from the smallest to the largest, at the texels' centres."""
        low, high = np.array(self.box_min), np.array(self.box_max)
        size = np.maximum(high - low, 0.001 * np.linalg.norm(high - low))
        start = 0.5 * (low + high) - 0.5 * size
        x, y, z = (start[at] + size[at] * (np.arange(n) + 0.5) / n for at, n in enumerate(self.texels))
        places = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1)
        distance = geometry.distance(places.reshape(-1, 3)).reshape(*places.shape[:3], 1)
        return stored(distance, self.range)


@dataclass(frozen=True)
class Scene:
    """A scene, checked in itself; whether the material has these parameters and textures is not known here."""

    material: str
    """An example's name, or the path of a material file; "" where the scene only says what is measured"""
    size: tuple[int, int]
    """Width and height in pixels"""
    samples: int
    """n of n × n samples a pixel"""
    time: float
    background: tuple[Vector, Vector]
    """Linear colour at the picture's bottom and top"""
    ambient: Vector
    exposure: float
    """What the linear picture is multiplied by before it is encoded"""
    geometry: Geometry | None
    """None where the material marches rays itself"""
    camera: Camera
    lights: tuple[Light, ...]
    parameters: Mapping[str, object]
    """The material's uniforms → TOML values, all numbers finite"""
    textures: Mapping[str, Picture | DistanceTexture]
    document: Document
    """The text with its places, for the errors of who knows the material: note them with `document.error`, at
    `document.place("parameters", "power").value`, then raise them with `document.reporter.check()`"""
    title: str = ""
    measured: Mapping[str, Any] = field(default_factory=dict)
    """What is physically there, as the tables stand in the file: `medium` and `inlay`; the lab reads them"""

    @property
    def places(self) -> dict[str, Span]:
        """Where the keys of [parameters] and [textures] stand, as `parameters.power`; and `material`."""
        found = {"material": self.document.place("material").value}
        for section in ("parameters", "textures"):
            for key in getattr(self, section):
                found[f"{section}.{key}"] = self.document.place(section, key).key
        return found
