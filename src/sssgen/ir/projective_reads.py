"""Projective reads of textures: the coordinate is divided by its last component, then the texture is read.

    PROJECTIVE_READS["textureProjLodOffset"]     # "textureLodOffset"
    kept_components(Sampler("2D"), VEC4)         # 2: P.xy / P.w
    kept_components(Sampler("3D"), VEC4)         # 3: P.xyz / P.w, as of a texture that compares

The front end writes them so; no other part of the compiler knows them.
Source: chapter 8.9 of the GLSL 4.60 specification, and 8.8 of GLSL ES 3.00.
"""

from __future__ import annotations

from sssgen.ir.types import Sampler, Type, Vector

PROJECTIVE_READS = {
    f"textureProj{rest}": f"texture{rest}" for rest in ("", "Lod", "Grad", "Offset", "LodOffset", "GradOffset")
}
"""Name → the builtin that reads at the divided coordinate."""


def kept_components(texture: Type, coordinate: Type) -> int | None:
    """How many components of a coordinate are divided by its last one; None where there is no such read."""
    if not isinstance(texture, Sampler) or texture.array or texture.dim not in ("2D", "3D"):
        return None
    if not isinstance(coordinate, Vector) or coordinate.kind != "float":
        return None
    if texture.shadow or texture.dim == "3D":
        return 3 if coordinate.size == 4 else None
    if texture.line:
        return 1 if coordinate.size in (2, 4) else None
    return 2 if coordinate.size in (3, 4) else None
