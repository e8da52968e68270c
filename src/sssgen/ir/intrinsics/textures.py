"""Reads of textures."""

from __future__ import annotations

from .table import Builtin

_SAMPLE = ("vec4(sampler2D, vec2", "vec4(sampler3D, vec3", "vec4(samplerCube, vec3")
_EIGHT_BITS = "D3D: filter weights of 8 bits; WGSL, Vulkan, GLSL: no bound"

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("unpackNormal", ("vec3(vec4)",),
        "The tangent-space normal of a normal map's texel, y up. Unity may pack it when it imports the map.",
        range="whole: normal_texel(x)",
        size="max(2.0 * abs(x[:3]), 1.0)",
        texts={"glsl": "", "hlsl": "", "wgsl": "", "hlsl-dx9": "UnpackNormal", "hlsl-macros": "UnpackNormal"},
        polyfill="vec3 unpackNormal(vec4 texel) { return texel.xyz * 2.0 - 1.0; }", cost=2,
        vectors=(
            (((0.5, 0.5, 1.0, 1.0),), (0.0, 0.0, 1.0)), (((1.0, 0.0, 0.5, 0.0),), (1.0, -1.0, 0.0)),
            (((0.75, 0.25, 1.0, 1.0),), (0.5, -0.5, 1.0)),
        ),
    ),
    Builtin("textureSize", ("ivec2(sampler2D, int)", "ivec3(sampler3D, int)", "ivec2(samplerCube, int)"),
        "Size in texels of level y. HLSL has it only as a statement, so it is refused there.",
        range="hull(0, 65536)", domain="the level exists", texts={"hlsl": "", "wgsl": "{type}(textureDimensions({texture}, {1}))"},
        splat=(), kind="fetch",
    ),
    Builtin("texture", (*(f"{read})" for read in _SAMPLE), *(f"{read}, float)" for read in _SAMPLE)),
        "Filtered texture read; the level comes from screen-space derivatives, with z added to it.",
        range="whole: texels(x)",
        domain="uniform control flow",
        texts={
            "hlsl": "{texture}.Sample({sampler}, {1})",
            "hlsl/sampler2D,vec2,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl/sampler3D,vec3,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl/samplerCube,vec3,float": "{texture}.SampleBias({sampler}, {1}, {2})",
            "hlsl-dx9": "tex{dim}({texture}, {1})",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dbias({texture}, float4({1}, 0.0, {2}))",
            "hlsl-dx9/sampler3D,vec3,float": "tex3Dbias({texture}, float4({1}, {2}))",
            "hlsl-dx9/samplerCube,vec3,float": "texCUBEbias({texture}, float4({1}, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}({texture}, {sampler}, {1})",
            "hlsl-macros/sampler2D,vec2,float": "SAMPLE_TEXTURE2D_BIAS({texture}, {sampler}, {1}, {2})",
            "hlsl-macros/sampler3D,vec3,float": "{bare_texture}.SampleBias({bare_sampler}, {1}, {2})",
            "hlsl-macros/samplerCube,vec3,float": "SAMPLE_TEXTURECUBE_BIAS({texture}, {sampler}, {1}, {2})",
            "wgsl": "textureSample({texture}, {sampler}, {1})",
            "wgsl/sampler2D,vec2,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
            "wgsl/sampler3D,vec3,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
            "wgsl/samplerCube,vec3,float": "textureSampleBias({texture}, {sampler}, {1}, {2})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("textureLod", tuple(f"{read}, float)" for read in _SAMPLE), "Filtered texture read at level z.",
        range="whole: texels(x)",
        texts={
            "hlsl": "{texture}.SampleLevel({sampler}, {1}, {2})",
            "hlsl-dx9": "tex{dim}lod({texture}, float4({1}, {2}))",
            "hlsl-dx9/sampler2D,vec2,float": "tex2Dlod({texture}, float4({1}, 0.0, {2}))",
            "hlsl-macros": "SAMPLE_TEXTURE{dim}_LOD({texture}, {sampler}, {1}, {2})",
            "wgsl": "textureSampleLevel({texture}, {sampler}, {1}, {2})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("textureGrad",
        ("vec4(sampler2D, vec2, vec2, vec2)", *(f"{read}, vec3, vec3)" for read in _SAMPLE[1:])),
        "Filtered texture read; the level comes from the given derivatives of the coordinate along screen x and y.",
        range="whole: texels(x)",
        texts={
            "hlsl": "{texture}.SampleGrad({sampler}, {1}, {2}, {3})",
            "hlsl-dx9": "tex{dim}grad({texture}, {1}, {2}, {3})",
            "hlsl-macros": "{bare_texture}.SampleGrad({bare_sampler}, {1}, {2}, {3})",
            "hlsl-macros/sampler2D,vec2,vec2,vec2": "SAMPLE_TEXTURE2D_GRAD({texture}, {sampler}, {1}, {2}, {3})",
            "wgsl": "textureSampleGrad({texture}, {sampler}, {1}, {2}, {3})",
        },
        splat=(), kind="fetch", absolute=2.0**-7, clause=_EIGHT_BITS,
    ),
    Builtin("texelFetch", ("vec4(sampler2D, ivec2, int)", "vec4(sampler3D, ivec3, int)"),
        "The texel at y of level z, unfiltered.",
        range="whole: texels(x)",
        domain="the texel and the level exist",
        texts={
            "hlsl": "{texture}.Load(int3({1}, {2}))",
            "hlsl/sampler3D,ivec3,int": "{texture}.Load(int4({1}, {2}))", "hlsl-dx9": "",
            "hlsl-macros": "LOAD_TEXTURE{dim}_LOD({texture}, {1}, {2})",
            "wgsl": "textureLoad({texture}, {1}, {2})",
        },
        splat=(), kind="fetch", ulp=0.0,
    ),
)
