"""The texts of reads with offsets in the targets; a part of texts_of_builtins.py. Those of gathers are in texts_of_gathers.py."""

from __future__ import annotations

from typing import NamedTuple

from validate import SAMPLERS


class Read(NamedTuple):
    """A call, and what it is in each language."""

    call: str
    hlsl: str
    wgsl: str
    glsl: str = ""
    """'' means as written in `call`."""


ROWS = (
    Read("textureOffset(layers, x3, ivec2(1, -2))",
         "layers.Sample(layers_sampler, x3, int2(1, -2))",
         "textureSample(layers, layers_sampler, x3.xy, i32(round(x3.z)), vec2i(1, -2))"),
    Read("textureOffset(layers, x3, ivec2(1, -2), y)",
         "layers.SampleBias(layers_sampler, x3, y, int2(1, -2))",
         "textureSampleBias(layers, layers_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))"),
    Read("textureOffset(shade, x3, ivec2(1, -2))",
         "shade.SampleCmp(shade_sampler, x3.xy, x3.z, int2(1, -2))",
         "textureSampleCompare(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))"),
    Read("textureOffset(shade, x3, ivec2(1, -2), y)",
         "shade.SampleCmp(shade_sampler, x3.xy, x3.z, int2(1, -2))",
         "textureSampleCompare(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))"),
    Read("textureOffset(shades, x4, ivec2(1, -2))",
         "shades.SampleCmp(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w, int2(1, -2))",
         "textureSampleCompare(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w, vec2i(1, -2))",
         "textureGradOffset(shades, vec4(x4.xy, float(int(roundEven(x4.z))), x4.w), vec2(0.0), vec2(0.0), ivec2(1, -2))"),
    Read("textureLodOffset(layers, x3, y, ivec2(1, -2))",
         "layers.SampleLevel(layers_sampler, x3, y, int2(1, -2))",
         "textureSampleLevel(layers, layers_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))"),
    Read("textureLodOffset(shade, x3, y, ivec2(1, -2))",
         "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z, int2(1, -2))",
         "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))"),
    Read("textureGradOffset(layers, x3, x2, y2, ivec2(1, -2))",
         "layers.SampleGrad(layers_sampler, x3, x2, y2, int2(1, -2))",
         "textureSampleGrad(layers, layers_sampler, x3.xy, i32(round(x3.z)), x2, y2, vec2i(1, -2))"),
    Read("textureGradOffset(shade, x3, x2, y2, ivec2(1, -2))",
         "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z, int2(1, -2))",
         "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))"),
    Read("textureGradOffset(shades, x4, x2, y2, ivec2(1, -2))",
         "shades.SampleCmpLevelZero(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w, int2(1, -2))",
         "textureSampleCompareLevel(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w, vec2i(1, -2))"),
    # The layer and the reference as arguments of their own
    Read("textureLayerOffset(layers, x2, i, ivec2(1, -2))",
         "layers.Sample(layers_sampler, float3(x2, float(i)), int2(1, -2))",
         "textureSample(layers, layers_sampler, x2, i, vec2i(1, -2))",
         "textureOffset(layers, vec3(x2, float(i)), ivec2(1, -2))"),
    Read("textureLayerOffset(layers, x2, i, ivec2(1, -2), y)",
         "layers.SampleBias(layers_sampler, float3(x2, float(i)), y, int2(1, -2))",
         "textureSampleBias(layers, layers_sampler, x2, i, y, vec2i(1, -2))",
         "textureOffset(layers, vec3(x2, float(i)), ivec2(1, -2), y)"),
    Read("textureLayerLodOffset(layers, x2, i, y, ivec2(1, -2))",
         "layers.SampleLevel(layers_sampler, float3(x2, float(i)), y, int2(1, -2))",
         "textureSampleLevel(layers, layers_sampler, x2, i, y, vec2i(1, -2))",
         "textureLodOffset(layers, vec3(x2, float(i)), y, ivec2(1, -2))"),
    Read("textureLayerGradOffset(layers, x2, i, y2, z2, ivec2(1, -2))",
         "layers.SampleGrad(layers_sampler, float3(x2, float(i)), y2, z2, int2(1, -2))",
         "textureSampleGrad(layers, layers_sampler, x2, i, y2, z2, vec2i(1, -2))",
         "textureGradOffset(layers, vec3(x2, float(i)), y2, z2, ivec2(1, -2))"),
    Read("textureCompareOffset(shade, x2, y, ivec2(1, -2))",
         "shade.SampleCmp(shade_sampler, x2, y, int2(1, -2))",
         "textureSampleCompare(shade, shade_sampler, x2, y, vec2i(1, -2))",
         "textureOffset(shade, vec3(x2, y), ivec2(1, -2))"),
    Read("textureCompareOffset(shades, x2, i, y, ivec2(1, -2))",
         "shades.SampleCmp(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
         "textureSampleCompare(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
         "textureGradOffset(shades, vec4(x2, float(i), y), vec2(0.0), vec2(0.0), ivec2(1, -2))"),
    Read("textureCompareLodOffset(shade, x2, y, ivec2(1, -2))",
         "shade.SampleCmpLevelZero(shade_sampler, x2, y, int2(1, -2))",
         "textureSampleCompareLevel(shade, shade_sampler, x2, y, vec2i(1, -2))",
         "textureLodOffset(shade, vec3(x2, y), 0.0, ivec2(1, -2))"),
    Read("textureCompareLodOffset(shades, x2, i, y, ivec2(1, -2))",
         "shades.SampleCmpLevelZero(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
         "textureSampleCompareLevel(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
         "textureGradOffset(shades, vec4(x2, float(i), y), vec2(0.0), vec2(0.0), ivec2(1, -2))"),
    # Texels
    *(Read(f"texelFetchOffset({map}, i2, i, ivec2(1, -2))",
           f"{map}.Load(int3(i2 + int2(1, -2), i))",
           f"textureLoad({map}, i2 + vec2i(1, -2), i)")
      for map in ("ints", "uints")),
    *(Read(f"texelFetchOffset({map}, i3, i, ivec3(1, -2, 0))",
           f"{map}.Load(int4(i3 + int3(1, -2, 0), i))",
           f"textureLoad({map}, i3 + vec3i(1, -2, 0), i)")
      for map in ("intvolume", "uintvolume")),
    *(Read(f"texelFetchOffset({map}, i3, i, ivec2(1, -2))",
           f"{map}.Load(int4(i3.xy + int2(1, -2), i3.z, i))",
           f"textureLoad({map}, i3.xy + vec2i(1, -2), i3.z, i)")
      for map in ("layers", "intlayers", "uintlayers")),
)  # fmt: skip


def others(call: str) -> dict[str, str]:
    """The call in NumPy, and what Unity reports: it has no such texture; the built-in pipeline reports a gather or a fetch
    first, except of a texture with layers."""
    name, _, rest = call.partition("(")
    type_ = SAMPLERS[rest.partition(",")[0]]
    builtin = "Array" not in type_ and name.startswith(("textureGather", "texelFetch"))
    dx9 = (
        f"this target has no {name} (unity-builtin)"
        if builtin
        else f"Unity, built-in pipeline (surface shader) has no {type_}"
    )
    return {
        "dx9": f"error: {dx9}",
        "urp": f"error: Unity, Universal Render Pipeline has no {type_}",
        "numpy": call.replace("ivec2(", "vec(").replace("ivec3(", "vec("),
    }


OFFSETS = {
    read.call: {"glsl": read.glsl or read.call, "hlsl": read.hlsl, "wgsl": read.wgsl, **others(read.call)}
    for read in ROWS
}
