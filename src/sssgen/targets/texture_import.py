"""Import settings for engines: of a material's textures in the reflection, and of baked textures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import ImportSettings


def import_settings(
    dimension: str = "2D", wrap: str = "repeat", srgb: bool = False, mipmaps: bool = True, normal_map: bool = False
) -> ImportSettings:
    """The settings as JSON: `dimension` is 2D, 3D or Cube, `wrap` repeat or clamp. The filter is always linear."""
    return {
        "dimension": dimension, "srgb": srgb, "filter": "linear", "wrap": wrap, "mipmaps": mipmaps,
        "normal_map": normal_map,
    }  # fmt: skip


def import_of(uniform: Uniform) -> ImportSettings:
    """The import settings of the image for a texture."""
    assert isinstance(uniform.type, Sampler)
    dimension, clamped = uniform.type.dim, has_hint(uniform, "repeat_disable")
    wrap, mipmaps = "clamp" if clamped else "repeat", not clamped and dimension != "3D"
    return import_settings(dimension, wrap, has_hint(uniform, "source_color"), mipmaps, has_hint(uniform, "normal_map"))


def default_color(uniform: Uniform) -> str:
    """The colour of a texture that is not bound: white, black, gray or bump."""
    return next((name.removeprefix("default_") for name, _ in uniform.hints if name.startswith("default_")), "white")


def has_hint(uniform: Uniform, hint: str) -> bool:
    """Whether a uniform's declaration has the hint."""
    return any(name == hint for name, _ in uniform.hints)
