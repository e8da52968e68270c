"""Light from everywhere: one colour, or a picture of the surroundings."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from sssgen.scene.arrays import Array
from sssgen.scene.pictures import images
from sssgen.scene.scene import Light, Scene
from sssgen.scene.scene_keys import ENVIRONMENT
from sssgen.scene.toml_table import Table
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError

LIGHTS = 32
"""The lights from afar that stand for an environment where a technique is evaluated."""
_SIDE = 256
"""The largest height of a picture; larger ones are averaged."""


@dataclass(frozen=True)
class Environment:
    """The light that comes from each direction: π L in linear colours, so that a white matte plane shows it as it is.

    The picture is equirectangular: the top row is up (+y), the middle column is +x, and +z is to the right of it, as in
    three.js.
    """

    color: tuple[float, float, float]
    """The factor of the picture, or the light itself without one"""
    file: str = ""
    contents: str = ""
    """A digest of the file"""

    def values(self) -> Array:
        """(height, width, 3), row 0 at the top."""
        pixels = _stored(self.file, self.contents) if self.file else np.ones((1, 1, 3))
        light: Array = pixels * np.array(self.color)
        return light

    def sky(self) -> Callable[[Array], Array]:
        """The light from unit directions (n, 3), in world space: (n, 3), that of the nearest pixel."""
        pixels = self.values()
        height, width = pixels.shape[:2]

        def light(directions: Array) -> Array:
            x, y, z = directions.T
            column = (np.arctan2(z, x) / (2.0 * np.pi) + 0.5) * width
            row = np.arccos(np.clip(y, -1.0, 1.0)) / np.pi * height
            values: Array = pixels[np.clip(row.astype(int), 0, height - 1), column.astype(int) % width]
            return values

        return light

    def lights(self, count: int = LIGHTS) -> list[Light]:
        """Lights from afar with the same total: each has the light of a part of the sphere, and shines from its middle.

        The parts are those of evenly spaced directions, and the middles are weighted with the light.
        """
        height = np.arange(count) * (2.0 / count) + 1.0 / count - 1.0
        angle, sine = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0)), np.sqrt(1.0 - height**2)
        spread = np.stack([sine * np.cos(angle), height, sine * np.sin(angle)], axis=1)
        rows, columns = (max(64, size) for size in self.values().shape[:2])
        columns = max(columns, 128)
        v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
        polar, around = np.pi * v.ravel(), 2.0 * np.pi * (u.ravel() - 0.5)
        ways = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=1)
        edges = np.cos(np.pi * np.arange(rows + 1) / rows)
        angles = np.repeat((edges[:-1] - edges[1:]) * 2.0 * np.pi / columns, columns)
        # the irradiance on a plane that faces a pixel: L times its solid angle, and the sky has π L
        power = self.sky()(ways) * (angles / np.pi)[:, None]
        nearest = np.argmax(ways @ spread.T, axis=1)
        result = []
        for part in range(count):
            mine = nearest == part
            color = power[mine].sum(axis=0)
            middle = (power[mine].sum(axis=1, keepdims=True) * ways[mine]).sum(axis=0)
            if color.max() > 0.0:
                x, y, z = map(float, middle / np.linalg.norm(middle))
                red, green, blue = map(float, color)
                result.append(Light(None, (x, y, z), (red, green, blue)))
        return result


def read_environment(scene: Scene) -> Environment | None:
    """The scene's [environment]; its errors are reported with those of the scene."""
    table = Table(scene.document, ("environment",), scene.measured["environment"], ENVIRONMENT)
    color: Any = table.vector("color", (1.0, 1.0, 1.0))
    intensity = table.number("intensity", 1.0)
    red, green, blue = (intensity * part for part in color)
    file, contents = "", ""
    if "file" in table.content:
        try:
            file = os.path.join(scene.folder, table.text("file", ""))
            contents = digest(file)
        except SssgenError as error:
            table.error("file", error.diagnostics[0].message, error.diagnostics[0].hint)
            return None
    result = Environment((red, green, blue), file, contents)
    if not result.values().any():
        scene.document.error(
            scene.document.place("environment").key, "the environment is black", "leave [environment] out"
        )
        return None
    return result


def digest(path: str) -> str:
    """The digest that an environment of this picture has. Raises SssgenError."""
    return cache.digest(picture(path).tobytes())


@lru_cache(4)
def _stored(path: str, contents: str) -> Array:
    """The picture with this digest."""
    return picture(path)


def picture(path: str) -> Array:
    """The linear pixels (height, width, 3) of a picture of the surroundings. Raises SssgenError."""
    values = images.upright(path)
    values = np.repeat(values[..., :1], 3, axis=-1) if values.shape[-1] < 3 else values[..., :3]
    if images.check_suffix(path, images.TEXTURES) == ".png":
        values = images.decode_srgb(values)
    values = np.where(np.isfinite(values), np.maximum(values, 0.0), 0.0)
    while values.shape[0] > _SIDE and values.shape[0] % 2 == 0 and values.shape[1] % 2 == 0:
        values = 0.25 * (values[::2, ::2] + values[1::2, ::2] + values[::2, 1::2] + values[1::2, 1::2])
    return np.asarray(values, np.float64)
