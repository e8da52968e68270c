"""Reads of integer textures at coordinates, which GLSL has and WGSL, HLSL and TSL lack: fetches of the nearest texel.

The level is 0, which OpenGL reads, too, where the filter is `NEAREST`: other levels are read by `texelFetch`. Outside of
the texture its texels repeat, as those of OpenGL do unless its sampler has another mode. A cube has no fetch: of the four
texels that a gather gives, the nearest one is chosen. Where a language has no gathers, they are four fetches.
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


GATHERS = ("textureGather", "textureGatherOffset", "textureGatherLayer", "textureGatherLayerOffset")
"""The builtins that gather, of which those of layers are the project's own."""


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
                polyfill = _polyfill if texture.offset else _polyfill_of_cube
                polyfills.append(polyfill(name, kind, parameters, texture))
    return IntegerReads(tuple(signatures), texts, "".join(polyfills))


def integer_gathers(name: str) -> IntegerReads:
    """The gathers of integer textures by the builtin `name`."""
    signatures: list[str] = []
    texts: dict[str, str] = {}
    polyfills: list[str] = []
    layered = "Layer" in name
    for kind in KINDS:
        for texture in _TEXTURES:
            is_array = texture.sampler == "sampler2DArray"
            if (
                texture.sampler == "sampler3D"
                or (layered and not is_array)
                or ("Offset" in name and not texture.offset)
            ):
                continue
            place = ["vec2 P", "int layer"] if layered else [f"{texture.place} P"]
            offset = ["ivec2 offset"] if "Offset" in name else []
            for channel in ([], ["int channel"]):
                parameters = [f"{kind}{texture.sampler} map", *place, *offset, *channel]
                types = [parameter.split()[0] for parameter in parameters]
                signatures.append(f"{kind}vec4({', '.join(types)})")
                texts |= _gather_texts(types, layered, bool(offset), bool(channel))
                if texture.offset:
                    body = _gather_polyfill(name, kind, is_array, bool(channel))
                    polyfills.append(f"{kind}vec4 {name}({', '.join(parameters)}) {{{body}}}\n")
    return IntegerReads(tuple(signatures), texts, "".join(polyfills))


def _gather_texts(types: list[str], layered: bool, offset: bool, channel: bool) -> dict[str, str]:
    """The texts of a gather in WGSL and HLSL; the others have none."""
    key, at = ",".join(types), len(types) - 1
    given = [f"{{{index}}}" for index in range(1, at if channel else at + 1)]
    number = f"{{{at}}}" if channel else "0"
    texts = {f"wgsl/{key}": f"textureGather({number}, {{texture}}, {{sampler}}, {', '.join(given)})"}
    if "Array" in types[0] and not layered:
        texts[f"wgsl/{key}"] = ""  # by its layer
    if layered:
        more = ", {3}" if offset else ""
        color = "{channel}" if channel else "Red"
        texts[f"hlsl/{key}"] = f"{{texture}}.Gather{color}({{sampler}}, float3({{1}}, float({{2}})){more})"
    return texts


def _gather_polyfill(name: str, kind: str, is_array: bool, channel: bool) -> str:
    """The body of a gather by other gathers, or by four fetches."""
    last = ", channel" if channel else ""
    if name == "textureGather" and not is_array:
        return f" return textureGatherOffset(map, P, ivec2(0){last}); "
    if name == "textureGatherLayer":
        return f" return textureGatherLayerOffset(map, P, layer, ivec2(0){last}); "
    if is_array and "Layer" not in name:
        offset = ", offset" if "Offset" in name else ""
        return f" return {name.replace('Gather', 'GatherLayer')}(map, P.xy, int(round(P.z)){offset}{last}); "
    size = "textureSize(map, 0).xy" if is_array else "textureSize(map, 0)"
    read = "texelFetchLayer(map, {}, layer, 0)" if is_array else "texelFetch(map, {}, 0)"
    corners = ("ivec2(low.x, high.y)", "high", "ivec2(high.x, low.y)", "low")
    chosen = "[channel]" if channel else ".x"
    texels = ", ".join(f"{read.format(corner)}{chosen}" for corner in corners)
    return f"""
    ivec2 size = {size};
    ivec2 low = ivec2(floor(P * vec2(size) - 0.5)) + offset;
    ivec2 high = low + 1;
    low = low - size * ivec2(floor(vec2(low) / vec2(size)));
    high = high - size * ivec2(floor(vec2(high) / vec2(size)));
    return {kind}vec4({texels});
"""


def _polyfill_of_cube(name: str, kind: str, parameters: list[str], texture: _Texture) -> str:
    """The nearest of the four texels that a gather gives. GLSL 4.60, section 8.13 of OpenGL 4.6, has the faces."""
    texels = ", ".join(f"textureGather(map, P, {channel})[nearest]" for channel in range(4))
    return f"""{kind}vec4 {name}({", ".join(parameters)}) {{
    vec3 far = abs(P);
    vec2 face = vec2(P.z < 0.0 ? -P.x : P.x, -P.y) / far.z;
    if (far.y > far.z) {{ face = vec2(P.x, P.y < 0.0 ? -P.z : P.z) / far.y; }}
    if (far.x > far.y && far.x > far.z) {{ face = vec2(P.x < 0.0 ? P.z : -P.z, -P.y) / far.x; }}
    vec2 within = fract((face * 0.5 + 0.5) * vec2(textureSize(map, 0)) - 0.5);
    int nearest = within.y >= 0.5 ? (within.x >= 0.5 ? 1 : 0) : within.x >= 0.5 ? 2 : 3;
    return {kind}vec4({texels});
}}
"""


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
