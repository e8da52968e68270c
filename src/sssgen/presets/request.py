"""What `sssgen use` was asked for, and what all templates see of it."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from sssgen.interchange.material_writer import SURROUNDINGS
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.material.material_text import toml_value
from sssgen.presets.engines import ENGINES, Engine
from sssgen.presets.preset import Preset
from sssgen.presets.preset_stages import RESPONSE
from sssgen.presets.qualities import QUALITIES
from sssgen.presets.used_mesh import UsedMesh
from sssgen.scene.mesh_suitability import MeshNeeds

MESH = "body.glb"
REST = "rest.glb"
"""The other parts of a glTF file"""
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
surroundings and falloffs: the factors in `shared_values` were chosen so that the projects look alike."""
BRIGHTNESS = 4.0
"""The light of the picture of the surroundings where their strength is 1: it is then as bright as the rooms of
engines."""
_EYE, _LAMP_PLACE, _FRONT_LAMP = (1.3, 0.75, 3.7), (-0.9, 1.5, -3.3), (2.0, 3.0, 4.0)
"""The places of the eye, of the lamp behind and of the lamp in front, in radii of the body."""


class Request(NamedTuple):
    """A ready material on a mesh, for an engine."""

    preset: Preset
    mesh: UsedMesh
    target: str
    quality: str
    keeps_color: bool
    """Whether the detail of the mesh's own colours is kept"""
    command: str
    """The command line, for the README"""

    @property
    def engine(self) -> Engine:
        """The engine of the target."""
        return ENGINES[self.target]

    @property
    def baked(self) -> bool:
        """Whether the material reads a bake of the light inside."""
        return self.quality == "best" and self.preset.scatters

    @property
    def needs(self) -> MeshNeeds:
        """What the material needs of the mesh."""
        inside = self.quality != "fast" and not any(self.preset.sheet)
        scattered = inside and self.preset.scatters and not self.baked
        path = self.preset.interior(self.mesh.size.unit_mm).mean_free_path if scattered else 1.0
        paths = self.mesh.size.mean_chord / path if scattered else None
        return MeshNeeds(inside, (), paths, MESH, any(self.preset.sheet), self.mesh.thickness)

    @property
    def clear_share(self) -> float:
        """The share of the light that passes a clear body of the mesh's mean chord, in its clearest channel; 1 for
        others."""
        if self.preset.scatters or any(self.preset.sheet):
            return 1.0
        return math.exp(-min(self.preset.interior(self.mesh.size.unit_mm).extinction) * self.mesh.size.mean_chord)

    @property
    def shows_color(self) -> bool:
        """Whether the material has the detail of the mesh's colours: baked light has the colour of its medium."""
        return self.keeps_color and not self.baked

    @property
    def same_as_good(self) -> str:
        """That the quality is best and nothing is baked, as text; else ''."""
        if self.quality != "best" or self.baked:
            return ""
        return f"{self.preset.name} has no light inside to bake, so that best is the same as good"

    @property
    def quality_text(self) -> str:
        """The quality, and what it is."""
        if self.target == "gltf":
            return "that of the viewer, which draws Khronos' extensions; report.md says what they cannot"
        if any(self.preset.sheet):
            return "the same for all: a sheet needs no picture of the body, and no bake"
        if self.same_as_good:
            return f"good, {QUALITIES['good']}; {self.same_as_good}"
        return f"{self.quality}, {QUALITIES[self.quality]}"

    @property
    def can_be_baked(self) -> bool:
        """Whether another quality has the light inside baked."""
        return self.preset.scatters and not self.baked and self.target != "gltf"

    @property
    def kept(self) -> SurfaceModel | None:
        """The record of the mesh's own material, whose pictures are kept."""
        part = self.mesh.part
        return None if part is None or part.imported is None else part.imported.model

    @property
    def rest(self) -> bytes:
        """The file of the parts with other materials, where the project shows them."""
        part = self.mesh.part
        return part.rest if part is not None and self.engine.shows_rest else b""

    @property
    def name(self) -> str:
        """Of the material and its files."""
        return self.preset.name

    @property
    def opened(self) -> str:
        """How the project is opened."""
        return self.engine.opened.replace("NAME", self.name)

    @property
    def folder(self) -> str:
        """Where the files are, in the folder that is written: a name that ends in /, or ''."""
        return f"{self.name}/" if self.engine.has_folders else ""

    @property
    def change(self) -> str:
        """What is done after a change of the material, in its folder."""
        name, target = f"{self.name}.toml", self.engine.shader or self.target
        if target == "gltf":
            return f"`sssgen export-gltf {name} --mesh {MESH} -o {self.name}.glb`"
        if self.engine.has_folders:
            # Unity ignores folders whose names end in ~: it must not see the scripts twice
            return f"`sssgen emit {name} --target {target} -o emitted~`, then copy the `.shader` of that folder here"
        shell = "".join(f" --shell {option}" for option in self.engine.shell)
        return f"`sssgen emit {name} --target {target}{shell} -o .`"


def shared_values(request: Request) -> dict[str, object]:
    """What the templates of all engines see."""
    preset, mesh = request.preset, request.mesh
    center = 0.5 * (np.array(mesh.low) + np.array(mesh.high))

    def at(place: tuple[float, float, float]) -> list[float]:
        position: list[float] = (center + mesh.radius * np.array(place)).round(6).tolist()
        return position

    texts = {
        "title": preset.title, "name": request.name, "mesh": " ".join(os.path.basename(mesh.path).split()),
        "target": request.target, "quality": request.quality_text,
        "unit_mm": f"{mesh.size.unit_mm:.4g}", "command": request.command, "open": request.opened,
        "change": request.change, "body": MESH, "rest": REST if request.rest else "",
    }  # fmt: skip
    places = {
        "center": center.round(6).tolist(), "radius": round(mesh.radius, 6), "low": [*mesh.low], "high": [*mesh.high],
        "eye": at(_EYE), "lamp_place": at(_LAMP_PLACE), "front": at(_FRONT_LAMP),
    }  # fmt: skip
    lamp = _SHEET_LAMP if any(preset.sheet) else _LAMP
    room = _ROOM if preset.scatters else _BRIGHT_ROOM
    strength = lamp / math.pi * mesh.radius**2
    light = {
        "surroundings": SURROUNDINGS, "lamp_color": [round(strength * part, 4) for part in _LAMP_COLOR],
        "lamp": lamp, "lamp_square": _LAMP_SQUARE, "godot_lamp": 1.0 if any(preset.sheet) else 4.0,
        "playcanvas_lamp": round(1.6 * lamp / (math.pi * _LAMP_SQUARE), 1),
        "room": room, "brightness": BRIGHTNESS, "scene_room": BRIGHTNESS * room,
        "medium": _medium(request), "baked": request.baked, "can_be_baked": request.can_be_baked,
        "response": RESPONSE, "rank": RANK,
    }  # fmt: skip
    return texts | places | light


def _medium(request: Request) -> Mapping[str, str] | None:
    """The section [medium] of the scene, of a body that scatters."""
    if not request.preset.scatters:
        return None
    medium = request.preset.interior(request.mesh.size.unit_mm)
    keys = {"absorption": [*medium.absorption], "scattering": [*medium.scattering], "ior": medium.ior}
    return {key: toml_value(value) for key, value in keys.items()}
