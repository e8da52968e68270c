"""The neutral record of a foreign material: what its file says, before techniques are chosen for it.

A reader of a format makes it, `material_writer` writes it. Lengths are metres, which are world units; colours are
linear sRGB; texture coordinates have v up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

from sssgen.scene.measured.media import Medium

Wrap: TypeAlias = Literal["repeat", "clamp"]
AlphaMode: TypeAlias = Literal["opaque", "mask", "blend"]


class UvTransform(NamedTuple):
    """Texture coordinates uv' = offset + R(rotation) (tiling uv), v up, as the technique `uv_transform` has them."""

    tiling: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    """Degrees, counter-clockwise"""


class Picture(NamedTuple):
    """A picture file: PNG, JPEG, or another that Pillow reads."""

    name: str
    """Where it comes from, for messages and for the names of textures: a file's name, or an element's path"""
    content: bytes


class Image(NamedTuple):
    """How a quantity reads a picture."""

    picture: Picture
    channels: str = "rgb"
    """The channels in the order of the quantity's components: "rgb", "g", "a". A missing alpha is 1."""
    srgb: bool = False
    """Whether the colours are encoded; alpha never is"""
    uv_set: int = 0
    transform: UvTransform = UvTransform()
    wrap: Wrap = "repeat"
    scale: float = 1.0
    """Multiplies the texel"""
    bias: float = 0.0
    """Is added to the scaled texel"""


class Quantity(NamedTuple):
    """A constant of one component or three, times an image where there is one."""

    factor: tuple[float, ...]
    image: Image | None = None

    @property
    def is_zero(self) -> bool:
        return not any(self.factor)


WHITE = Quantity((1.0, 1.0, 1.0))
ONE = Quantity((1.0,))
ZERO = Quantity((0.0,))
BLACK = Quantity((0.0, 0.0, 0.0))


@dataclass(frozen=True)
class SurfaceModel:
    """A material of another format. The defaults are a white matte dielectric."""

    name: str
    """As in the file; `material_writer` makes an identifier of it"""
    doc: str = ""
    unlit: bool = False
    """The base colour is shown as it is"""
    two_sided: bool = False
    alpha_mode: AlphaMode = "opaque"
    alpha_cutoff: float = 0.5
    """Of the alpha mode `mask`"""
    vertex_colors: bool = False
    """The base colour and the opacity are multiplied by the colours of the mesh's vertices"""

    base_color: Quantity = WHITE
    opacity: Quantity = ONE
    metalness: Quantity = ZERO
    roughness: Quantity = ONE
    """Perceptual: its square is the alpha of GGX"""
    ior: float = 1.5
    specular: Quantity = ONE
    """The weight of the reflection of a dielectric; 1 is that of `ior`"""
    specular_color: Quantity = WHITE
    normal: Quantity = ONE
    """The factor is the strength of the normal map, whose green channel grows upwards"""
    normal_down: bool = False
    """Whether the green channel of the normal map grows downwards (DirectX)"""
    occlusion: Quantity = ONE
    """The factor is the strength of the map"""
    emission: Quantity = BLACK
    """Linear radiance, with its strength"""
    coat: Quantity = ZERO
    coat_roughness: Quantity = ZERO
    sheen_color: Quantity = BLACK
    sheen_roughness: Quantity = ZERO

    transmission: Quantity = ZERO
    """The share of the light at a dielectric boundary that enters the body in place of the diffuse reflection"""
    transmission_tint: Quantity | None = None
    """Multiplies light that enters so; None for the base colour"""
    diffuse_transmission: Quantity = ZERO
    """The share of the diffuse light that leaves on the other side"""
    diffuse_transmission_color: Quantity = WHITE
    subsurface: Quantity = ZERO
    """The share of the diffuse reflection whose light is scattered inside `interior` instead"""
    interior: Medium | None = None
    """Per metre; its boundary's `ior` and `roughness` are not used: those of this record are"""
    thickness: Quantity = ZERO
    """Metres along the inward normal; 0 where the file does not know it"""
    thin_walled: bool = False
    """The surface is a sheet without an interior: light that enters leaves at the same point of the other side"""

    @property
    def transmits(self) -> bool:
        """Whether any light comes through the body."""
        return not (self.transmission.is_zero and self.diffuse_transmission.is_zero and self.subsurface.is_zero)

    @property
    def reflectance(self) -> float:
        """The share of light that the dielectric boundary mirrors at the normal, before `specular`."""
        return ((self.ior - 1.0) / (self.ior + 1.0)) ** 2


def medium(extinction: tuple[float, ...], albedo: tuple[float, ...], anisotropy: float = 0.0) -> Medium:
    """The medium of an extinction per metre and a single-scattering albedo, each of three components."""
    red, green, blue = (t * a for t, a in zip(extinction, albedo, strict=True))
    absorption = (extinction[0] - red, extinction[1] - green, extinction[2] - blue)
    return Medium("interior", absorption, (red, green, blue), anisotropy)


def extinction_of_color(color: tuple[float, ...], distance: float) -> tuple[float, ...]:
    """The extinction -ln(color) / distance per channel, after which white light has the colour; 0 if it is infinite.

    A component of 0 counts as 1e-4, as in the technique `absorption_tint`.
    """
    if math.isinf(distance):
        return (0.0,) * len(color)
    return tuple(max(0.0, -math.log(min(max(channel, 1e-4), 1.0))) / max(distance, 1e-6) for channel in color)
