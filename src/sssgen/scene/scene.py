"""Scenes: what a render shows, described in TOML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.ir.spans import Span
from sssgen.scene.arrays import Vector
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Geometry
from sssgen.scene.pictures.images import read
from sssgen.support.toml_source import Document


@dataclass(frozen=True)
class Light:
    """A point light or a distant light: either `position` or `direction` is set."""

    position: Vector | None
    """World space; the light falls off with the square of the distance"""
    direction: Vector | None
    """World space, unit, towards the light"""
    color: Vector
    """Linear; for a point light, at distance 1"""


@dataclass(frozen=True)
class Picture:
    """A texture from a file."""

    file: str
    """Its path, including the scene's folder"""
    wrap: str = ""
    """repeat or clamp; "": the technique's"""

    def values(self) -> npt.NDArray[np.float64]:
        """(height, width, channels), row 0 at the top, or (depth, height, width, channels). Raises SssgenError."""
        return read(self.file)


def encode_distance(distance: npt.NDArray[np.float64], reach: float) -> npt.NDArray[np.float64]:
    """Signed distances encoded for the technique distance_texture: 0.5 + distance / (2 reach), clamped to 0..1."""
    value: npt.NDArray[np.float64] = np.clip(0.5 + distance / (2.0 * reach), 0.0, 1.0)
    return value


def placement(geometry: Geometry) -> dict[str, Any]:
    """The transform of a body with a distance texture, as parameters of techniques, in TOML values."""
    return {"world_to_object": [*geometry.to_object().T.ravel()], "object_scale": geometry.scale}


@dataclass(frozen=True)
class DistanceTexture:
    """A 3-D texture of the signed distance to the scene's geometry, in the geometry's object space.

    The convention is that of the technique distance_texture: 0.5 + distance / (2 range), clamped to 0..1, positive
    outside, over the box from `box_min` to `box_max`; a flat box is padded, as there.
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
        x, y, z = (start[axis] + size[axis] * (np.arange(n) + 0.5) / n for axis, n in enumerate(self.texels))
        positions = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1)
        distance = geometry.distance(positions.reshape(-1, 3)).reshape(*positions.shape[:3], 1)
        return encode_distance(distance, self.range)


@dataclass(frozen=True)
class Scene:
    """A scene; whether the material has these parameters and textures is not checked here."""

    material: str
    """An example's name, or the path of a material file; "" for a scene that only describes what is measured"""
    size: tuple[int, int]
    """Width and height in pixels"""
    samples: int
    """n, for n × n samples per pixel"""
    time: float
    background: tuple[Vector, Vector]
    """Linear colour at the picture's bottom and top; grey where the environment is shown"""
    ambient: Vector
    exposure: float
    """The factor of the linear picture before it is encoded"""
    geometry: Geometry | None
    """None where the material marches rays itself"""
    camera: Camera
    lights: tuple[Light, ...]
    parameters: Mapping[str, object]
    """The material's uniforms → TOML values, all numbers finite"""
    textures: Mapping[str, Picture | DistanceTexture]
    document: Document
    """The text with its positions, for later errors: report them with `document.error`, at
    `document.place("parameters", "power").value`, then raise them with `document.reporter.check()`"""
    title: str = ""
    shell: Mapping[str, str] = field(default_factory=dict)
    """Role → technique, which take the place of the material's own in shells without an engine"""
    measured: Mapping[str, Any] = field(default_factory=dict)
    """The physical description, as the tables of the file: `medium`, `inlay`, `environment`; the lab reads them"""
    shows_environment: bool = False
    """Whether the picture shows the environment beside the bodies, in place of `background`"""
    bodies: tuple[str, ...] = ()
    """The files of scenes whose bodies are drawn together, with the camera, lights and surroundings of this one"""
    folder: str = ""
    """The folder of the scene's file, to which the names of files are relative"""

    @property
    def places(self) -> dict[str, Span]:
        """The positions of `material`, and of the keys of [parameters] and [textures], as `parameters.power`."""
        places = {"material": self.document.place("material").value}
        for section in ("parameters", "textures"):
            for key in getattr(self, section):
                places[f"{section}.{key}"] = self.document.place(section, key).key
        return places
