"""The texts of reads with offsets in the targets; a part of texts_of_builtins.py."""

from __future__ import annotations

OFFSETS = {
    "textureOffset(layers, x3, ivec2(1, -2))": {
        "glsl": "textureOffset(layers, x3, ivec2(1, -2))",
        "hlsl": "layers.Sample(layers_sampler, x3, int2(1, -2))",
        "wgsl": "textureSample(layers, layers_sampler, x3.xy, i32(round(x3.z)), vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureOffset(layers, x3, vec(1, -2))",
    },
    "textureOffset(layers, x3, ivec2(1, -2), y)": {
        "glsl": "textureOffset(layers, x3, ivec2(1, -2), y)",
        "hlsl": "layers.SampleBias(layers_sampler, x3, y, int2(1, -2))",
        "wgsl": "textureSampleBias(layers, layers_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureOffset(layers, x3, vec(1, -2), y)",
    },
    "textureOffset(shade, x3, ivec2(1, -2))": {
        "glsl": "textureOffset(shade, x3, ivec2(1, -2))",
        "hlsl": "shade.SampleCmp(shade_sampler, x3.xy, x3.z, int2(1, -2))",
        "wgsl": "textureSampleCompare(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureOffset(shade, x3, vec(1, -2))",
    },
    "textureOffset(shades, x4, ivec2(1, -2))": {
        "glsl": "textureGradOffset(shades, vec4(x4.xy, float(int(roundEven(x4.z))), x4.w), vec2(0.0), vec2(0.0), ivec2(1, -2))",
        "hlsl": "shades.SampleCmp(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w, int2(1, -2))",
        "wgsl": "textureSampleCompare(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureOffset(shades, x4, vec(1, -2))",
    },
    "textureLodOffset(layers, x3, y, ivec2(1, -2))": {
        "glsl": "textureLodOffset(layers, x3, y, ivec2(1, -2))",
        "hlsl": "layers.SampleLevel(layers_sampler, x3, y, int2(1, -2))",
        "wgsl": "textureSampleLevel(layers, layers_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureLodOffset(layers, x3, y, vec(1, -2))",
    },
    "textureLodOffset(shade, x3, y, ivec2(1, -2))": {
        "glsl": "textureLodOffset(shade, x3, y, ivec2(1, -2))",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z, int2(1, -2))",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureLodOffset(shade, x3, y, vec(1, -2))",
    },
    "textureGradOffset(layers, x3, x2, y2, ivec2(1, -2))": {
        "glsl": "textureGradOffset(layers, x3, x2, y2, ivec2(1, -2))",
        "hlsl": "layers.SampleGrad(layers_sampler, x3, x2, y2, int2(1, -2))",
        "wgsl": "textureSampleGrad(layers, layers_sampler, x3.xy, i32(round(x3.z)), x2, y2, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureGradOffset(layers, x3, x2, y2, vec(1, -2))",
    },
    "textureGradOffset(shade, x3, x2, y2, ivec2(1, -2))": {
        "glsl": "textureGradOffset(shade, x3, x2, y2, ivec2(1, -2))",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z, int2(1, -2))",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureGradOffset(shade, x3, x2, y2, vec(1, -2))",
    },
    "textureGradOffset(shades, x4, x2, y2, ivec2(1, -2))": {
        "glsl": "textureGradOffset(shades, x4, x2, y2, ivec2(1, -2))",
        "hlsl": "shades.SampleCmpLevelZero(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w, int2(1, -2))",
        "wgsl": "textureSampleCompareLevel(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureGradOffset(shades, x4, x2, y2, vec(1, -2))",
    },
    "texelFetchOffset(layers, i3, i, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(layers, i3, i, ivec2(1, -2))",
        "hlsl": "layers.Load(int4(i3.xy + int2(1, -2), i3.z, i))",
        "wgsl": "textureLoad(layers, i3.xy + vec2i(1, -2), i3.z, i)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "texelFetchOffset(layers, i3, i, vec(1, -2))",
    },
    "texelFetchOffset(ints, i2, i, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(ints, i2, i, ivec2(1, -2))",
        "hlsl": "ints.Load(int3(i2 + int2(1, -2), i))",
        "wgsl": "textureLoad(ints, i2 + vec2i(1, -2), i)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no isampler2D",
        "numpy": "texelFetchOffset(ints, i2, i, vec(1, -2))",
    },
    "texelFetchOffset(intvolume, i3, i, ivec3(1, -2, 0))": {
        "glsl": "texelFetchOffset(intvolume, i3, i, ivec3(1, -2, 0))",
        "hlsl": "intvolume.Load(int4(i3 + int3(1, -2, 0), i))",
        "wgsl": "textureLoad(intvolume, i3 + vec3i(1, -2, 0), i)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no isampler3D",
        "numpy": "texelFetchOffset(intvolume, i3, i, vec(1, -2, 0))",
    },
    "texelFetchOffset(intlayers, i3, i, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(intlayers, i3, i, ivec2(1, -2))",
        "hlsl": "intlayers.Load(int4(i3.xy + int2(1, -2), i3.z, i))",
        "wgsl": "textureLoad(intlayers, i3.xy + vec2i(1, -2), i3.z, i)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no isampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no isampler2DArray",
        "numpy": "texelFetchOffset(intlayers, i3, i, vec(1, -2))",
    },
    "texelFetchOffset(uints, i2, i, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(uints, i2, i, ivec2(1, -2))",
        "hlsl": "uints.Load(int3(i2 + int2(1, -2), i))",
        "wgsl": "textureLoad(uints, i2 + vec2i(1, -2), i)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no usampler2D",
        "numpy": "texelFetchOffset(uints, i2, i, vec(1, -2))",
    },
    "texelFetchOffset(uintvolume, i3, i, ivec3(1, -2, 0))": {
        "glsl": "texelFetchOffset(uintvolume, i3, i, ivec3(1, -2, 0))",
        "hlsl": "uintvolume.Load(int4(i3 + int3(1, -2, 0), i))",
        "wgsl": "textureLoad(uintvolume, i3 + vec3i(1, -2, 0), i)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no usampler3D",
        "numpy": "texelFetchOffset(uintvolume, i3, i, vec(1, -2, 0))",
    },
    "texelFetchOffset(uintlayers, i3, i, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(uintlayers, i3, i, ivec2(1, -2))",
        "hlsl": "uintlayers.Load(int4(i3.xy + int2(1, -2), i3.z, i))",
        "wgsl": "textureLoad(uintlayers, i3.xy + vec2i(1, -2), i3.z, i)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no usampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no usampler2DArray",
        "numpy": "texelFetchOffset(uintlayers, i3, i, vec(1, -2))",
    },
    "textureLayerOffset(layers, x2, i, ivec2(1, -2))": {
        "glsl": "textureOffset(layers, vec3(x2, float(i)), ivec2(1, -2))",
        "hlsl": "layers.Sample(layers_sampler, float3(x2, float(i)), int2(1, -2))",
        "wgsl": "textureSample(layers, layers_sampler, x2, i, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureLayerOffset(layers, x2, i, vec(1, -2))",
    },
    "textureLayerOffset(layers, x2, i, ivec2(1, -2), y)": {
        "glsl": "textureOffset(layers, vec3(x2, float(i)), ivec2(1, -2), y)",
        "hlsl": "layers.SampleBias(layers_sampler, float3(x2, float(i)), y, int2(1, -2))",
        "wgsl": "textureSampleBias(layers, layers_sampler, x2, i, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureLayerOffset(layers, x2, i, vec(1, -2), y)",
    },
    "textureLayerLodOffset(layers, x2, i, y, ivec2(1, -2))": {
        "glsl": "textureLodOffset(layers, vec3(x2, float(i)), y, ivec2(1, -2))",
        "hlsl": "layers.SampleLevel(layers_sampler, float3(x2, float(i)), y, int2(1, -2))",
        "wgsl": "textureSampleLevel(layers, layers_sampler, x2, i, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureLayerLodOffset(layers, x2, i, y, vec(1, -2))",
    },
    "textureLayerGradOffset(layers, x2, i, y2, z2, ivec2(1, -2))": {
        "glsl": "textureGradOffset(layers, vec3(x2, float(i)), y2, z2, ivec2(1, -2))",
        "hlsl": "layers.SampleGrad(layers_sampler, float3(x2, float(i)), y2, z2, int2(1, -2))",
        "wgsl": "textureSampleGrad(layers, layers_sampler, x2, i, y2, z2, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureLayerGradOffset(layers, x2, i, y2, z2, vec(1, -2))",
    },
    "textureCompareOffset(shade, x2, y, ivec2(1, -2))": {
        "glsl": "textureOffset(shade, vec3(x2, y), ivec2(1, -2))",
        "hlsl": "shade.SampleCmp(shade_sampler, x2, y, int2(1, -2))",
        "wgsl": "textureSampleCompare(shade, shade_sampler, x2, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureCompareOffset(shade, x2, y, vec(1, -2))",
    },
    "textureCompareOffset(shades, x2, i, y, ivec2(1, -2))": {
        "glsl": "textureGradOffset(shades, vec4(x2, float(i), y), vec2(0.0), vec2(0.0), ivec2(1, -2))",
        "hlsl": "shades.SampleCmp(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
        "wgsl": "textureSampleCompare(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureCompareOffset(shades, x2, i, y, vec(1, -2))",
    },
    "textureCompareLodOffset(shade, x2, y, ivec2(1, -2))": {
        "glsl": "textureLodOffset(shade, vec3(x2, y), 0.0, ivec2(1, -2))",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x2, y, int2(1, -2))",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x2, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureCompareLodOffset(shade, x2, y, vec(1, -2))",
    },
    "textureCompareLodOffset(shades, x2, i, y, ivec2(1, -2))": {
        "glsl": "textureGradOffset(shades, vec4(x2, float(i), y), vec2(0.0), vec2(0.0), ivec2(1, -2))",
        "hlsl": "shades.SampleCmpLevelZero(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
        "wgsl": "textureSampleCompareLevel(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureCompareLodOffset(shades, x2, i, y, vec(1, -2))",
    },
    "textureGatherOffset(layers, x3, ivec2(1, -2))": {
        "glsl": """
            vec4 textureGatherLayerOffset(sampler2DArray map, vec2 P, int layer, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return vec4(textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0).r,
                    textureLod(map, vec3(high, float(layer)), 0.0).r,
                    textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0).r,
                    textureLod(map, vec3(low, float(layer)), 0.0).r);
            }

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(1, -2));
        """,
        "hlsl": "layers.GatherRed(layers_sampler, x3, int2(1, -2))",
        "wgsl": "textureGather(0, layers, layers_sampler, x3.xy, i32(round(x3.z)), vec2i(1, -2))",
        "glsl-es": """
            vec4 textureGatherLayerOffset(highp sampler2DArray map, vec2 P, int layer, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return vec4(textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0).r,
                    textureLod(map, vec3(high, float(layer)), 0.0).r,
                    textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0).r,
                    textureLod(map, vec3(low, float(layer)), 0.0).r);
            }

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(1, -2));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureGatherOffset(layers, x3, vec(1, -2))",
    },
    "textureGatherOffset(layers, x3, ivec2(1, -2), 2)": {
        "glsl": """
            vec4 textureGatherLayerOffset(sampler2DArray map, vec2 P, int layer, ivec2 offset, int channel) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                vec4 a = textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0);
                vec4 b = textureLod(map, vec3(high, float(layer)), 0.0);
                vec4 c = textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0);
                vec4 d = textureLod(map, vec3(low, float(layer)), 0.0);
                return vec4(a[channel], b[channel], c[channel], d[channel]);
            }

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(1, -2), 2);
        """,
        "hlsl": "layers.GatherBlue(layers_sampler, x3, int2(1, -2))",
        "wgsl": "textureGather(2, layers, layers_sampler, x3.xy, i32(round(x3.z)), vec2i(1, -2))",
        "glsl-es": """
            vec4 textureGatherLayerOffset(highp sampler2DArray map, vec2 P, int layer, ivec2 offset, int channel) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                vec4 a = textureLod(map, vec3(vec2(low.x, high.y), float(layer)), 0.0);
                vec4 b = textureLod(map, vec3(high, float(layer)), 0.0);
                vec4 c = textureLod(map, vec3(vec2(high.x, low.y), float(layer)), 0.0);
                vec4 d = textureLod(map, vec3(low, float(layer)), 0.0);
                return vec4(a[channel], b[channel], c[channel], d[channel]);
            }

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(1, -2), 2);
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureGatherOffset(layers, x3, vec(1, -2), 2)",
    },
    "textureGatherOffset(shade, x2, y, ivec2(1, -2))": {
        "glsl": """
            vec4 textureGatherOffset_(sampler2DShadow map, vec2 P, float reference, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return roundEven(vec4(textureLod(map, vec3(vec2(low.x, high.y), reference), 0.0),
                    textureLod(map, vec3(high, reference), 0.0),
                    textureLod(map, vec3(vec2(high.x, low.y), reference), 0.0),
                    textureLod(map, vec3(low, reference), 0.0)));
            }

            return textureGatherOffset_(shade, x2, y, ivec2(1, -2));
        """,
        "hlsl": "shade.GatherCmp(shade_sampler, x2, y, int2(1, -2))",
        "wgsl": "textureGatherCompare(shade, shade_sampler, x2, y, vec2i(1, -2))",
        "glsl-es": """
            vec4 textureGatherOffset_(highp sampler2DShadow map, vec2 P, float reference, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return roundEven(vec4(textureLod(map, vec3(vec2(low.x, high.y), reference), 0.0),
                    textureLod(map, vec3(high, reference), 0.0),
                    textureLod(map, vec3(vec2(high.x, low.y), reference), 0.0),
                    textureLod(map, vec3(low, reference), 0.0)));
            }

            return textureGatherOffset_(shade, x2, y, ivec2(1, -2));
        """,
        "dx9": "error: this target has no textureGatherOffset (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
        "numpy": "textureGatherOffset(shade, x2, y, vec(1, -2))",
    },
    "textureGatherOffset(shades, x3, y, ivec2(1, -2))": {
        "glsl": """
            vec4 textureGatherLayerOffset(sampler2DArrayShadow map, vec2 P, int layer, float reference, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return roundEven(vec4(textureGrad(map, vec4(vec2(low.x, high.y), float(layer), reference), vec2(0.0),
                    vec2(0.0)), textureGrad(map, vec4(high, float(layer), reference), vec2(0.0), vec2(0.0)),
                    textureGrad(map, vec4(vec2(high.x, low.y), float(layer), reference), vec2(0.0), vec2(0.0)),
                    textureGrad(map, vec4(low, float(layer), reference), vec2(0.0), vec2(0.0))));
            }

            return textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(1, -2));
        """,
        "hlsl": "shades.GatherCmp(shades_sampler, x3, y, int2(1, -2))",
        "wgsl": "textureGatherCompare(shades, shades_sampler, x3.xy, i32(round(x3.z)), y, vec2i(1, -2))",
        "glsl-es": """
            vec4 textureGatherLayerOffset(highp sampler2DArrayShadow map, vec2 P, int layer, float reference,
                ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0).xy);
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return roundEven(vec4(textureGrad(map, vec4(vec2(low.x, high.y), float(layer), reference), vec2(0.0),
                    vec2(0.0)), textureGrad(map, vec4(high, float(layer), reference), vec2(0.0), vec2(0.0)),
                    textureGrad(map, vec4(vec2(high.x, low.y), float(layer), reference), vec2(0.0), vec2(0.0)),
                    textureGrad(map, vec4(low, float(layer), reference), vec2(0.0), vec2(0.0))));
            }

            return textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(1, -2));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureGatherOffset(shades, x3, y, vec(1, -2))",
    },
}
