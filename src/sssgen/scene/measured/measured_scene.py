"""Measured scenes: scenes with a physical description, so that materials can be measured on them.

Their files have `[medium]`, the medium of the body, or `[inlay]`, a picture below a clear surface. They are lit by
lights and by an `[environment]`.
"""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from sssgen.material.material_loading import preset_hint
from sssgen.material.medium_look import COLOR, DEPTH
from sssgen.material.scatter_color import albedo_of_color
from sssgen.scene.body_identity import contents
from sssgen.scene.camera import Camera
from sssgen.scene.environment import Environment, read_environment
from sssgen.scene.example_scenes import drawn_scenes, measured_scenes
from sssgen.scene.geometry import Geometry
from sssgen.scene.measured import media
from sssgen.scene.measured.media import Medium
from sssgen.scene.scene import Light, Scene
from sssgen.scene.scene_keys import INLAY, MEDIUM
from sssgen.scene.scene_loading import load as load_scene
from sssgen.scene.toml_table import Table
from sssgen.support import cache
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import stem
from sssgen.support.text_files import refuse_folder, refuse_other_kinds
from sssgen.support.value_bytes import encode

SIDE = 64
"""Pixels along the longer side of a measured picture."""
LOOK = (COLOR, DEPTH)
"""The keys of [medium] for its look, in place of its coefficients."""
_MEANING = {COLOR: "what a thick body reflects of diffuse light", DEPTH: "the mean free path, in world units"}
HELD_OUT = 50.0
"""Degrees about the vertical through the camera's target by which the held-out view is turned."""


@dataclass(frozen=True)
class Inlay:
    """A picture below a clear surface."""

    depth: float
    """World units below the surface, along its normal"""
    ior: float = 1.5
    outside_ior: float = 1.0

    @property
    def parameters(self) -> dict[str, float]:
        """By their names in parallax techniques."""
        indices = {"ior": self.ior, "outside_ior": self.outside_ior, "relative_ior": self.ior / self.outside_ior}
        return {"depth": self.depth, **indices}


@dataclass(frozen=True, eq=False)
class MeasuredScene:
    """A scene for measurements. Scenes with equal values, read from files of equal content, are equal."""

    name: str
    title: str
    geometry: Geometry
    camera: Camera
    lights: tuple[Light, ...]
    medium: Medium | None
    inlay: Inlay | None
    size: tuple[int, int] = (SIDE, SIDE)
    contents: str = ""
    """A digest of the files that the geometry is read from"""
    environment: Environment | None = None

    @cached_property
    def key(self) -> str:
        """A digest of the scene."""
        return cache.digest(encode(self.__getstate__()))

    @property
    def lit_by(self) -> list[str]:
        """The kinds of the scene's lights, in their order."""
        kinds = ["point" if light.position is not None else "from afar" for light in self.lights]
        if self.environment is not None:
            kinds.append("picture of the surroundings" if self.environment.file else "even surroundings")
        return list(dict.fromkeys(kinds))

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MeasuredScene) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def body_alone(self) -> MeasuredScene:
        """The same body, equal for all views and lights."""
        return dataclasses.replace(self, name="body", title="body", camera=Camera(), lights=(), environment=None)

    def held_out(self) -> MeasuredScene:
        """The scene from another side, for a view that no fit uses."""
        turn = np.radians(HELD_OUT)
        x, y, z = np.subtract(self.camera.position, self.camera.target)
        if np.hypot(x, z) < 1e-6 * abs(y):  # a rotation does not change a view from straight above
            x = 0.5 * abs(y)
        turned = np.array([np.cos(turn) * x + np.sin(turn) * z, y, np.cos(turn) * z - np.sin(turn) * x])
        x, y, z = (float(value) for value in turned + self.camera.target)
        return dataclasses.replace(self, camera=dataclasses.replace(self.camera, position=(x, y, z)))


def load(name: str) -> MeasuredScene:
    """The scene of a scene file, or a scene of the project by name. Raises SssgenError with all errors in it."""
    scenes = measured_scenes()
    if not name.endswith(".toml") and "/" not in name and os.sep not in name:
        if name not in scenes:
            refuse_folder(name, (".toml",), "scene.toml")
            refuse_other_kinds(name)
            listed = f"give a path that ends in .toml, or one of: {', '.join(scenes)}"
            if name in drawn_scenes():
                message = f"the scene '{name}' is for pictures: it describes no medium, so there is nothing to measure"
                raise failure(message, listed)
            raise failure(f"unknown scene '{name}'", preset_hint(name) or did_you_mean(name, scenes) or listed)
        name = scenes[name]
    return of_scene(load_scene(name, draws=False), name)


def of_scene(scene: Scene, path: str) -> MeasuredScene:
    """The measured scene of a scene with physical data. Raises SssgenError for an incomplete description."""
    document, whole = scene.document, scene.document.place().key
    if not scene.measured:
        hint = 'add [medium] with preset = "marble", say; or [inlay] with depth = 0.02: docs/accuracy/picking.md'
        document.error(whole, "the scene does not describe the medium of its body", hint)
    if scene.geometry is None:
        document.error(whole, "the scene has no geometry to measure", "add [geometry]")
    document.reporter.check()
    assert scene.geometry is not None
    medium = medium_of(scene) if "medium" in scene.measured else None
    inlay = _inlay(scene) if "inlay" in scene.measured else None
    environment = read_environment(scene) if "environment" in scene.measured else None
    for number, light in enumerate(scene.lights):
        if light.position is not None and medium is not None and inside(scene.geometry, light.position):
            span = document.place("light", number, "position").value
            document.error(span, "the light is inside the body", "move it out: only light that enters is measured")
    if medium is not None and not scene.lights and environment is None:
        document.error(whole, "the scene has no light", "add [[light]] with direction = […]")
    document.reporter.check()
    width, height = scene.size
    scale = SIDE / max(width, height)
    size = max(8, round(width * scale)), max(8, round(height * scale))
    name = stem(path)
    title = scene.title or name.replace("_", " ").capitalize()
    geometry, camera, lights = scene.geometry, scene.camera, scene.lights
    return MeasuredScene(name, title, geometry, camera, lights, medium, inlay, size, contents(geometry), environment)


def inside(geometry: Geometry, position: tuple[float, float, float]) -> bool:
    """Whether a point in world space is inside a shape."""
    to_object = geometry.to_object()
    return bool(geometry.distance((to_object[:3, :3] @ np.array(position) + to_object[:3, 3])[None])[0] <= 0.0)


def medium_of(scene: Scene) -> Medium | None:
    """The medium that a scene's table states; reports its errors, None after one in its preset."""
    document = scene.document
    table = Table(document, ("medium",), scene.measured["medium"], MEDIUM)
    # the presets have measured indices, but a scene without this key has no boundary
    ior, roughness = table.number("ior", 1.0), table.number("roughness", 0.0)
    if roughness > 0.0 and ior == 1.0:
        table.error("roughness", "a surface that does not refract has no roughness", "add ior, 1.4 say")
    if "preset" in table.content:
        for key in ("absorption", "scattering", "anisotropy", *LOOK):
            if key in table.content:
                table.error(key, f"a preset has its own {key}", "give a preset, or the coefficients")
        name = table.text("preset", "", media.media())
        unit = table.number("unit_mm", 10.0)
        return (
            dataclasses.replace(media.preset(name, unit), ior=ior, roughness=roughness)
            if name in media.media()
            else None
        )
    if "unit_mm" in table.content:
        table.error("unit_mm", "all numbers are given in world units", "leave unit_mm out, or name a preset")
    anisotropy = table.number("anisotropy", 0.0)
    absorption, scattering = (_look if set(LOOK) & table.content.keys() else _coefficients)(table, anisotropy)
    return Medium("custom", absorption, scattering, anisotropy, ior, "the scene", roughness)


def _coefficients(table: Table, _: float) -> tuple[Any, Any]:
    """The absorption and the scattering that a table gives."""
    if "scattering" not in table.content:
        hint = 'write preset = "marble", say; color and depth; or scattering and absorption per world unit'
        table.document.error(
            table.document.place("medium").value, "the medium has neither a preset nor scattering", hint
        )
    absorption: Any = table.vector("absorption", (0.0, 0.0, 0.0))
    scattering: Any = table.vector("scattering", (5.0, 5.0, 5.0))
    if not any(scattering):
        table.error("scattering", "this medium does not scatter", "a measured medium needs scattering above 0")
    return absorption, scattering


def _look(table: Table, anisotropy: float) -> tuple[Any, Any]:
    """The absorption and the scattering of a colour and a depth."""
    for key in ("absorption", "scattering"):
        if key in table.content:
            table.error(key, f"{' and '.join(LOOK)} give the {key}", f"leave {key} out, or {' and '.join(LOOK)}")
    for key, other in (LOOK, LOOK[::-1]):
        if other not in table.content:
            hint = f"write {other} = [0.5, 0.4, 0.3], say: {_MEANING[other]}"
            table.error(key, f"the medium has a {key} and no {other}", hint)
    color, depth = table.vector("color", (0.8, 0.8, 0.8)), table.vector("depth", (0.2, 0.2, 0.2))
    if not any(color):
        table.error("color", "this medium does not scatter", "a measured medium reflects light: a colour above 0")
    albedo = [albedo_of_color(part, anisotropy) for part in color]
    scattering = tuple(a / length for a, length in zip(albedo, depth, strict=True))
    return tuple((1.0 - a) / length for a, length in zip(albedo, depth, strict=True)), scattering


def _inlay(scene: Scene) -> Inlay:
    table = Table(scene.document, ("inlay",), scene.measured["inlay"], INLAY)
    return Inlay(
        table.number("depth", 0.05),
        table.number("ior", 1.5),
        table.number("outside_ior", 1.0),
    )
