"""The texts of reads of arrays, cubes and shadow textures in the targets; a part of texts_of_builtins.py."""

from __future__ import annotations

READS = {
    "textureQueryLod(map, x2)": {
        "glsl": "textureQueryLod(map, x2)",
        "hlsl": "float2(map.CalculateLevelOfDetail(map_sampler, x2), map.CalculateLevelOfDetailUnclamped(map_sampler, x2))",
        "wgsl": """
fn textureQueryLod_(map: texture_2d<f32>, map_sampler: sampler, P: vec2f) -> vec2f {
    let size = vec2f(vec2i(textureDimensions(map, 0)));
    let dx = dpdx(P) * size;
    let dy = dpdy(P) * size;
    let level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.1754944e-38));
    return vec2f(clamp(level, 0.0, f32(i32(textureNumLevels(map)) - 1)), level);
}

return textureQueryLod_(map, map_sampler, x2);
""",
        "glsl-es": "error: this target has no textureQueryLod (glsl-es-300)",
        "dx9": "error: this target has no textureQueryLod (unity-builtin)",
        "urp": "float2(map.CalculateLevelOfDetail(samplermap, x2), map.CalculateLevelOfDetailUnclamped(samplermap, x2))",
    },
    "textureQueryLod(volume, x3)": {
        "glsl": "textureQueryLod(volume, x3)",
        "hlsl": "float2(volume.CalculateLevelOfDetail(volume_sampler, x3), volume.CalculateLevelOfDetailUnclamped(volume_sampler, x3))",
        "wgsl": """
fn textureQueryLod_(map: texture_3d<f32>, map_sampler: sampler, P: vec3f) -> vec2f {
    let size = vec3f(vec3i(textureDimensions(map, 0)));
    let dx = dpdx(P) * size;
    let dy = dpdy(P) * size;
    let level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.1754944e-38));
    return vec2f(clamp(level, 0.0, f32(i32(textureNumLevels(map)) - 1)), level);
}

return textureQueryLod_(volume, volume_sampler, x3);
""",
        "glsl-es": "error: this target has no textureQueryLod (glsl-es-300)",
        "dx9": "error: this target has no textureQueryLod (unity-builtin)",
        "urp": "float2(volume.CalculateLevelOfDetail(samplervolume, x3), volume.CalculateLevelOfDetailUnclamped(samplervolume, x3))",
    },
    "texture(layers, x3)": {
        "glsl": "texture(layers, x3)",
        "hlsl": "layers.Sample(layers_sampler, x3)",
        "wgsl": "textureSample(layers, layers_sampler, x3.xy, i32(round(x3.z)))",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "texture(layers, x3, y)": {
        "glsl": "texture(layers, x3, y)",
        "hlsl": "layers.SampleBias(layers_sampler, x3, y)",
        "wgsl": "textureSampleBias(layers, layers_sampler, x3.xy, i32(round(x3.z)), y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "texture(cubes, x4)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.Sample(cubes_sampler, x4)",
        "wgsl": "textureSample(cubes, cubes_sampler, x4.xyz, i32(round(x4.w)))",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "texture(cubes, x4, y)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleBias(cubes_sampler, x4, y)",
        "wgsl": "textureSampleBias(cubes, cubes_sampler, x4.xyz, i32(round(x4.w)), y)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "texture(shade, x3)": {
        "glsl": "texture(shade, x3)",
        "hlsl": "shade.SampleCmp(shade_sampler, x3.xy, x3.z)",
        "wgsl": "textureSampleCompare(shade, shade_sampler, x3.xy, x3.z)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "texture(shadecube, x4)": {
        "glsl": "texture(shadecube, x4)",
        "hlsl": "shadecube.SampleCmp(shadecube_sampler, x4.xyz, x4.w)",
        "wgsl": "textureSampleCompare(shadecube, shadecube_sampler, x4.xyz, x4.w)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeShadow",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    # only GLSL has a bias there
    "texture(shade, x3, y)": {
        "glsl": "texture(shade, x3, y)",
        "hlsl": "shade.SampleCmp(shade_sampler, x3.xy, x3.z)",
        "wgsl": "textureSampleCompare(shade, shade_sampler, x3.xy, x3.z)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "texture(shadecube, x4, y)": {
        "glsl": "texture(shadecube, x4, y)",
        "hlsl": "shadecube.SampleCmp(shadecube_sampler, x4.xyz, x4.w)",
        "wgsl": "textureSampleCompare(shadecube, shadecube_sampler, x4.xyz, x4.w)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeShadow",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    "texture(shades, x4)": {
        "glsl": "texture(shades, x4)",
        "hlsl": "shades.SampleCmp(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w)",
        "wgsl": "textureSampleCompare(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
    "textureLod(layers, x3, y)": {
        "glsl": "textureLod(layers, x3, y)",
        "hlsl": "layers.SampleLevel(layers_sampler, x3, y)",
        "wgsl": "textureSampleLevel(layers, layers_sampler, x3.xy, i32(round(x3.z)), y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureLod(cubes, x4, y)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleLevel(cubes_sampler, x4, y)",
        "wgsl": "textureSampleLevel(cubes, cubes_sampler, x4.xyz, i32(round(x4.w)), y)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureLod(shade, x3, y)": {
        "glsl": "textureLod(shade, x3, y)",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z)",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "textureGrad(layers, x3, y2, z2)": {
        "glsl": "textureGrad(layers, x3, y2, z2)",
        "hlsl": "layers.SampleGrad(layers_sampler, x3, y2, z2)",
        "wgsl": "textureSampleGrad(layers, layers_sampler, x3.xy, i32(round(x3.z)), y2, z2)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureGrad(cubes, x4, y3, z3)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleGrad(cubes_sampler, x4, y3, z3)",
        "wgsl": "textureSampleGrad(cubes, cubes_sampler, x4.xyz, i32(round(x4.w)), y3, z3)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureOffset(map, x2, ivec2(1, -2))": {
        "glsl": "textureOffset(map, x2, ivec2(1, -2))",
        "hlsl": "map.Sample(map_sampler, x2, int2(1, -2))",
        "wgsl": "textureSample(map, map_sampler, x2, vec2i(1, -2))",
        "dx9": "error: this target has no textureOffset (unity-builtin)",
        "urp": "map.Sample(samplermap, x2, int2(1, -2))",
        "numpy": "textureOffset(map_, x2, vec(1, -2))",
    },
    "textureOffset(volume, x3, ivec3(1, -2, 0))": {
        "glsl": "textureOffset(volume, x3, ivec3(1, -2, 0))",
        "hlsl": "volume.Sample(volume_sampler, x3, int3(1, -2, 0))",
        "wgsl": "textureSample(volume, volume_sampler, x3, vec3i(1, -2, 0))",
        "dx9": "error: this target has no textureOffset (unity-builtin)",
        "urp": "volume.Sample(samplervolume, x3, int3(1, -2, 0))",
        "numpy": "textureOffset(volume, x3, vec(1, -2, 0))",
    },
    "textureOffset(map, x2, ivec2(1, -2), y)": {
        "glsl": "textureOffset(map, x2, ivec2(1, -2), y)",
        "hlsl": "map.SampleBias(map_sampler, x2, y, int2(1, -2))",
        "wgsl": "textureSampleBias(map, map_sampler, x2, y, vec2i(1, -2))",
        "dx9": "error: this target has no textureOffset (unity-builtin)",
        "urp": "map.SampleBias(samplermap, x2, y, int2(1, -2))",
        "numpy": "textureOffset(map_, x2, vec(1, -2), y)",
    },
    "textureOffset(volume, x3, ivec3(1, -2, 0), y)": {
        "glsl": "textureOffset(volume, x3, ivec3(1, -2, 0), y)",
        "hlsl": "volume.SampleBias(volume_sampler, x3, y, int3(1, -2, 0))",
        "wgsl": "textureSampleBias(volume, volume_sampler, x3, y, vec3i(1, -2, 0))",
        "dx9": "error: this target has no textureOffset (unity-builtin)",
        "urp": "volume.SampleBias(samplervolume, x3, y, int3(1, -2, 0))",
        "numpy": "textureOffset(volume, x3, vec(1, -2, 0), y)",
    },
    "textureLodOffset(map, x2, y, ivec2(1, -2))": {
        "glsl": "textureLodOffset(map, x2, y, ivec2(1, -2))",
        "hlsl": "map.SampleLevel(map_sampler, x2, y, int2(1, -2))",
        "wgsl": "textureSampleLevel(map, map_sampler, x2, y, vec2i(1, -2))",
        "dx9": "error: this target has no textureLodOffset (unity-builtin)",
        "urp": "map.SampleLevel(samplermap, x2, y, int2(1, -2))",
        "numpy": "textureLodOffset(map_, x2, y, vec(1, -2))",
    },
    "textureLodOffset(volume, x3, y, ivec3(1, -2, 0))": {
        "glsl": "textureLodOffset(volume, x3, y, ivec3(1, -2, 0))",
        "hlsl": "volume.SampleLevel(volume_sampler, x3, y, int3(1, -2, 0))",
        "wgsl": "textureSampleLevel(volume, volume_sampler, x3, y, vec3i(1, -2, 0))",
        "dx9": "error: this target has no textureLodOffset (unity-builtin)",
        "urp": "volume.SampleLevel(samplervolume, x3, y, int3(1, -2, 0))",
        "numpy": "textureLodOffset(volume, x3, y, vec(1, -2, 0))",
    },
    "textureGradOffset(map, x2, y2, z2, ivec2(1, -2))": {
        "glsl": "textureGradOffset(map, x2, y2, z2, ivec2(1, -2))",
        "hlsl": "map.SampleGrad(map_sampler, x2, y2, z2, int2(1, -2))",
        "wgsl": "textureSampleGrad(map, map_sampler, x2, y2, z2, vec2i(1, -2))",
        "dx9": "error: this target has no textureGradOffset (unity-builtin)",
        "urp": "map.SampleGrad(samplermap, x2, y2, z2, int2(1, -2))",
        "numpy": "textureGradOffset(map_, x2, y2, z2, vec(1, -2))",
    },
    "textureGradOffset(volume, x3, y3, z3, ivec3(1, -2, 0))": {
        "glsl": "textureGradOffset(volume, x3, y3, z3, ivec3(1, -2, 0))",
        "hlsl": "volume.SampleGrad(volume_sampler, x3, y3, z3, int3(1, -2, 0))",
        "wgsl": "textureSampleGrad(volume, volume_sampler, x3, y3, z3, vec3i(1, -2, 0))",
        "dx9": "error: this target has no textureGradOffset (unity-builtin)",
        "urp": "volume.SampleGrad(samplervolume, x3, y3, z3, int3(1, -2, 0))",
        "numpy": "textureGradOffset(volume, x3, y3, z3, vec(1, -2, 0))",
    },
    "texelFetch(layers, i3, j)": {
        "glsl": "texelFetch(layers, i3, j)",
        "hlsl": "layers.Load(int4(i3, j))",
        "wgsl": "textureLoad(layers, i3.xy, i3.z, j)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "texelFetch(ints, i2, j)": {
        "glsl": "texelFetch(ints, i2, j)",
        "hlsl": "ints.Load(int3(i2, j))",
        "wgsl": "textureLoad(ints, i2, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no isampler2D",
    },
    "texelFetch(intvolume, i3, j)": {
        "glsl": "texelFetch(intvolume, i3, j)",
        "hlsl": "intvolume.Load(int4(i3, j))",
        "wgsl": "textureLoad(intvolume, i3, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no isampler3D",
    },
    "texelFetch(intlayers, i3, j)": {
        "glsl": "texelFetch(intlayers, i3, j)",
        "hlsl": "intlayers.Load(int4(i3, j))",
        "wgsl": "textureLoad(intlayers, i3.xy, i3.z, j)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no isampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no isampler2DArray",
    },
    "texelFetch(uints, i2, j)": {
        "glsl": "texelFetch(uints, i2, j)",
        "hlsl": "uints.Load(int3(i2, j))",
        "wgsl": "textureLoad(uints, i2, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no usampler2D",
    },
    "texelFetch(uintvolume, i3, j)": {
        "glsl": "texelFetch(uintvolume, i3, j)",
        "hlsl": "uintvolume.Load(int4(i3, j))",
        "wgsl": "textureLoad(uintvolume, i3, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "error: Unity, Universal Render Pipeline has no usampler3D",
    },
    "texelFetch(uintlayers, i3, j)": {
        "glsl": "texelFetch(uintlayers, i3, j)",
        "hlsl": "uintlayers.Load(int4(i3, j))",
        "wgsl": "textureLoad(uintlayers, i3.xy, i3.z, j)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no usampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no usampler2DArray",
    },
    "texelFetchOffset(map, i2, j, ivec2(1, -2))": {
        "glsl": "texelFetchOffset(map, i2, j, ivec2(1, -2))",
        "hlsl": "map.Load(int3(i2 + int2(1, -2), j))",
        "wgsl": "textureLoad(map, i2 + vec2i(1, -2), j)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "LOAD_TEXTURE2D_LOD(map, i2 + int2(1, -2), j)",
        "numpy": "texelFetchOffset(map_, i2, j, vec(1, -2))",
    },
    "texelFetchOffset(volume, i3, j, ivec3(1, -2, 0))": {
        "glsl": "texelFetchOffset(volume, i3, j, ivec3(1, -2, 0))",
        "hlsl": "volume.Load(int4(i3 + int3(1, -2, 0), j))",
        "wgsl": "textureLoad(volume, i3 + vec3i(1, -2, 0), j)",
        "dx9": "error: this target has no texelFetchOffset (unity-builtin)",
        "urp": "LOAD_TEXTURE3D_LOD(volume, i3 + int3(1, -2, 0), j)",
        "numpy": "texelFetchOffset(volume, i3, j, vec(1, -2, 0))",
    },
    "textureGather(map, x2)": {
        "glsl": """
            vec4 textureGatherOffset_(sampler2D map, vec2 P, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return vec4(textureLod(map, vec2(low.x, high.y), 0.0).r, textureLod(map, high, 0.0).r,
                    textureLod(map, vec2(high.x, low.y), 0.0).r, textureLod(map, low, 0.0).r);
            }

            return textureGatherOffset_(map, x2, ivec2(0));
        """,
        "hlsl": "map.GatherRed(map_sampler, x2)",
        "wgsl": "textureGather(0, map, map_sampler, x2)",
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "map.GatherRed(samplermap, x2)",
    },
    "textureGather(map, x2, 2)": {
        "glsl": """
            vec4 textureGatherOffset_(sampler2D map, vec2 P, ivec2 offset, int channel) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                vec4 a = textureLod(map, vec2(low.x, high.y), 0.0);
                vec4 b = textureLod(map, high, 0.0);
                vec4 c = textureLod(map, vec2(high.x, low.y), 0.0);
                vec4 d = textureLod(map, low, 0.0);
                return vec4(a[channel], b[channel], c[channel], d[channel]);
            }

            return textureGatherOffset_(map, x2, ivec2(0), 2);
        """,
        "hlsl": "map.GatherBlue(map_sampler, x2)",
        "wgsl": "textureGather(2, map, map_sampler, x2)",
        "dx9": "error: this target has no textureGather (unity-builtin)",
        "urp": "map.GatherBlue(samplermap, x2)",
    },
    "textureGatherOffset(map, x2, ivec2(1, -2))": {
        "glsl": """
            vec4 textureGatherOffset_(sampler2D map, vec2 P, ivec2 offset) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                return vec4(textureLod(map, vec2(low.x, high.y), 0.0).r, textureLod(map, high, 0.0).r,
                    textureLod(map, vec2(high.x, low.y), 0.0).r, textureLod(map, low, 0.0).r);
            }

            return textureGatherOffset_(map, x2, ivec2(1, -2));
        """,
        "hlsl": "map.GatherRed(map_sampler, x2, int2(1, -2))",
        "wgsl": "textureGather(0, map, map_sampler, x2, vec2i(1, -2))",
        "dx9": "error: this target has no textureGatherOffset (unity-builtin)",
        "urp": "map.GatherRed(samplermap, x2, int2(1, -2))",
        "numpy": "textureGatherOffset(map_, x2, vec(1, -2))",
    },
    "textureGatherOffset(map, x2, ivec2(1, -2), 2)": {
        "glsl": """
            vec4 textureGatherOffset_(sampler2D map, vec2 P, ivec2 offset, int channel) {
                vec2 size = vec2(textureSize(map, 0));
                vec2 low = (floor(P * size - 0.5) + vec2(offset) + 0.5) / size;
                vec2 high = low + 1.0 / size;
                vec4 a = textureLod(map, vec2(low.x, high.y), 0.0);
                vec4 b = textureLod(map, high, 0.0);
                vec4 c = textureLod(map, vec2(high.x, low.y), 0.0);
                vec4 d = textureLod(map, low, 0.0);
                return vec4(a[channel], b[channel], c[channel], d[channel]);
            }

            return textureGatherOffset_(map, x2, ivec2(1, -2), 2);
        """,
        "hlsl": "map.GatherBlue(map_sampler, x2, int2(1, -2))",
        "wgsl": "textureGather(2, map, map_sampler, x2, vec2i(1, -2))",
        "dx9": "error: this target has no textureGatherOffset (unity-builtin)",
        "urp": "map.GatherBlue(samplermap, x2, int2(1, -2))",
        "numpy": "textureGatherOffset(map_, x2, vec(1, -2), 2)",
    },
    "textureLayer(layers, x2, i)": {
        "glsl": "texture(layers, vec3(x2, float(i)))",
        "hlsl": "layers.Sample(layers_sampler, float3(x2, float(i)))",
        "wgsl": "textureSample(layers, layers_sampler, x2, i)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureLayer(layers, x2, i, y)": {
        "glsl": "texture(layers, vec3(x2, float(i)), y)",
        "hlsl": "layers.SampleBias(layers_sampler, float3(x2, float(i)), y)",
        "wgsl": "textureSampleBias(layers, layers_sampler, x2, i, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureLayer(cubes, x3, i)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.Sample(cubes_sampler, float4(x3, float(i)))",
        "wgsl": "textureSample(cubes, cubes_sampler, x3, i)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureLayer(cubes, x3, i, y)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleBias(cubes_sampler, float4(x3, float(i)), y)",
        "wgsl": "textureSampleBias(cubes, cubes_sampler, x3, i, y)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureLayerLod(layers, x2, i, y)": {
        "glsl": "textureLod(layers, vec3(x2, float(i)), y)",
        "hlsl": "layers.SampleLevel(layers_sampler, float3(x2, float(i)), y)",
        "wgsl": "textureSampleLevel(layers, layers_sampler, x2, i, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureLayerLod(cubes, x3, i, y)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleLevel(cubes_sampler, float4(x3, float(i)), y)",
        "wgsl": "textureSampleLevel(cubes, cubes_sampler, x3, i, y)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "textureLayerGrad(layers, x2, i, y2, z2)": {
        "glsl": "textureGrad(layers, vec3(x2, float(i)), y2, z2)",
        "hlsl": "layers.SampleGrad(layers_sampler, float3(x2, float(i)), y2, z2)",
        "wgsl": "textureSampleGrad(layers, layers_sampler, x2, i, y2, z2)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "textureLayerGrad(cubes, x3, i, y3, z3)": {
        "glsl": "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray",
        "hlsl": "cubes.SampleGrad(cubes_sampler, float4(x3, float(i)), y3, z3)",
        "wgsl": "textureSampleGrad(cubes, cubes_sampler, x3, i, y3, z3)",
        "glsl-es": "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeArray",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeArray",
    },
    "texelFetchLayer(layers, i2, j, k)": {
        "glsl": "texelFetch(layers, ivec3(i2, j), k)",
        "hlsl": "layers.Load(int4(i2, j, k))",
        "wgsl": "textureLoad(layers, i2, j, k)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArray",
    },
    "texelFetchLayer(intlayers, i2, j, k)": {
        "glsl": "texelFetch(intlayers, ivec3(i2, j), k)",
        "hlsl": "intlayers.Load(int4(i2, j, k))",
        "wgsl": "textureLoad(intlayers, i2, j, k)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no isampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no isampler2DArray",
    },
    "texelFetchLayer(uintlayers, i2, j, k)": {
        "glsl": "texelFetch(uintlayers, ivec3(i2, j), k)",
        "hlsl": "uintlayers.Load(int4(i2, j, k))",
        "wgsl": "textureLoad(uintlayers, i2, j, k)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no usampler2DArray",
        "urp": "error: Unity, Universal Render Pipeline has no usampler2DArray",
    },
    "textureCompare(shade, x2, y)": {
        "glsl": "texture(shade, vec3(x2, y))",
        "hlsl": "shade.SampleCmp(shade_sampler, x2, y)",
        "wgsl": "textureSampleCompare(shade, shade_sampler, x2, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "textureCompare(shadecube, x3, y)": {
        "glsl": "texture(shadecube, vec4(x3, y))",
        "hlsl": "shadecube.SampleCmp(shadecube_sampler, x3, y)",
        "wgsl": "textureSampleCompare(shadecube, shadecube_sampler, x3, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeShadow",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    "textureCompare(shades, x2, i, y)": {
        "glsl": "texture(shades, vec4(x2, float(i), y))",
        "hlsl": "shades.SampleCmp(shades_sampler, float3(x2, float(i)), y)",
        "wgsl": "textureSampleCompare(shades, shades_sampler, x2, i, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
    "textureCompareLod(shade, x2, y)": {
        "glsl": "textureLod(shade, vec3(x2, y), 0.0)",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x2, y)",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x2, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "textureGrad(shade, x3, x2, y2)": {
        "glsl": "textureGrad(shade, x3, x2, y2)",
        "hlsl": "shade.SampleCmpLevelZero(shade_sampler, x3.xy, x3.z)",
        "wgsl": "textureSampleCompareLevel(shade, shade_sampler, x3.xy, x3.z)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DShadow",
    },
    "textureGrad(shadecube, x4, x3, y3)": {
        "glsl": "textureGrad(shadecube, x4, x3, y3)",
        "hlsl": "shadecube.SampleCmpLevelZero(shadecube_sampler, x4.xyz, x4.w)",
        "wgsl": "textureSampleCompareLevel(shadecube, shadecube_sampler, x4.xyz, x4.w)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeShadow",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    "textureGrad(shades, x4, x2, y2)": {
        "glsl": "textureGrad(shades, x4, x2, y2)",
        "hlsl": "shades.SampleCmpLevelZero(shades_sampler, float3(x4.xy, float(int(round(x4.z)))), x4.w)",
        "wgsl": "textureSampleCompareLevel(shades, shades_sampler, x4.xy, i32(round(x4.z)), x4.w)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
    "textureCompareLod(shadecube, x3, y)": {
        "glsl": "textureGrad(shadecube, vec4(x3, y), vec3(0.0), vec3(0.0))",
        "hlsl": "shadecube.SampleCmpLevelZero(shadecube_sampler, x3, y)",
        "wgsl": "textureSampleCompareLevel(shadecube, shadecube_sampler, x3, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no samplerCubeShadow",
        "urp": "error: Unity, Universal Render Pipeline has no samplerCubeShadow",
    },
    "textureCompareLod(shades, x2, i, y)": {
        "glsl": "textureGrad(shades, vec4(x2, float(i), y), vec2(0.0), vec2(0.0))",
        "hlsl": "shades.SampleCmpLevelZero(shades_sampler, float3(x2, float(i)), y)",
        "wgsl": "textureSampleCompareLevel(shades, shades_sampler, x2, i, y)",
        "dx9": "error: Unity, built-in pipeline (surface shader) has no sampler2DArrayShadow",
        "urp": "error: Unity, Universal Render Pipeline has no sampler2DArrayShadow",
    },
}
