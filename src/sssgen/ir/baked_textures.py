"""Textures that are baked from a body, as their declarations show."""

from __future__ import annotations

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler


def is_baked(uniform: Uniform) -> bool:
    """Whether a texture is baked from the body: a volume, a map that holds a quantity, or one with `texel_bytes`."""
    declared = bool(uniform.quantity) or "texel_bytes" in dict(uniform.hints)
    return isinstance(uniform.type, Sampler) and (declared or is_volume(uniform))


def is_volume(uniform: Uniform) -> bool:
    """Whether it is a texture with three dimensions."""
    return isinstance(uniform.type, Sampler) and uniform.type.dim == "3D"
