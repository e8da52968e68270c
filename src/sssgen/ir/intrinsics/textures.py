"""Reads of textures.

The coordinate of a texture with layers ends with the layer, that of a comparing texture with the reference. HLSL and
WGSL need some of these as separate arguments. Builtins of the project have them so, `…Layer…` and `…Compare…`
(`texture_parts.py`); the polyfills use these.

Integer texels are fetched (`integer_reads.py`), as WGSL and HLSL cannot filter them. HLSL queries a texture's size in a
statement; its printer emits a function for that, `texture_size` or `texture_levels`.
"""

from __future__ import annotations

from typing import Any

from sssgen.ir import vector_ranges
from sssgen.ir.intrinsics.integer_reads import integer_gathers, integer_reads
from sssgen.ir.intrinsics.table import Builtin, ConstantArgument, Level, Samples
from sssgen.ir.vector_ranges import all_within, any_numbers, texels

_SAMPLE = ("vec4(sampler2D, vec2", "vec4(sampler3D, vec3", "vec4(samplerCube, vec3")
_LAYERS = ("vec4(sampler2DArray, vec3", "vec4(samplerCubeArray, vec4")
_FLAT = ("vec4(sampler2D, vec2", "vec4(sampler3D, vec3", "vec4(sampler2DArray, vec3")
_SHADOWS = ("sampler2DShadow,vec3", "samplerCubeShadow,vec4", "sampler2DArrayShadow,vec4")
_BIASED_SHADOWS = ("sampler2DShadow,vec3,float", "samplerCubeShadow,vec4,float")
_SHADOW_GRADIENTS = (
    "sampler2DShadow,vec3,vec2,vec2", "samplerCubeShadow,vec4,vec3,vec3", "sampler2DArrayShadow,vec4,vec2,vec2",
)  # fmt: skip
_SHADOW_OFFSETS = (
    "float(sampler2DShadow, vec3, ivec2)", "float(sampler2DShadow, vec3, ivec2, float)",
    "float(sampler2DArrayShadow, vec4, ivec2)",
)  # fmt: skip
_SHADOW_GRADIENT_OFFSETS = (
    "float(sampler2DShadow, vec3, vec2, vec2, ivec2)", "float(sampler2DArrayShadow, vec4, vec2, vec2, ivec2)",
)  # fmt: skip
_GATHERED = ("sampler2D, vec2", "samplerCube, vec3", "sampler2DArray, vec3", "samplerCubeArray, vec4")
_GATHERED_SHADOWS = (
    "sampler2DShadow, vec2, float",
    "samplerCubeShadow, vec3, float",
    "sampler2DArrayShadow, vec3, float",
)
_KINDS = ("", "i", "u")
EIGHT_BITS = "D3D: filter weights of 8 bits; WGSL, Vulkan, GLSL: no bound"
BY_READS = "In GLSL without it, by reads at the texels' centres"


def params(signature: str) -> str:
    """The parameters of a signature's beginning, as spelled in a key of `texts`: `sampler2D,vec2`."""
    return signature.partition("(")[2].replace(" ", "")


def offset_at(position: int) -> ConstantArgument:
    """An offset in texels at this position; every OpenGL allows this range, D3D and WGSL no other."""
    return ConstantArgument(position, ("ivec2", "ivec3"), "offset", -8, 7)


def channel_at(position: int) -> ConstantArgument:
    """The channel that a gather reads, at this position."""
    return ConstantArgument(position, ("int",), "channel", 0, 3)


def _offsets(extra: str = "") -> tuple[str, ...]:
    """Signatures with an offset in texels after `extra`."""
    return tuple(f"{read}{extra}, ivec{size})" for read, size in zip(_FLAT, (2, 3, 2), strict=True))


def gather_polyfill(parameters: str, size: str, read: str, channel: bool = False) -> str:
    """A gather with an offset for languages without one, by `read`s at the centres `{}` of the four texels. Those of a
    texture that compares are rounded, as the centres are."""
    corners = [read.format(corner) for corner in ("vec2(low.x, high.y)", "high", "vec2(high.x, low.y)", "low")]
    if channel:
        lines = [f"vec4 {name} = {corner};" for name, corner in zip("abcd", corners, strict=True)]
        lines.append("return vec4(a[channel], b[channel], c[channel], d[channel]);")
    elif "Shadow" in parameters:
        lines = [f"return round(vec4({', '.join(corners)}));"]
    else:
        lines = [f"return vec4({', '.join(f'{corner}.x' for corner in corners)});"]
    statements = "\n    ".join(lines)
    return f"""({parameters}, ivec2 offset{", int channel" if channel else ""}) {{
    vec2 size = vec2({size});
    vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
    vec2 high = low + 1.0 / size;
    {statements}
}}
"""


def _unreal(kind: str, arguments: str, *extra: str) -> dict[str, str]:
    """Unreal's functions for a kind of read; `extra` are the parameters behind the coordinate, of each texture or of all."""
    behind = extra if len(extra) > 1 else 3 * (extra or ("",))
    names = zip(_SAMPLE, behind, ("2D", "3D", "Cube"), strict=True)
    return {f"hlsl-unreal/{params(read)}{more}": f"Texture{dim}Sample{kind}{arguments}" for read, more, dim in names}


def _exists(rt: Any, texture: Any, place: Any, level: Any, offset: Any = ()) -> Any:
    """Whether a texel of level 0 exists. An offset has no component for the layer."""
    exists = level == 0
    for axis, (number, size) in enumerate(zip(place, rt.textureSize(texture, 0), strict=True)):
        moved = number + offset[axis] if axis < len(offset) else number
        exists = exists & (moved >= 0) & (moved < size)
    return exists


# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("unpackNormal", ("vec3(vec4)",),
        "The tangent-space normal of a normal map's texel, y up. Unity may pack it when it imports the map.",
        samples=Samples(floats=((0.0, 1.0),)), componentwise=False, range=vector_ranges.normal_of_texel,
        size=lambda rt, x: rt.max(2.0 * abs(x[:3]), 1.0),
        texts={"glsl": "", "hlsl": "", "wgsl": "", "tsl": "", "hlsl-dx9": "UnpackNormal", "hlsl-macros": "UnpackNormal",
            "glsl-godot": "unpack_normal", "hlsl-unreal": "(UnpackNormalMap({0}).xyz * float3(1.0, -1.0, 1.0))"},
        polyfill="vec3 unpackNormal(vec4 texel) { return texel.xyz * 2.0 - 1.0; }", cost=2,
        vectors=(
            (((0.5, 0.5, 1.0, 1.0),), (0.0, 0.0, 1.0)), (((1.0, 0.0, 0.5, 0.0),), (1.0, -1.0, 0.0)),
            (((0.75, 0.25, 1.0, 1.0),), (0.5, -0.5, 1.0)),
        ),
    ),
    # Queries
    Builtin("textureSize",
        (
            *(f"ivec{size}({kind}sampler{dim}, int)" for kind in _KINDS for dim, size in (("2D", 2), ("3D", 3), ("Cube", 2), ("2DArray", 3))),
            "ivec3(samplerCubeArray, int)", "ivec2(sampler2DShadow, int)", "ivec2(samplerCubeShadow, int)", "ivec3(sampler2DArrayShadow, int)",
            *(f"ivec2({kind}sampler2DMS)" for kind in _KINDS),
        ),
        "Size in texels of level y, and how many layers there are.",
        es=300, size_query=True, componentwise=False, range=all_within(0.0, 65536.0), domain="the level exists",
        texts={
            "wgsl-metal": "{type}({texture}.get_width(uint({1})), {texture}.get_height(uint({1})))",
            **{f"wgsl-metal/{kind}sampler3D,int": "{type}({texture}.get_width(uint({1})), {texture}.get_height(uint({1})), {texture}.get_depth(uint({1})))" for kind in _KINDS},
            **{
                f"wgsl-metal/{sampler},int": "{type}({texture}.get_width(uint({1})), {texture}.get_height(uint({1})), {texture}.get_array_size())"
                for sampler in ("sampler2DArray", "isampler2DArray", "usampler2DArray", "samplerCubeArray", "sampler2DArrayShadow")
            },
            **{f"wgsl-metal/{kind}sampler2DMS": "{type}({texture}.get_width(), {texture}.get_height())" for kind in _KINDS},
            **{f"hlsl/{kind}sampler2DMS": "texture_size({bare_texture})" for kind in _KINDS},
            **{f"wgsl/{kind}sampler2DMS": "{type}(textureDimensions({texture}))" for kind in _KINDS},
            "tsl": "", "tsl/sampler2D,int": "{type}({texture}.size({1}))", "tsl/samplerCube,int": "{type}({texture}.size({1}))",
            "hlsl": "texture_size({bare_texture}, {1})", "hlsl-dx9": "", "wgsl": "{type}(textureDimensions({texture}, {1}))",
            **{
                f"wgsl/{sampler},int": "{type}(vec3u(textureDimensions({texture}, {1}), textureNumLayers({texture})))"
                for sampler in ("sampler2DArray", "isampler2DArray", "usampler2DArray", "samplerCubeArray", "sampler2DArrayShadow")
            },
        },
        splat=(), kind="fetch",
    ),
    Builtin("textureQueryLevels", ("int(sampler2D)", "int(sampler3D)", "int(samplerCube)", "int(sampler2DArray)"),
        "How many levels there are.", componentwise=False, range=all_within(0.0, 32.0),
        size_query=True,
        texts={
            "wgsl-metal": "{type}({texture}.get_num_mip_levels())",
            "glsl": "", "glsl-330": "textureQueryLevels", "tsl": "",
            "hlsl": "texture_levels({bare_texture})", "hlsl-dx9": "",
            "wgsl": "{type}(textureNumLevels({texture}))"},
        later_glsl=True, kind="fetch",
    ),
    Builtin("textureQueryLod", ("vec2(sampler2D, vec2)", "vec2(sampler3D, vec3)"),
        "The level that a read would take at y, and the one that derivatives give.",
        componentwise=False, range=any_numbers,
        uniform_flow=True, kind="fetch", absolute=0.01, clause="D3D, GLSL: no bound",
        texts={
            "glsl": "", "glsl-330": "textureQueryLod", "tsl": "", "wgsl": "", "hlsl-dx9": "",
            "hlsl": "float2({bare_texture}.CalculateLevelOfDetail({bare_sampler}, {1}), {bare_texture}.CalculateLevelOfDetailUnclamped({bare_sampler}, {1}))",
        },
        later_glsl=True,
        polyfill="".join(f"""
vec2 textureQueryLod(sampler{dim}D map, vec{dim} P) {{
    vec{dim} size = vec{dim}(textureSize(map, 0));
    vec{dim} dx = dFdx(P) * size;
    vec{dim} dy = dFdy(P) * size;
    float level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.17549435e-38));
    return vec2(clamp(level, 0.0, float(textureQueryLevels(map) - 1)), level);
}}
""" for dim in (2, 3)),
        splat=(),
    ),
    # Filtered reads
    Builtin("texture",
        (
            *(f"{read})" for read in (*_SAMPLE, *_LAYERS)), *(f"{read}, float)" for read in (*_SAMPLE, *_LAYERS)),
            *(f"float({shadow.replace(',', ', ')})" for shadow in (*_SHADOWS, *_BIASED_SHADOWS)),
            *integer_reads("texture").signatures,
        ),
        "Filtered texture read; the level comes from screen-space derivatives, with z added to it. Of a texture that "
        "compares: the part of the texels that are not below the reference; only GLSL adds z to its level.",
        es=300, with_level=Level("textureLod", 2), with_gradients="textureGrad", componentwise=False, range=texels,
        uniform_flow=True,
        texts={
            **integer_reads("texture").texts,
            "wgsl-metal": "{texture}.sample({sampler}, {1})",
            **{f"wgsl-metal/{params(read)},float": "{texture}.sample({sampler}, {1}, metal::bias({2}))" for read in _SAMPLE},
            **{f"wgsl-metal/{params(read)}{bias}": "" for read in _LAYERS for bias in ("", ",float")},
            **{f"wgsl-metal/{shadow}": "" for shadow in (*_SHADOWS, *_BIASED_SHADOWS)},
            "tsl": "{texture}.sample({1})",
            **{f"tsl/{params(read)},float": "{texture}.sample({1}).bias({2})" for read in _SAMPLE},
            **{f"tsl/{params(read)}{bias}": "" for read in _LAYERS for bias in ("", ",float")},
            **{f"tsl/{shadow}": "" for shadow in (*_SHADOWS, *_BIASED_SHADOWS)},
            "hlsl": "{texture}.Sample({sampler}, {1})",
            **{f"hlsl/{params(read)},float": "{texture}.SampleBias({sampler}, {1}, {2})" for read in (*_SAMPLE, *_LAYERS)},
            "hlsl-dx9": "tex{dim}({texture}, {1})",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dbias({texture}, float4({1}, 0.0, {2}))",
            "hlsl-dx9/sampler3D,vec3,float": "tex3Dbias({texture}, float4({1}, {2}))",
            "hlsl-dx9/samplerCube,vec3,float": "texCUBEbias({texture}, float4({1}, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}({texture}, {sampler}, {1})",
            "hlsl-macros/sampler2D,vec2,float": "SAMPLE_TEXTURE2D_BIAS({texture}, {sampler}, {1}, {2})",
            "hlsl-macros/sampler3D,vec3,float": "{bare_texture}.SampleBias({bare_sampler}, {1}, {2})",
            "hlsl-macros/samplerCube,vec3,float": "SAMPLE_TEXTURECUBE_BIAS({texture}, {sampler}, {1}, {2})",
            **_unreal("", "({texture}, {sampler}, {1})"), **_unreal("Bias", "({texture}, {sampler}, {1}, {2})", ",float"),
            "wgsl": "textureSample({texture}, {sampler}, {1})",
            **{f"wgsl/{params(read)},float": "textureSampleBias({texture}, {sampler}, {1}, {2})" for read in _SAMPLE},
            **{f"wgsl/{params(read)}{bias}": "" for read in _LAYERS for bias in ("", ",float")},
            **{f"{language}/{shadow}": "" for language in ("hlsl", "wgsl") for shadow in (*_SHADOWS, *_BIASED_SHADOWS)},
        },
        polyfill="""
vec4 texture(sampler2DArray map, vec3 P) { return textureLayer(map, P.xy, int(round(P.z))); }
vec4 texture(samplerCubeArray map, vec4 P) { return textureLayer(map, P.xyz, int(round(P.w))); }
vec4 texture(sampler2DArray map, vec3 P, float bias) { return textureLayer(map, P.xy, int(round(P.z)), bias); }
vec4 texture(samplerCubeArray map, vec4 P, float bias) { return textureLayer(map, P.xyz, int(round(P.w)), bias); }
float texture(sampler2DShadow map, vec3 P) { return textureCompare(map, P.xy, P.z); }
float texture(samplerCubeShadow map, vec4 P) { return textureCompare(map, P.xyz, P.w); }
float texture(sampler2DShadow map, vec3 P, float bias) { return textureCompare(map, P.xy, P.z); }
float texture(samplerCubeShadow map, vec4 P, float bias) { return textureCompare(map, P.xyz, P.w); }
float texture(sampler2DArrayShadow map, vec4 P) { return textureCompare(map, P.xy, int(round(P.z)), P.w); }
""" + integer_reads("texture").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    Builtin("textureLod",
        (
            *(f"{read}, float)" for read in (*_SAMPLE, *_LAYERS)), "float(sampler2DShadow, vec3, float)",
            *integer_reads("textureLod").signatures,
        ),
        "Filtered texture read at level z; HLSL and WGSL compare at level 0 only.",
        es=300, componentwise=False, range=texels, domain="z = 0 for a texture that compares",
        texts={
            **integer_reads("textureLod").texts,
            "wgsl-metal": "{texture}.sample({sampler}, {1}, metal::level({2}))", "wgsl-metal/sampler2DShadow,vec3,float": "",
            **{f"wgsl-metal/{params(read)},float": "" for read in _LAYERS},
            "tsl": "{texture}.sample({1}).level({2})", "tsl/sampler2DShadow,vec3,float": "",
            **{f"tsl/{params(read)},float": "" for read in _LAYERS},
            "hlsl": "{texture}.SampleLevel({sampler}, {1}, {2})", "hlsl/sampler2DShadow,vec3,float": "",
            "hlsl-dx9": "tex{dim}lod({texture}, float4({1}, {2}))",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dlod({texture}, float4({1}, 0.0, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}_LOD({texture}, {sampler}, {1}, {2})",
            **_unreal("Level", "({texture}, {sampler}, {1}, {2})", ",float"),
            "wgsl": "textureSampleLevel({texture}, {sampler}, {1}, {2})", "wgsl/sampler2DShadow,vec3,float": "",
            **{f"wgsl/{params(read)},float": "" for read in _LAYERS},
        },
        polyfill="""
vec4 textureLod(sampler2DArray map, vec3 P, float level) { return textureLayerLod(map, P.xy, int(round(P.z)), level); }
vec4 textureLod(samplerCubeArray map, vec4 P, float level) { return textureLayerLod(map, P.xyz, int(round(P.w)), level); }
float textureLod(sampler2DShadow map, vec3 P, float level) { return textureCompareLod(map, P.xy, P.z); }
""" + integer_reads("textureLod").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    Builtin("textureGrad",
        (
            "vec4(sampler2D, vec2, vec2, vec2)", *(f"{read}, vec3, vec3)" for read in _SAMPLE[1:]),
            "vec4(sampler2DArray, vec3, vec2, vec2)", "vec4(samplerCubeArray, vec4, vec3, vec3)",
            "float(sampler2DShadow, vec3, vec2, vec2)", "float(samplerCubeShadow, vec4, vec3, vec3)",
            "float(sampler2DArrayShadow, vec4, vec2, vec2)", *integer_reads("textureGrad").signatures,
        ),
        "Filtered texture read; the level comes from the given derivatives of the coordinate along screen x and y. HLSL and "
        "WGSL compare at level 0 only.",
        es=300, componentwise=False, range=texels,
        texts={
            **integer_reads("textureGrad").texts,
            "wgsl-metal": "",
            "wgsl-metal/sampler2D,vec2,vec2,vec2": "{texture}.sample({sampler}, {1}, gradient2d({2}, {3}))",
            "wgsl-metal/sampler3D,vec3,vec3,vec3": "{texture}.sample({sampler}, {1}, gradient3d({2}, {3}))",
            "wgsl-metal/samplerCube,vec3,vec3,vec3": "{texture}.sample({sampler}, {1}, gradientcube({2}, {3}))",
            "tsl": "", "tsl/sampler2D,vec2,vec2,vec2": "{texture}.sample({1}).grad({2}, {3})",
            "hlsl": "{texture}.SampleGrad({sampler}, {1}, {2}, {3})",
            "hlsl-dx9": "tex{dim}grad({texture}, {1}, {2}, {3})",
            "hlsl-macros": "{bare_texture}.SampleGrad({bare_sampler}, {1}, {2}, {3})",
            "hlsl-macros/sampler2D,vec2,vec2,vec2": "SAMPLE_TEXTURE2D_GRAD({texture}, {sampler}, {1}, {2}, {3})",
            **_unreal("Grad", "({texture}, {sampler}, {1}, {2}, {3})", ",vec2,vec2", ",vec3,vec3", ",vec3,vec3"),
            "wgsl": "textureSampleGrad({texture}, {sampler}, {1}, {2}, {3})",
            "wgsl/sampler2DArray,vec3,vec2,vec2": "", "wgsl/samplerCubeArray,vec4,vec3,vec3": "",
            **{f"{language}/{shadow}": "" for language in ("hlsl", "wgsl") for shadow in _SHADOW_GRADIENTS},
        },
        polyfill="""
vec4 textureGrad(sampler2DArray map, vec3 P, vec2 dx, vec2 dy) { return textureLayerGrad(map, P.xy, int(round(P.z)), dx, dy); }
vec4 textureGrad(samplerCubeArray map, vec4 P, vec3 dx, vec3 dy) { return textureLayerGrad(map, P.xyz, int(round(P.w)), dx, dy); }
float textureGrad(sampler2DShadow map, vec3 P, vec2 dx, vec2 dy) { return textureCompareLod(map, P.xy, P.z); }
float textureGrad(samplerCubeShadow map, vec4 P, vec3 dx, vec3 dy) { return textureCompareLod(map, P.xyz, P.w); }
float textureGrad(sampler2DArrayShadow map, vec4 P, vec2 dx, vec2 dy) { return textureCompareLod(map, P.xy, int(round(P.z)), P.w); }
""" + integer_reads("textureGrad").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    # Filtered reads with an offset in texels
    Builtin("textureOffset",
        (
            *_offsets(), *(f"{one[:-1]}, float)" for one in _offsets()), *_SHADOW_OFFSETS,
            *integer_reads("textureOffset").signatures,
        ),
        "As texture, with z added to the place in texels, and w to the level.",
        es=300, not_es=("sampler2DArrayShadow,vec4,ivec2",), with_level=Level("textureLodOffset", 2), with_gradients="textureGradOffset",
        componentwise=False, range=texels, constant=(offset_at(2),), uniform_flow=True,
        texts={
            **integer_reads("textureOffset").texts,
            "wgsl-metal": "",
            **{f"wgsl-metal/{params(one)[:-1]}": "{texture}.sample({sampler}, {1}, {2})" for one in _offsets()[:2]},
            **{f"wgsl-metal/{params(one)[:-1]},float": "{texture}.sample({sampler}, {1}, metal::bias({3}), {2})" for one in _offsets()[:2]},
            "glsl/sampler2DArrayShadow,vec4,ivec2": "",
            "tsl": "{texture}.sample({1}).offset({2})",
            **{f"tsl/{params(one)[:-1]},float": "{texture}.sample({1}).offset({2}).bias({3})" for one in _offsets()[:2]},
            "tsl/sampler2DArray,vec3,ivec2": "", "tsl/sampler2DArray,vec3,ivec2,float": "",
            **{f"tsl/{params(shadow)[:-1]}": "" for shadow in _SHADOW_OFFSETS},
            "hlsl": "{bare_texture}.Sample({bare_sampler}, {1}, {2})",
            **{f"hlsl/{params(one)[:-1]},float": "{bare_texture}.SampleBias({bare_sampler}, {1}, {3}, {2})" for one in _offsets()},
            "hlsl-dx9": "",
            "wgsl": "textureSample({texture}, {sampler}, {1}, {2})",
            **{f"wgsl/{params(one)[:-1]},float": "textureSampleBias({texture}, {sampler}, {1}, {3}, {2})" for one in _offsets()[:2]},
            "wgsl/sampler2DArray,vec3,ivec2": "", "wgsl/sampler2DArray,vec3,ivec2,float": "",
            **{f"{language}/{params(shadow)[:-1]}": "" for language in ("hlsl", "wgsl") for shadow in _SHADOW_OFFSETS},
        },
        polyfill="""
vec4 textureOffset(sampler2DArray map, vec3 P, ivec2 offset) { return textureLayerOffset(map, P.xy, int(round(P.z)), offset); }
vec4 textureOffset(sampler2DArray map, vec3 P, ivec2 offset, float bias) { return textureLayerOffset(map, P.xy, int(round(P.z)), offset, bias); }
float textureOffset(sampler2DShadow map, vec3 P, ivec2 offset) { return textureCompareOffset(map, P.xy, P.z, offset); }
float textureOffset(sampler2DShadow map, vec3 P, ivec2 offset, float bias) { return textureCompareOffset(map, P.xy, P.z, offset); }
float textureOffset(sampler2DArrayShadow map, vec4 P, ivec2 offset) { return textureCompareOffset(map, P.xy, int(round(P.z)), P.w, offset); }
""" + integer_reads("textureOffset").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    Builtin("textureLodOffset",
        (
            *_offsets(", float"), "float(sampler2DShadow, vec3, float, ivec2)", *integer_reads("textureLodOffset").signatures,
        ),
        "As textureLod, with w added to the place in texels.",
        es=300, componentwise=False, range=texels, constant=(offset_at(3),), domain="z = 0 for a texture that compares",
        texts={
            **integer_reads("textureLodOffset").texts,
            "wgsl-metal": "",
            **{f"wgsl-metal/{params(one)[:-1]}": "{texture}.sample({sampler}, {1}, metal::level({2}), {3})" for one in _offsets(", float")[:2]},
            "tsl": "{texture}.sample({1}).level({2}).offset({3})", "tsl/sampler2DArray,vec3,float,ivec2": "",
            "tsl/sampler2DShadow,vec3,float,ivec2": "",
            "hlsl": "{bare_texture}.SampleLevel({bare_sampler}, {1}, {2}, {3})", "hlsl-dx9": "",
            "wgsl": "textureSampleLevel({texture}, {sampler}, {1}, {2}, {3})", "wgsl/sampler2DArray,vec3,float,ivec2": "",
            "hlsl/sampler2DShadow,vec3,float,ivec2": "", "wgsl/sampler2DShadow,vec3,float,ivec2": "",
        },
        polyfill="""
vec4 textureLodOffset(sampler2DArray map, vec3 P, float level, ivec2 offset) { return textureLayerLodOffset(map, P.xy, int(round(P.z)), level, offset); }
float textureLodOffset(sampler2DShadow map, vec3 P, float level, ivec2 offset) { return textureCompareLodOffset(map, P.xy, P.z, offset); }
""" + integer_reads("textureLodOffset").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    Builtin("textureGradOffset",
        (
            "vec4(sampler2D, vec2, vec2, vec2, ivec2)", "vec4(sampler3D, vec3, vec3, vec3, ivec3)",
            "vec4(sampler2DArray, vec3, vec2, vec2, ivec2)", *_SHADOW_GRADIENT_OFFSETS,
            *integer_reads("textureGradOffset").signatures,
        ),
        "As textureGrad, with the last argument added to the place in texels.",
        es=300, componentwise=False, range=texels, constant=(offset_at(4),),
        texts={
            **integer_reads("textureGradOffset").texts,
            "wgsl-metal": "",
            "wgsl-metal/sampler2D,vec2,vec2,vec2,ivec2": "{texture}.sample({sampler}, {1}, gradient2d({2}, {3}), {4})",
            "wgsl-metal/sampler3D,vec3,vec3,vec3,ivec3": "{texture}.sample({sampler}, {1}, gradient3d({2}, {3}), {4})",
            "tsl": "", "tsl/sampler2D,vec2,vec2,vec2,ivec2": "{texture}.sample({1}).grad({2}, {3}).offset({4})",
            "hlsl": "{bare_texture}.SampleGrad({bare_sampler}, {1}, {2}, {3}, {4})", "hlsl-dx9": "",
            "wgsl": "textureSampleGrad({texture}, {sampler}, {1}, {2}, {3}, {4})",
            "wgsl/sampler2DArray,vec3,vec2,vec2,ivec2": "",
            **{f"{language}/{params(shadow)[:-1]}": "" for language in ("hlsl", "wgsl") for shadow in _SHADOW_GRADIENT_OFFSETS},
        },
        polyfill="""
vec4 textureGradOffset(sampler2DArray map, vec3 P, vec2 dx, vec2 dy, ivec2 offset) { return textureLayerGradOffset(map, P.xy, int(round(P.z)), dx, dy, offset); }
float textureGradOffset(sampler2DShadow map, vec3 P, vec2 dx, vec2 dy, ivec2 offset) { return textureCompareLodOffset(map, P.xy, P.z, offset); }
float textureGradOffset(sampler2DArrayShadow map, vec4 P, vec2 dx, vec2 dy, ivec2 offset) { return textureCompareLodOffset(map, P.xy, int(round(P.z)), P.w, offset); }
""" + integer_reads("textureGradOffset").polyfill,
        splat=(), kind="fetch", absolute=2.0**-7, clause=EIGHT_BITS,
    ),
    # Texels
    Builtin("texelFetch",
        tuple(
            f"{kind}vec4({kind}sampler{place}, int)"
            for kind in _KINDS for place in ("2D, ivec2", "3D, ivec3", "2DArray, ivec3", "2DMS, ivec2")
        ),
        "The texel at y of level z, unfiltered; of a texture with samples, its sample z.",
        es=300, componentwise=False, range=texels, defined=_exists,
        domain="the texel and the level exist",
        texts={
            "wgsl-metal": "",
            **{f"wgsl-metal/{kind}sampler2D{samples},ivec2,int": "{texture}.read(uint2({1}), uint({2}))" for kind in _KINDS for samples in ("", "MS")},
            **{f"wgsl-metal/{kind}sampler3D,ivec3,int": "{texture}.read(uint3({1}), uint({2}))" for kind in _KINDS},
            "tsl": "{texture}.load({1}).level({2})", **{f"tsl/{kind}sampler2DArray,ivec3,int": "" for kind in _KINDS},
            **{f"tsl/{kind}sampler2DMS,ivec2,int": "" for kind in _KINDS},
            **{f"hlsl/{kind}sampler2DMS,ivec2,int": "{texture}.Load({1}, {2})" for kind in _KINDS},
            "hlsl": "{texture}.Load(int3({1}, {2}))", "hlsl-dx9": "",
            **{f"hlsl/{kind}sampler{dim},ivec3,int": "{texture}.Load(int4({1}, {2}))" for kind in _KINDS for dim in ("3D", "2DArray")},
            "hlsl-macros": "LOAD_TEXTURE{dim}_LOD({texture}, {1}, {2})",
            "wgsl": "textureLoad({texture}, {1}, {2})",
            **{f"wgsl/{kind}sampler2DArray,ivec3,int": "" for kind in _KINDS},
        },
        polyfill="\n".join(
            f"{kind}vec4 texelFetch({kind}sampler2DArray map, ivec3 P, int level) {{ return texelFetchLayer(map, P.xy, P.z, level); }}"
            for kind in _KINDS
        ),
        splat=(), kind="fetch", by_texel=True, ulp=0.0,
    ),
    Builtin("texelFetchOffset",
        tuple(
            f"{kind}vec4({kind}sampler{place}, int, ivec{size})"
            for kind in _KINDS for place, size in (("2D, ivec2", 2), ("3D, ivec3", 3), ("2DArray, ivec3", 2))
        ),
        "As texelFetch, at y + w.",
        es=300, componentwise=False, range=texels, constant=(offset_at(3),), defined=_exists, domain="the texel and the level exist",
        texts={"hlsl": "", "wgsl": "", "tsl": ""},
        polyfill="\n".join(
            f"{kind}vec4 texelFetchOffset({kind}sampler{place} P, int level, ivec{size} offset) {{ return {read}, level); }}"
            for kind in _KINDS
            for place, size, read in (
                ("2D map, ivec2", 2, "texelFetch(map, P + offset"), ("3D map, ivec3", 3, "texelFetch(map, P + offset"),
                ("2DArray map, ivec3", 2, "texelFetchLayer(map, P.xy + offset, P.z"),
            )
        ),
        splat=(), kind="fetch", by_texel=True, ulp=0.0,
    ),
    Builtin("textureGather",
        (
            *(f"vec4({read}{channel})" for read in _GATHERED for channel in ("", ", int")),
            *(f"vec4({read})" for read in _GATHERED_SHADOWS), *integer_gathers("textureGather").signatures,
        ),
        "One channel, the first or z, of the four texels around y at level 0: those at (0, 1), (1, 1), (1, 0), (0, 0) "
        "from the lower left one. Of a texture that compares: 1 where the texel is not below the reference z, else 0.",
        es=310, componentwise=False, range=texels, constant=(channel_at(2),),
        texts={
            **integer_gathers("textureGather").texts,
            "wgsl-metal": "",
            "glsl": "", "tsl": "",
            "hlsl": "{bare_texture}.Gather{channel}({bare_sampler}, {1})", "hlsl-dx9": "",
            "wgsl": "textureGather(0, {texture}, {sampler}, {1})",
            **{f"wgsl/{read.replace(', ', ',')},int": "textureGather({2}, {texture}, {sampler}, {1})" for read in _GATHERED[:2]},
            **{f"wgsl/{read.replace(', ', ',')}{channel}": "" for read in _GATHERED[2:] for channel in ("", ",int")},
            **{f"hlsl/{read.replace(', ', ',')}": "{texture}.GatherCmp({sampler}, {1}, {2})" for read in _GATHERED_SHADOWS[1:]},
            # glslang fails, without a message, where there is no offset
            "hlsl/sampler2DShadow,vec2,float": "{texture}.GatherCmp({sampler}, {1}, {2}, int2(0, 0))",
            **{f"wgsl/{read.replace(', ', ',')}": "textureGatherCompare({texture}, {sampler}, {1}, {2})" for read in _GATHERED_SHADOWS[:2]},
            "wgsl/sampler2DArrayShadow,vec3,float": "",
        },
        polyfill="""
vec4 textureGather(sampler2D map, vec2 P) { return textureGatherOffset(map, P, ivec2(0)); }
vec4 textureGather(sampler2D map, vec2 P, int channel) { return textureGatherOffset(map, P, ivec2(0), channel); }
vec4 textureGather(sampler2DArray map, vec3 P) { return textureGatherLayer(map, P.xy, int(round(P.z))); }
vec4 textureGather(sampler2DArray map, vec3 P, int channel) { return textureGatherLayer(map, P.xy, int(round(P.z)), channel); }
vec4 textureGather(samplerCubeArray map, vec4 P) { return textureGatherLayer(map, P.xyz, int(round(P.w))); }
vec4 textureGather(samplerCubeArray map, vec4 P, int channel) { return textureGatherLayer(map, P.xyz, int(round(P.w)), channel); }
vec4 textureGather(sampler2DShadow map, vec2 P, float reference) { return textureGatherOffset(map, P, reference, ivec2(0)); }
vec4 textureGather(sampler2DArrayShadow map, vec3 P, float reference) { return textureGatherLayer(map, P.xy, int(round(P.z)), reference); }
""" + integer_gathers("textureGather").polyfill,
        splat=(), kind="fetch", ulp=0.0,
    ),
    Builtin("textureGatherOffset",
        (
            *(f"vec4({read}, ivec2{channel})" for read in ("sampler2D, vec2", "sampler2DArray, vec3") for channel in ("", ", int")),
            "vec4(sampler2DShadow, vec2, float, ivec2)", "vec4(sampler2DArrayShadow, vec3, float, ivec2)",
            *integer_gathers("textureGatherOffset").signatures,
        ),
        "As textureGather, with an offset added to the places in texels: z, before the channel; after the reference of a "
        "texture that compares.",
        es=310, componentwise=False, range=texels, constant=(offset_at(2), offset_at(3), channel_at(3)),
        texts={
            **integer_gathers("textureGatherOffset").texts,
            "wgsl-metal": "",
            "glsl": "", "tsl": "",
            "hlsl": "{bare_texture}.Gather{channel}({bare_sampler}, {1}, {2})", "hlsl-dx9": "",
            "hlsl/sampler2DShadow,vec2,float,ivec2": "{texture}.GatherCmp({sampler}, {1}, {2}, {3})",
            "hlsl/sampler2DArrayShadow,vec3,float,ivec2": "{texture}.GatherCmp({sampler}, {1}, {2}, {3})",
            "wgsl": "textureGather(0, {texture}, {sampler}, {1}, {2})",
            "wgsl/sampler2D,vec2,ivec2,int": "textureGather({3}, {texture}, {sampler}, {1}, {2})",
            "wgsl/sampler2DShadow,vec2,float,ivec2": "textureGatherCompare({texture}, {sampler}, {1}, {2}, {3})",
            "wgsl/sampler2DArray,vec3,ivec2": "", "wgsl/sampler2DArray,vec3,ivec2,int": "",
            "wgsl/sampler2DArrayShadow,vec3,float,ivec2": "",
        },
        polyfill="vec4 textureGatherOffset".join((
            "",
            gather_polyfill("sampler2D map, vec2 P", "textureSize(map, 0)", "textureLod(map, {}, 0.0)"),
            gather_polyfill("sampler2D map, vec2 P", "textureSize(map, 0)", "textureLod(map, {}, 0.0)", channel=True),
            gather_polyfill("sampler2DShadow map, vec2 P, float reference", "textureSize(map, 0)", "textureCompareLod(map, {}, reference)"),
            "(sampler2DArray map, vec3 P, ivec2 offset) { return textureGatherLayerOffset(map, P.xy, int(round(P.z)), offset); }\n",
            "(sampler2DArray map, vec3 P, ivec2 offset, int channel)"
            " { return textureGatherLayerOffset(map, P.xy, int(round(P.z)), offset, channel); }\n",
            "(sampler2DArrayShadow map, vec3 P, float reference, ivec2 offset)"
            " { return textureGatherLayerOffset(map, P.xy, int(round(P.z)), reference, offset); }\n",
        )) + integer_gathers("textureGatherOffset").polyfill,
        splat=(), kind="fetch", absolute=2.0**-12, clause=BY_READS,
    ),
)
