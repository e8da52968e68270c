"""The texts of gathers of layers, cubes and comparing textures in the targets; a part of texts_of_builtins.py."""

from __future__ import annotations

GATHERS = {
    "textureGather(cube, x3)": {
        "glsl": "error: this target has no textureGather (glsl-330)",
        "hlsl": "cube.GatherRed(cube_sampler, x3)",
        "wgsl": "textureGather(0, cube, cube_sampler, x3)",
        "glsl-es": "error: this target has no textureGather (glsl-es-300)",
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "cube.GatherRed(samplercube, x3)",
    },
    "textureGather(cube, x3, 2)": {
        "glsl": "error: this target has no textureGather (glsl-330)",
        "hlsl": "cube.GatherBlue(cube_sampler, x3)",
        "wgsl": "textureGather(2, cube, cube_sampler, x3)",
        "glsl-es": "error: this target has no textureGather (glsl-es-300)",
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "cube.GatherBlue(samplercube, x3)",
    },
    "textureGather(layers, x3)": {
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

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(0));
        """,
        "hlsl": "layers.GatherRed(layers_sampler, x3)",
        "wgsl": "textureGather(0, layers, layers_sampler, x3.xy, i32(round(x3.z)))",
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

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(0));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureGather(layers, x3, 2)": {
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

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(0), 2);
        """,
        "hlsl": "layers.GatherBlue(layers_sampler, x3)",
        "wgsl": "textureGather(2, layers, layers_sampler, x3.xy, i32(round(x3.z)))",
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

            return textureGatherLayerOffset(layers, x3.xy, int(roundEven(x3.z)), ivec2(0), 2);
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureGather(cubes, x4)": {
        "glsl": "error: this target has no textureGather (glsl-330)",
        "hlsl": "cubes.GatherRed(cubes_sampler, x4)",
        "wgsl": "textureGather(0, cubes, cubes_sampler, x4.xyz, i32(round(x4.w)))",
        "glsl-es": "error: this target has no textureGather (glsl-es-300)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureGather(cubes, x4, 2)": {
        "glsl": "error: this target has no textureGather (glsl-330)",
        "hlsl": "cubes.GatherBlue(cubes_sampler, x4)",
        "wgsl": "textureGather(2, cubes, cubes_sampler, x4.xyz, i32(round(x4.w)))",
        "glsl-es": "error: this target has no textureGather (glsl-es-300)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureGather(shade, x2, y)": {
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

            return textureGatherOffset_(shade, x2, y, ivec2(0));
        """,
        "hlsl": "shade.GatherCmp(shade_sampler, x2, y, int2(0, 0))",
        "wgsl": "textureGatherCompare(shade, shade_sampler, x2, y)",
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

            return textureGatherOffset_(shade, x2, y, ivec2(0));
        """,
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "textureGather(shadecube, x3, y)": {
        "glsl": "error: this target has no textureGather (glsl-330)",
        "hlsl": "shadecube.GatherCmp(shadecube_sampler, x3, y)",
        "wgsl": "textureGatherCompare(shadecube, shadecube_sampler, x3, y)",
        "glsl-es": "error: this target has no textureGather (glsl-es-300)",
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    "textureGather(shades, x3, y)": {
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

            return textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(0));
        """,
        "hlsl": "shades.GatherCmp(shades_sampler, x3, y)",
        "wgsl": "textureGatherCompare(shades, shades_sampler, x3.xy, i32(round(x3.z)), y)",
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

            return textureGatherLayerOffset(shades, x3.xy, int(roundEven(x3.z)), y, ivec2(0));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
    "textureGatherLayer(layers, x2, i)": {
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(0));
        """,
        "hlsl": "layers.GatherRed(layers_sampler, float3(x2, float(i)))",
        "wgsl": "textureGather(0, layers, layers_sampler, x2, i)",
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(0));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureGatherLayer(layers, x2, i, 2)": {
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(0), 2);
        """,
        "hlsl": "layers.GatherBlue(layers_sampler, float3(x2, float(i)))",
        "wgsl": "textureGather(2, layers, layers_sampler, x2, i)",
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(0), 2);
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureGatherLayer(cubes, x3, i)": {
        "glsl": "error: this target has no textureGatherLayer (glsl-330)",
        "hlsl": "cubes.GatherRed(cubes_sampler, float4(x3, float(i)))",
        "wgsl": "textureGather(0, cubes, cubes_sampler, x3, i)",
        "glsl-es": "error: this target has no textureGatherLayer (glsl-es-300)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureGatherLayer(cubes, x3, i, 2)": {
        "glsl": "error: this target has no textureGatherLayer (glsl-330)",
        "hlsl": "cubes.GatherBlue(cubes_sampler, float4(x3, float(i)))",
        "wgsl": "textureGather(2, cubes, cubes_sampler, x3, i)",
        "glsl-es": "error: this target has no textureGatherLayer (glsl-es-300)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureGatherLayer(shades, x2, i, y)": {
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

            return textureGatherLayerOffset(shades, x2, i, y, ivec2(0));
        """,
        "hlsl": "shades.GatherCmp(shades_sampler, float3(x2, float(i)), y)",
        "wgsl": "textureGatherCompare(shades, shades_sampler, x2, i, y)",
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

            return textureGatherLayerOffset(shades, x2, i, y, ivec2(0));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
    "textureGatherLayerOffset(layers, x2, i, ivec2(1, -2))": {
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(1, -2));
        """,
        "hlsl": "layers.GatherRed(layers_sampler, float3(x2, float(i)), int2(1, -2))",
        "wgsl": "textureGather(0, layers, layers_sampler, x2, i, vec2i(1, -2))",
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(1, -2));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureGatherLayerOffset(layers, x2, i, vec(1, -2))",
    },
    "textureGatherLayerOffset(layers, x2, i, ivec2(1, -2), 2)": {
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(1, -2), 2);
        """,
        "hlsl": "layers.GatherBlue(layers_sampler, float3(x2, float(i)), int2(1, -2))",
        "wgsl": "textureGather(2, layers, layers_sampler, x2, i, vec2i(1, -2))",
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

            return textureGatherLayerOffset(layers, x2, i, ivec2(1, -2), 2);
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
        "numpy": "textureGatherLayerOffset(layers, x2, i, vec(1, -2), 2)",
    },
    "textureGatherLayerOffset(shades, x2, i, y, ivec2(1, -2))": {
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

            return textureGatherLayerOffset(shades, x2, i, y, ivec2(1, -2));
        """,
        "hlsl": "shades.GatherCmp(shades_sampler, float3(x2, float(i)), y, int2(1, -2))",
        "wgsl": "textureGatherCompare(shades, shades_sampler, x2, i, y, vec2i(1, -2))",
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

            return textureGatherLayerOffset(shades, x2, i, y, ivec2(1, -2));
        """,
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
        "numpy": "textureGatherLayerOffset(shades, x2, i, y, vec(1, -2))",
    },
}
