"""The values of a lit surface: one row per value, which every part of the project reads.

To add a value, add its row here, and in the descriptor of each engine that has the value a line of `[surface…]`. An
engine without it needs a line of `[lacks]`.
"""

from __future__ import annotations

from typing import NamedTuple

from sssgen.ir.types import FLOAT, VEC3, Type


class SurfaceField(NamedTuple):
    """One value of the surface. A number is between 0 and 1; a vec3 is a colour, except the normal."""

    name: str
    type: Type
    default: tuple[float, ...]
    """The value where no technique writes it."""
    doc: str
    optional: bool = False
    """Whether techniques that read the value get its default as a constant where no stage writes it: the standard
    lighting then has no code for it. Not every engine has these values."""


FIELDS: tuple[SurfaceField, ...] = (
    SurfaceField("albedo", VEC3, (1.0, 1.0, 1.0), "the share of light that is reflected diffusely, linear"),
    SurfaceField("alpha", FLOAT, (1.0,), "the opacity"),
    SurfaceField("normal", VEC3, (0.0, 0.0, 1.0), "the unit normal in the tangent frame"),
    SurfaceField("metallic", FLOAT, (0.0,), "the share of metal"),
    SurfaceField("roughness", FLOAT, (0.5,), "the perceptual roughness of the highlight"),
    SurfaceField("occlusion", FLOAT, (1.0,), "the share of ambient light that arrives"),
    SurfaceField("emission", VEC3, (0.0, 0.0, 0.0), "the emitted light, linear"),
    SurfaceField("specular", FLOAT, (0.04,), "the reflectance of a dielectric at its normal", optional=True),
    SurfaceField("clearcoat", FLOAT, (0.0,), "the weight of a clear coat", optional=True),
    SurfaceField("clearcoat_roughness", FLOAT, (0.0,), "the perceptual roughness of the clear coat", optional=True),
    SurfaceField("sheen_color", VEC3, (0.0, 0.0, 0.0), "the reflectance of fibres at grazing angles", optional=True),
    SurfaceField("sheen_roughness", FLOAT, (0.0,), "the perceptual roughness of the sheen", optional=True),
)

NAMES: tuple[str, ...] = tuple(field.name for field in FIELDS)
OPTIONAL: tuple[str, ...] = tuple(field.name for field in FIELDS if field.optional)
FRACTIONS: frozenset[str] = frozenset(field.name for field in FIELDS if field.type == FLOAT)
COLORS: frozenset[str] = frozenset(field.name for field in FIELDS if field.type == VEC3 and field.name != "normal")
