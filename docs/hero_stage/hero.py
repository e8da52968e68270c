"""What a hero is: the records of its hero.toml. Lengths are in world units, angles in degrees, light is linear RGB."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[1] / "heroes"
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A camera with a thin lens."""

    position: Vector
    target: Vector
    field_of_view: float
    """Vertical"""
    focus: Vector
    """A point of the plane that is sharp"""
    aperture: float
    """The radius of the lens"""
    exposure: float = 1.0
    curve: str = "agx"
    """Of the film: a technique of the role tone_mapping"""
    saturation: float = 1.0
    glare: float = 0.04
    """The share of the light that the lens spreads"""


@dataclass(frozen=True)
class Lamp:
    """A luminous ball."""

    position: Vector
    intensity: Vector
    """Radiant intensity: the irradiance of a surface at a distance of 1"""
    radius: float
    target: Vector | None = None
    """In the engine, the middle of the cone that it lights; None: everything"""
    cone: float = 120.0
    """How wide that cone is: a narrow one has a finer shadow"""
    shown: bool = True
    """Whether it is a body of light in the path traced picture; otherwise a prop there emits the light"""


@dataclass(frozen=True)
class Surroundings:
    """A picture of everything that is far away."""

    picture: str
    """A name of the pictures of @pmndrs/assets"""
    turn: float = 0.0
    intensity: float = 1.0
    brightest: float = 30.0
    """Radiance above this is clipped"""
    shown: float = 1.0
    """The factor of what the camera sees of it"""


@dataclass(frozen=True)
class Body:
    """A translucent mesh at some places."""

    mesh: str
    material: str
    medium: Mapping[str, Any]
    """absorption and scattering per world unit, ior; of a sheet, what is passed and reflected of its first picture"""
    places: tuple[tuple[float, ...], ...] = ((0.0, 0.0, 0.0, 0.0, 1.0),)
    """Position, turn about y, scale"""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    pictures: Mapping[str, str] = field(default_factory=dict)
    """Textures of the material: pictures of the model"""
    roughness: float = 0.2
    """Of the path tracer's boundary; the material has its own"""
    inclusions: str | None = None
    """A volume of the model: factors of the light that is scattered inside"""
    voxels: int = 24
    """Of its bake, along the longest side; 0: the material needs none"""
    glow: Vector = (0.0, 0.0, 0.0)
    """The radiant intensity of what leaves the body at the height `glow_height`, which lights props in the engine"""
    glow_height: float = 0.4


@dataclass(frozen=True)
class Prop:
    """An opaque mesh."""

    mesh: str
    color: Vector
    roughness: float = 0.7
    metalness: float = 0.0
    emission: Vector = (0.0, 0.0, 0.0)
    places: tuple[tuple[float, ...], ...] = ((0.0, 0.0, 0.0, 0.0, 1.0),)
    picture: str | None = None
    """A picture of the model: its colour, a factor of `color`"""


@dataclass(frozen=True)
class Hero:
    """A picture: bodies, what is around them, lamps and a camera."""

    name: str
    title: str
    doc: str
    camera: Camera
    surroundings: Surroundings
    bodies: tuple[Body, ...]
    props: tuple[Prop, ...]
    lamps: tuple[Lamp, ...]
    cells: int
    """Of the models, along the longest side of a mesh"""
    bake_cells: int
    """The same of the meshes for bakes; 0: those of the picture"""
    traced: bool
    """Whether it is path traced, too"""
    shade: Vector
    """The share of the light that comes through bodies into their shadows, in the engine"""
    photons: int
    """Of the bakes, for each direction and channel; the products of a voxel average over directions"""

    @property
    def folder(self) -> Path:
        return FOLDER / self.name


def heroes() -> list[str]:
    """The names of all heroes."""
    return sorted(file.parent.name for file in FOLDER.glob("*/hero.toml"))


def load(name: str) -> Hero:
    """The hero of a folder."""
    data = tomllib.loads((FOLDER / name / "hero.toml").read_text("utf-8"))
    return Hero(
        name, data["title"], data["doc"], Camera(**data["camera"]), Surroundings(**data["surroundings"]),
        tuple(Body(**body) for body in data["body"]), tuple(Prop(**prop) for prop in data.get("prop", ())),
        tuple(Lamp(**lamp) for lamp in data.get("lamp", ())), data.get("cells", 150),
        data.get("bake_cells", 50), data.get("traced", True), tuple(data.get("shade", (0.0, 0.0, 0.0))),
        data.get("photons", 800),
    )  # fmt: skip
