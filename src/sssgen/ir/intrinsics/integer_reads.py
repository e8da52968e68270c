"""Reads of integer textures at coordinates, which GLSL has and WGSL, HLSL and TSL lack: fetches of the nearest texel.

The level is 0, which OpenGL reads, too, where the filter is `NEAREST`: other levels are read by `texelFetch`. Outside of
the texture its texels repeat, as those of OpenGL do unless its sampler has another mode. A cube has no fetch, so that
only GLSL reads cubes of integers.
"""

from __future__ import annotations

from typing import NamedTuple

KINDS = ("i", "u")
LANGUAGES = ("wgsl", "wgsl-metal", "hlsl", "hlsl-dx9", "hlsl-macros", "hlsl-unreal", "tsl")
"""The languages that fetch."""


class _Texture(NamedTuple):
    """A kind of texture, without the letter of its numbers."""

    sampler: str
    place: str
    """The type of a coordinate"""
    along: str
    """The type of a derivative"""
    offset: str
    """The type of an offset; '' for a cube"""


_TEXTURES = (
    _Texture("sampler2D", "vec2", "vec2", "ivec2"),
    _Texture("sampler3D", "vec3", "vec3", "ivec3"),
    _Texture("sampler2DArray", "vec3", "vec2", "ivec2"),
    _Texture("samplerCube", "vec3", "vec3", ""),
)
READS = {
    "texture": ("", "float bias"),
    "textureLod": ("float level",),
    "textureGrad": ("{along} dx, {along} dy",),
    "textureOffset": ("{offset} offset", "{offset} offset, float bias"),
    "textureLodOffset": ("float level, {offset} offset",),
    "textureGradOffset": ("{along} dx, {along} dy, {offset} offset",),
}
"""Builtin → the parameters behind the coordinate, for each of its forms."""


class IntegerReads(NamedTuple):
    """What a row of the intrinsic table has of them."""

    signatures: tuple[str, ...]
    texts: dict[str, str]
    polyfill: str


def integer_reads(name: str) -> IntegerReads:
    """The reads of integer textures by the builtin `name`."""
    signatures: list[str] = []
    texts: dict[str, str] = {}
    polyfills: list[str] = []
    for kind in KINDS:
        for texture in _TEXTURES:
            for form in READS[name]:
                if "offset" in form and not texture.offset:
                    continue
                parameters = [f"{kind}{texture.sampler} map", f"{texture.place} P"]
                parameters += form.format(along=texture.along, offset=texture.offset).split(", ") if form else []
                types = [parameter.split()[0] for parameter in parameters]
                signatures.append(f"{kind}vec4({', '.join(types)})")
                texts |= {f"{language}/{','.join(types)}": "" for language in LANGUAGES}
                if texture.offset:
                    polyfills.append(_polyfill(name, kind, parameters, texture))
    return IntegerReads(tuple(signatures), texts, "".join(polyfills))


def _polyfill(name: str, kind: str, parameters: list[str], texture: _Texture) -> str:
    layered = texture.sampler == "sampler2DArray"
    place, size = ("P.xy", "size.xy") if layered else ("P", "size")
    sizes = f"{texture.along}({size})"
    within = f"fract({place})"
    if any(parameter.endswith("offset") for parameter in parameters):
        # from the middle of a texel, so that rounding leads to no other one; fract of a tiny negative number is 1
        texel = f"min(floor(fract({place}) * {sizes}), {sizes} - 1.0)"
        within = f"fract(({texel} + {texture.along}(offset) + 0.5) / {sizes})"
    texel = f"min({texture.offset}({within} * {sizes}), {size} - 1)"
    if layered:
        texel = f"ivec3({texel}, clamp(int(round(P.z)), 0, size.z - 1))"
    return f"""{kind}vec4 {name}({", ".join(parameters)}) {{
    {"ivec3" if layered else texture.offset} size = textureSize(map, 0);
    return texelFetch(map, {texel}, 0);
}}
"""
