"""A project of an engine that shows a preset on a mesh: its material, shaders, mesh, scene and page.

The files of an engine are the templates of `templates/projects/TARGET/`; those beside the folders are for all engines.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from sssgen.interchange.material_writer import SURROUNDINGS
from sssgen.material.material_loading import parse_material
from sssgen.material.material_text import toml_value
from sssgen.pipeline.compiler import compile
from sssgen.presets.preset import Preset
from sssgen.presets.preset_stages import RESPONSE, preset_text
from sssgen.presets.qualities import QUALITIES
from sssgen.presets.used_mesh import UsedMesh
from sssgen.run.web_library import library, network_import_map
from sssgen.scene.mesh_suitability import MeshNeeds
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import place

Files = dict[str, str | bytes]
MESH = "body.glb"
RANK = 16
"""The numbers of a voxel of baked light."""
_LAMP, _SHEET_LAMP = 260, 50
"""The intensity of the lamp for a radius of 1, with light units of three.js: its irradiance is this over the squared
distance."""
_LAMP_COLOR = (1.0, 0.94, 0.86)
_LAMP_SQUARE = 13.8
"""The squared distance of the lamp from the centre, in radii."""
_ROOM, _BRIGHT_ROOM = 0.15, 0.7
"""The strength of the surroundings, for bodies that a lamp makes glow and for clear ones. Engines have other
surroundings and falloffs: the factors in `_values` were chosen so that the projects look alike."""
_EYE, _LAMP_PLACE, _FRONT_LAMP = (1.3, 0.75, 3.7), (-0.9, 1.5, -3.3), (2.0, 3.0, 4.0)
"""The places of the eye, of the lamp behind and of the lamp in front, in radii of the body."""


class Engine(NamedTuple):
    """What a project of a target is."""

    title: str
    opened: str
    """How it is opened, for its README"""
    is_page: bool = False
    """Whether a browser opens it, which needs a server"""
    has_library: bool = False
    """Whether the engine is among the files"""


_SERVE = "`python3 -m http.server` in this folder, then http://localhost:8000 in a browser."
_PAGE, _NPM_PAGE = f"Open it: {_SERVE}", f"Open it: `npm install`, then {_SERVE}"
ENGINES = {
    "threejs": Engine("three.js", _PAGE, is_page=True, has_library=True),
    "babylonjs": Engine("Babylon.js", _NPM_PAGE, is_page=True),
    "playcanvas": Engine("PlayCanvas", _NPM_PAGE, is_page=True),
    "godot": Engine(
        "Godot 4", "Open it: import `project.godot` of this folder in Godot's project manager, and press F5."
    ),
}
"""Target → its project."""


class Request(NamedTuple):
    """A ready material on a mesh, for an engine."""

    preset: Preset
    mesh: UsedMesh
    target: str
    quality: str
    command: str
    """The command line, for the README"""

    @property
    def baked(self) -> bool:
        """Whether the material reads a bake of the light inside."""
        return self.quality == "best" and self.preset.scatters

    @property
    def needs(self) -> MeshNeeds:
        """What the material needs of the mesh."""
        traced = self.quality != "good" or not self.preset.scatters
        path = self.preset.interior(self.mesh.size.unit_mm).mean_free_path if self.preset.scatters else 1.0
        return MeshNeeds(self.preset.scatters, (), None if traced else self.mesh.size.mean_chord / path)

    @property
    def name(self) -> str:
        """Of the material and its files."""
        return self.preset.name


def material_files(request: Request) -> Files:
    """The material, the mesh and the scene, which `sssgen render`, `preview` and `bake` read."""
    text = preset_text(request.preset, request.quality, request.name, request.mesh.size)
    with open(os.path.join(place("examples"), "surroundings", "textures", "studio.png"), "rb") as file:
        picture = file.read()
    scene = _template("scene.toml", **_values(request))
    return {f"{request.name}.toml": text, MESH: request.mesh.glb, "scene.toml": scene, SURROUNDINGS: picture}


def engine_files(request: Request, folder: str) -> Files:
    """The shaders and the project around them. The material and its bakes are in `folder` already.

    Raises SssgenError where the target cannot express the material.
    """
    path = os.path.join(folder, f"{request.name}.toml")
    with open(path, encoding="utf-8") as file:
        material = parse_material(file.read(), path)
    files: Files = dict(compile(material, request.target).files)
    values = _values(request) | {"passes": f"{request.name}_passes.gd" in files}
    if ENGINES[request.target].has_library:
        values["import_map"], libraries = _three()
        files |= libraries
    source = os.path.join(place("templates"), "projects", request.target)
    for name in sorted(entry.removesuffix(".j2") for entry in os.listdir(source)):
        files[name] = _template(f"{request.target}/{name}", **values)
    files["README.md"] = _template("README.md", **values)
    return files


def _three() -> tuple[str, Files]:
    """The import map of a page with three.js, and its files: none where sssgen was installed without npm, which makes
    the bundle. A browser then loads them from the network."""
    try:
        web = library()
    except SssgenError:
        return network_import_map(), {}
    return web.import_map(), {f"library/{name}": source.read_bytes() for name, source in web.files.items()}


def _values(request: Request) -> dict[str, object]:
    """What the templates see."""
    preset, mesh = request.preset, request.mesh
    center = 0.5 * (np.array(mesh.low) + np.array(mesh.high))

    def at(place: tuple[float, float, float]) -> list[float]:
        position: list[float] = (center + mesh.radius * np.array(place)).round(6).tolist()
        return position

    shown = " ".join(os.path.basename(mesh.path).split())
    texts = {
        "title": preset.title, "name": request.name, "mesh": shown, "target": request.target,
        "quality": f"{request.quality}, {QUALITIES[request.quality]}", "unit_mm": f"{mesh.size.unit_mm:.4g}",
        "command": request.command, "open": ENGINES[request.target].opened, "body": MESH,
    }  # fmt: skip
    places = {
        "center": center.round(6).tolist(), "radius": round(mesh.radius, 6), "low_y": mesh.low[1],
        "eye": at(_EYE), "lamp_place": at(_LAMP_PLACE), "front": at(_FRONT_LAMP),
    }  # fmt: skip
    lamp = _SHEET_LAMP if any(preset.sheet) else _LAMP
    room = _ROOM if preset.scatters else _BRIGHT_ROOM
    strength = lamp / math.pi * mesh.radius**2
    light = {
        "surroundings": SURROUNDINGS, "lamp_color": [round(strength * part, 4) for part in _LAMP_COLOR],
        "lamp": lamp, "lamp_square": _LAMP_SQUARE, "godot_lamp": 1.0 if any(preset.sheet) else 4.0,
        "playcanvas_lamp": round(1.6 * lamp / (math.pi * _LAMP_SQUARE), 1),
        "room": room, "scene_room": 2.0 * room,
        "medium": _medium(request), "baked": request.baked, "response": RESPONSE, "rank": RANK,
    }  # fmt: skip
    return texts | places | light


def _medium(request: Request) -> Mapping[str, str] | None:
    """The section [medium] of the scene, of a body that scatters."""
    if not request.preset.scatters:
        return None
    medium = request.preset.interior(request.mesh.size.unit_mm)
    keys = {"absorption": [*medium.absorption], "scattering": [*medium.scattering], "ior": medium.ior}
    return {key: toml_value(value) for key, value in keys.items()}


@cache
def _environment() -> Environment:
    folder = os.path.join(place("templates"), "projects")
    return Environment(
        loader=FileSystemLoader(folder), undefined=StrictUndefined, trim_blocks=True, keep_trailing_newline=True,
        autoescape=False,
    )  # fmt: skip


def _template(file: str, /, **values: object) -> str:
    return _environment().get_template(f"{file}.j2").render(**values)
