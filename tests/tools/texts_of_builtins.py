"""The text of every builtin of the intrinsic table in each target.

SAME has the texts that are equal in all targets. CASES and the other files texts_of_*.py have the other texts,
each for GLSL 3.30, HLSL and WGSL. GLSL ES uses the text of GLSL, and Unity's two dialects that of HLSL, unless a case
has another text. NumPy has each builtin under its own name.
"""

from __future__ import annotations

from sssgen.targets.registry import load
from texts_of_gathers import GATHERS
from texts_of_glsl_4 import LATER
from texts_of_offsets import OFFSETS
from texts_of_reads import READS
from validate import SAMPLERS, TARGETS

SAME = """
radians(x); radians(x3); degrees(x); degrees(x3); sin(x); sin(x3); cos(x); cos(x3); tan(x); tan(x3); asin(x);
asin(x3); acos(x); acos(x3); atan(x); atan(x3); sinh(x); sinh(x3); cosh(x); cosh(x3); tanh(x); tanh(x3); pow(x, y);
pow(x3, y3); exp(x); exp(x3); log(x); log(x3); exp2(x); exp2(x3); log2(x); log2(x3); sqrt(x); sqrt(x3); abs(x);
abs(x3); abs(i); abs(i3); sign(i); sign(i3); floor(x); floor(x3); ceil(x); ceil(x3); trunc(x); trunc(x3); min(x, y);
min(x3, y3); min(i, j); min(i3, j3); min(u, w); min(u3, w3); max(x, y); max(x3, y3); max(i, j); max(i3, j3);
max(u, w); max(u3, w3); clamp(x, y, z); clamp(x3, y3, z3); clamp(i, j, k); clamp(i3, j3, k3); clamp(u, w, v);
clamp(u3, w3, v3); step(x, y); step(x3, y3); smoothstep(x, y, z); smoothstep(x3, y3, z3); length(x); length(x3);
distance(x3, y3); dot(x3, y3); cross(x3, y3); normalize(x3); reflect(x3, y3); refract(x3, y3, z); transpose(m3);
determinant(m3); any(p3); all(p3); fwidth(x); fwidth(x3)
"""

RELATIONS = {
    "lessThan": "<", "lessThanEqual": "<=", "greaterThan": ">", "greaterThanEqual": ">=",
    "equal": "==", "notEqual": "!=",
}  # fmt: skip

CASES = {
    "atan(x, y)": {"glsl": "atan(x, y)", "hlsl": "atan2(x, y)", "wgsl": "atan2(x, y)"},
    "atan(x3, y3)": {"glsl": "atan(x3, y3)", "hlsl": "atan2(x3, y3)", "wgsl": "atan2(x3, y3)"},
    "asinh(x)": {
        "glsl": "sign(x) * log(abs(x) + sqrt(x * x + 1.0))",
        "hlsl": "float(sign(x)) * log(abs(x) + sqrt(x * x + 1.0))",
        "wgsl": "sign(x) * log(abs(x) + sqrt(x * x + 1.0))",
    },
    "asinh(x3)": {
        "glsl": "sign(x3) * log(abs(x3) + sqrt(x3 * x3 + 1.0))",
        "hlsl": "float3(sign(x3)) * log(abs(x3) + sqrt(x3 * x3 + 1.0))",
        "wgsl": "sign(x3) * log(abs(x3) + sqrt(x3 * x3 + 1.0))",
    },
    "acosh(x)": {"glsl": "acosh(x)", "hlsl": "log(x + sqrt((x - 1.0) * (x + 1.0)))", "wgsl": "acosh(x)"},
    "acosh(x3)": {
        "glsl": "acosh(x3)",
        "hlsl": "log(x3 + sqrt((x3 - 1.0) * (x3 + 1.0)))",
        "wgsl": "acosh(x3)",
    },
    "atanh(x)": {"glsl": "atanh(x)", "hlsl": "0.5 * log((1.0 + x) / (1.0 - x))", "wgsl": "atanh(x)"},
    "atanh(x3)": {"glsl": "atanh(x3)", "hlsl": "0.5 * log((1.0 + x3) / (1.0 - x3))", "wgsl": "atanh(x3)"},
    "inversesqrt(x)": {"glsl": "inversesqrt(x)", "hlsl": "rsqrt(x)", "wgsl": "inverseSqrt(x)"},
    "inversesqrt(x3)": {"glsl": "inversesqrt(x3)", "hlsl": "rsqrt(x3)", "wgsl": "inverseSqrt(x3)"},
    "sign(x)": {"glsl": "sign(x)", "hlsl": "float(sign(x))", "wgsl": "sign(x)"},
    "sign(x3)": {"glsl": "sign(x3)", "hlsl": "float3(sign(x3))", "wgsl": "sign(x3)"},
    "round(x)": {"glsl": "roundEven(x)", "hlsl": "round(x)", "wgsl": "round(x)"},
    "round(x3)": {"glsl": "roundEven(x3)", "hlsl": "round(x3)", "wgsl": "round(x3)"},
    "roundEven(x)": {"glsl": "roundEven(x)", "hlsl": "round(x)", "wgsl": "round(x)"},
    "roundEven(x3)": {"glsl": "roundEven(x3)", "hlsl": "round(x3)", "wgsl": "round(x3)"},
    "fract(x)": {"glsl": "fract(x)", "hlsl": "frac(x)", "wgsl": "fract(x)"},
    "fract(x3)": {"glsl": "fract(x3)", "hlsl": "frac(x3)", "wgsl": "fract(x3)"},
    "mod(x, y)": {"glsl": "mod(x, y)", "hlsl": "x - y * floor(x / y)", "wgsl": "x - y * floor(x / y)"},
    "mod(x3, y3)": {
        "glsl": "mod(x3, y3)",
        "hlsl": "x3 - y3 * floor(x3 / y3)",
        "wgsl": "x3 - y3 * floor(x3 / y3)",
    },
    "mod(x3, y)": {"glsl": "mod(x3, y)", "hlsl": "x3 - y * floor(x3 / y)", "wgsl": "x3 - y * floor(x3 / y)"},
    "fmod(x, y)": {"glsl": "x - y * trunc(x / y)", "hlsl": "x - y * trunc(x / y)", "wgsl": "x % y"},
    "fmod(x3, y3)": {
        "glsl": "x3 - y3 * trunc(x3 / y3)",
        "hlsl": "x3 - y3 * trunc(x3 / y3)",
        "wgsl": "x3 % y3",
    },
    "fmod(x3, y)": {"glsl": "x3 - y * trunc(x3 / y)", "hlsl": "x3 - y * trunc(x3 / y)", "wgsl": "x3 % y"},
    "min(x3, y)": {"glsl": "min(x3, y)", "hlsl": "min(x3, y)", "wgsl": "min(x3, vec3f(y))"},
    "min(i3, j)": {"glsl": "min(i3, j)", "hlsl": "min(i3, j)", "wgsl": "min(i3, vec3i(j))"},
    "min(u3, w)": {"glsl": "min(u3, w)", "hlsl": "min(u3, w)", "wgsl": "min(u3, vec3u(w))"},
    "max(x3, y)": {"glsl": "max(x3, y)", "hlsl": "max(x3, y)", "wgsl": "max(x3, vec3f(y))"},
    "max(i3, j)": {"glsl": "max(i3, j)", "hlsl": "max(i3, j)", "wgsl": "max(i3, vec3i(j))"},
    "max(u3, w)": {"glsl": "max(u3, w)", "hlsl": "max(u3, w)", "wgsl": "max(u3, vec3u(w))"},
    "clamp(x3, y, z)": {
        "glsl": "clamp(x3, y, z)",
        "hlsl": "clamp(x3, y, z)",
        "wgsl": "clamp(x3, vec3f(y), vec3f(z))",
    },
    "clamp(i3, j, k)": {
        "glsl": "clamp(i3, j, k)",
        "hlsl": "clamp(i3, j, k)",
        "wgsl": "clamp(i3, vec3i(j), vec3i(k))",
    },
    "clamp(u3, w, v)": {
        "glsl": "clamp(u3, w, v)",
        "hlsl": "clamp(u3, w, v)",
        "wgsl": "clamp(u3, vec3u(w), vec3u(v))",
    },
    "saturate(x)": {"glsl": "clamp(x, 0.0, 1.0)", "hlsl": "saturate(x)", "wgsl": "saturate(x)"},
    "saturate(x3)": {"glsl": "clamp(x3, 0.0, 1.0)", "hlsl": "saturate(x3)", "wgsl": "saturate(x3)"},
    "mix(x, y, z)": {"glsl": "mix(x, y, z)", "hlsl": "lerp(x, y, z)", "wgsl": "mix(x, y, z)"},
    "mix(x3, y3, z3)": {"glsl": "mix(x3, y3, z3)", "hlsl": "lerp(x3, y3, z3)", "wgsl": "mix(x3, y3, z3)"},
    "mix(x3, y3, z)": {"glsl": "mix(x3, y3, z)", "hlsl": "lerp(x3, y3, z)", "wgsl": "mix(x3, y3, z)"},
    "mix(x, y, p)": {"glsl": "mix(x, y, p)", "hlsl": "p ? y : x", "wgsl": "select(x, y, p)"},
    "mix(x3, y3, p3)": {
        "glsl": "mix(x3, y3, p3)",
        "hlsl": "float3(p3.x ? y3.x : x3.x, p3.y ? y3.y : x3.y, p3.z ? y3.z : x3.z)",
        "wgsl": "select(x3, y3, p3)",
    },
    "step(x, y3)": {"glsl": "step(x, y3)", "hlsl": "step(x, y3)", "wgsl": "step(vec3f(x), y3)"},
    "smoothstep(x, y, z3)": {
        "glsl": "smoothstep(x, y, z3)",
        "hlsl": "smoothstep(x, y, z3)",
        "wgsl": "smoothstep(vec3f(x), vec3f(y), z3)",
    },
    "isnan(x)": {
        "glsl": "(floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u",
        "hlsl": "(asuint(x) & 0x7fffffffu) > 0x7f800000u",
        "wgsl": "(bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u",
    },
    "isnan(x3)": {
        "glsl": "greaterThan(floatBitsToUint(x3) & uvec3(0x7fffffffu), uvec3(0x7f800000u))",
        "hlsl": "(asuint(x3) & (uint3)0x7fffffffu) > (uint3)0x7f800000u",
        "wgsl": "(bitcast<vec3u>(x3) & vec3u(0x7fffffffu)) > vec3u(0x7f800000u)",
    },
    "isinf(x)": {
        "glsl": "(floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u",
        "hlsl": "(asuint(x) & 0x7fffffffu) == 0x7f800000u",
        "wgsl": "(bitcast<u32>(x) & 0x7fffffffu) == 0x7f800000u",
    },
    "isinf(x3)": {
        "glsl": "equal(floatBitsToUint(x3) & uvec3(0x7fffffffu), uvec3(0x7f800000u))",
        "hlsl": "(asuint(x3) & (uint3)0x7fffffffu) == (uint3)0x7f800000u",
        "wgsl": "(bitcast<vec3u>(x3) & vec3u(0x7fffffffu)) == vec3u(0x7f800000u)",
    },
    "floatBitsToInt(x)": {"glsl": "floatBitsToInt(x)", "hlsl": "asint(x)", "wgsl": "bitcast<i32>(x)"},
    "floatBitsToInt(x3)": {"glsl": "floatBitsToInt(x3)", "hlsl": "asint(x3)", "wgsl": "bitcast<vec3i>(x3)"},
    "floatBitsToUint(x)": {"glsl": "floatBitsToUint(x)", "hlsl": "asuint(x)", "wgsl": "bitcast<u32>(x)"},
    "floatBitsToUint(x3)": {
        "glsl": "floatBitsToUint(x3)",
        "hlsl": "asuint(x3)",
        "wgsl": "bitcast<vec3u>(x3)",
    },
    "intBitsToFloat(i)": {"glsl": "intBitsToFloat(i)", "hlsl": "asfloat(i)", "wgsl": "bitcast<f32>(i)"},
    "intBitsToFloat(i3)": {
        "glsl": "intBitsToFloat(i3)",
        "hlsl": "asfloat(i3)",
        "wgsl": "bitcast<vec3f>(i3)",
    },
    "uintBitsToFloat(u)": {"glsl": "uintBitsToFloat(u)", "hlsl": "asfloat(u)", "wgsl": "bitcast<f32>(u)"},
    "uintBitsToFloat(u3)": {
        "glsl": "uintBitsToFloat(u3)",
        "hlsl": "asfloat(u3)",
        "wgsl": "bitcast<vec3f>(u3)",
    },
    "packSnorm2x16(x2)": {
        "glsl": """
            uint packSnorm2x16_(vec2 x) {
                ivec2 i = ivec2(roundEven(clamp(x, -1.0, 1.0) * 32767.0));
                return (uint(i.x) & 65535u) | (uint(i.y) << 16u);
            }

            return packSnorm2x16_(x2);
        """,
        "hlsl": """
            uint packSnorm2x16_(float2 x) {
                int2 i = (int2)round(clamp(x, -1.0, 1.0) * 32767.0);
                return (uint(i.x) & 65535u) | (uint(i.y) << 16u);
            }

            return packSnorm2x16_(x2);
        """,
        "wgsl": "pack2x16snorm(x2)",
        "glsl-es": "packSnorm2x16(x2)",
    },
    "packUnorm2x16(x2)": {
        "glsl": """
            uint packUnorm2x16_(vec2 x) {
                uvec2 u = uvec2(roundEven(clamp(x, 0.0, 1.0) * 65535.0));
                return u.x | (u.y << 16u);
            }

            return packUnorm2x16_(x2);
        """,
        "hlsl": """
            uint packUnorm2x16_(float2 x) {
                uint2 u = (uint2)round(clamp(x, 0.0, 1.0) * 65535.0);
                return u.x | (u.y << 16u);
            }

            return packUnorm2x16_(x2);
        """,
        "wgsl": "pack2x16unorm(x2)",
        "glsl-es": "packUnorm2x16(x2)",
    },
    "packHalf2x16(x2)": {
        "glsl": """
        uint packHalf2x16_(vec2 x) {
            uvec2 bits = floatBitsToUint(abs(x));
            uvec2 normal = (bits - 0x37fff001u + ((bits >> 13u) & 1u)) >> 13u;
            uvec2 tiny = uvec2(roundEven(abs(x) * 16777216.0));
            uvec2 halves = uvec2(bits.x < 0x38800000u ? tiny.x : normal.x, bits.y < 0x38800000u ? tiny.y : normal.y);
            halves |= (floatBitsToUint(x) >> 16u) & 32768u;
            return halves.x | (halves.y << 16u);
        }

        return packHalf2x16_(x2);
        """,
        "hlsl": "dot(f32tof16(x2), uint2(1u, 65536u))",
        "wgsl": "pack2x16float(x2)",
        "glsl-es": "packHalf2x16(x2)",
        "dx9": """
        uint packHalf2x16_(float2 x) {
            uint2 bits = asuint(abs(x));
            uint2 normal = (bits - 0x37fff001u + ((bits >> 13u) & 1u)) >> 13u;
            uint2 tiny = (uint2)round(abs(x) * 16777216.0);
            uint2 halves = uint2(bits.x < 0x38800000u ? tiny.x : normal.x, bits.y < 0x38800000u ? tiny.y : normal.y);
            halves |= (asuint(x) >> 16u) & 32768u;
            return halves.x | (halves.y << 16u);
        }

        return packHalf2x16_(x2);
        """,
    },
    "unpackSnorm2x16(u)": {
        "glsl": "clamp(vec2(float(int(u << 16u) >> 16), float(int(u) >> 16)) / 32767.0, -1.0, 1.0)",
        "hlsl": "clamp(float2(float(int(u << 16u) >> 16), float(int(u) >> 16)) / 32767.0, -1.0, 1.0)",
        "wgsl": "unpack2x16snorm(u)",
        "glsl-es": "unpackSnorm2x16(u)",
    },
    "unpackUnorm2x16(u)": {
        "glsl": "vec2(float(u & 65535u), float(u >> 16u)) / 65535.0",
        "hlsl": "float2(float(u & 65535u), float(u >> 16u)) / 65535.0",
        "wgsl": "unpack2x16unorm(u)",
        "glsl-es": "unpackUnorm2x16(u)",
    },
    "unpackHalf2x16(u)": {
        "glsl": """
            vec2 unpackHalf2x16_(uint x) {
                uvec2 halves = uvec2(x & 65535u, x >> 16u);
                uvec2 bits = halves & 32767u;
                vec2 normal = uintBitsToFloat((bits << 13u) + 0x38000000u);
                vec2 tiny = vec2(bits) / 16777216.0;
                vec2 size = vec2(bits.x < 1024u ? tiny.x : normal.x, bits.y < 1024u ? tiny.y : normal.y);
                return uintBitsToFloat(floatBitsToUint(size) | ((halves & 32768u) << 16u));
            }

            return unpackHalf2x16_(u);
        """,
        "hlsl": "f16tof32((u) >> uint2(0u, 16u))",
        "wgsl": "unpack2x16float(u)",
        "glsl-es": "unpackHalf2x16(u)",
        "dx9": """
            float2 unpackHalf2x16_(uint x) {
                uint2 halves = uint2(x & 65535u, x >> 16u);
                uint2 bits = halves & 32767u;
                float2 normal = asfloat((bits << 13u) + 0x38000000u);
                float2 tiny = (float2)bits / 16777216.0;
                float2 size = float2(bits.x < 1024u ? tiny.x : normal.x, bits.y < 1024u ? tiny.y : normal.y);
                return asfloat(asuint(size) | ((halves & 32768u) << 16u));
            }

            return unpackHalf2x16_(u);
        """,
    },
    "distance(x, y)": {"glsl": "distance(x, y)", "hlsl": "abs(x - y)", "wgsl": "distance(x, y)"},
    "dot(x, y)": {"glsl": "dot(x, y)", "hlsl": "x * y", "wgsl": "x * y"},
    "normalize(x)": {"glsl": "normalize(x)", "hlsl": "float(sign(x))", "wgsl": "sign(x)"},
    "faceforward(x3, y3, z3)": {
        "glsl": "faceforward(x3, y3, z3)",
        "hlsl": "faceforward(x3, y3, z3)",
        "wgsl": "faceForward(x3, y3, z3)",
    },
    "faceforward(x, y, z)": {
        "glsl": "faceforward(x, y, z)",
        "hlsl": "z * y < 0.0 ? x : -x",
        "wgsl": "select(-x, x, z * y < 0.0)",
    },
    "reflect(x, y)": {"glsl": "reflect(x, y)", "hlsl": "x - 2.0 * y * x * y", "wgsl": "x - 2.0 * y * x * y"},
    "refract(x, y, z)": {
        "glsl": "refract(x, y, z)",
        "hlsl": """
            float refract_(float x, float y, float z) {
                float c = y * x;
                float k = 1.0 - z * z * (1.0 - c * c);
                return k < 0.0 ? 0.0 : z * x - (z * c + sqrt(max(k, 0.0))) * y;
            }

            return refract_(x, y, z);
        """,
        "wgsl": """
            fn refract_(x: f32, y: f32, z: f32) -> f32 {
                let c = y * x;
                let k = 1.0 - z * z * (1.0 - c * c);
                return select(z * x - (z * c + sqrt(max(k, 0.0))) * y, 0.0, k < 0.0);
            }

            return refract_(x, y, z);
        """,
    },
    "matrixCompMult(m3, n3)": {
        "glsl": "matrixCompMult(m3, n3)",
        "hlsl": "float3x3(m3[0] * n3[0], m3[1] * n3[1], m3[2] * n3[2])",
        "wgsl": "mat3x3f(m3[0] * n3[0], m3[1] * n3[1], m3[2] * n3[2])",
    },
    "outerProduct(x3, y3)": {
        "glsl": "outerProduct(x3, y3)",
        "hlsl": "float3x3(x3 * y3.x, x3 * y3.y, x3 * y3.z)",
        "wgsl": "mat3x3f(x3 * y3.x, x3 * y3.y, x3 * y3.z)",
    },
    "inverse(m3)": {
        "glsl": "inverse(m3)",
        "hlsl": """
            float3x3 inverse_(float3x3 x) {
                float3 a = cross(x[1], x[2]);
                return transpose(float3x3(a, cross(x[2], x[0]), cross(x[0], x[1]))) * (1.0 / dot(x[0], a));
            }

            return inverse_(m3);
        """,
        "wgsl": """
            fn inverse_(x: mat3x3f) -> mat3x3f {
                let a = cross(x[1], x[2]);
                return transpose(mat3x3f(a, cross(x[2], x[0]), cross(x[0], x[1]))) * (1.0 / dot(x[0], a));
            }

            return inverse_(m3);
        """,
    },
    "not(p3)": {"glsl": "not(p3)", "hlsl": "!p3", "wgsl": "!p3"},
    "unpackNormal(x4)": {
        "glsl": "x4.xyz * 2.0 - 1.0",
        "hlsl": "x4.xyz * 2.0 - 1.0",
        "wgsl": "x4.xyz * 2.0 - 1.0",
        "dx9": "UnpackNormal(x4)",
        "urp": "UnpackNormal(x4)",
        "godot": """
            vec3 unpack_normal(vec4 texel) {
                vec3 n = texel.xyz * 2.0 - 1.0;
                return vec3(n.xy, texel.z > 0.0 ? n.z : sqrt(max(1.0 - dot(n.xy, n.xy), 0.0)));
            }

            return unpack_normal(x4);
        """,
    },
    "texture(map, x2)": {
        "glsl": "texture(map, x2)",
        "hlsl": "map.Sample(map_sampler, x2)",
        "wgsl": "textureSample(map, map_sampler, x2)",
        "dx9": "tex2D(map, x2)",
        "urp": "SAMPLE_TEXTURE2D(map, samplermap, x2)",
    },
    "texture(volume, x3)": {
        "glsl": "texture(volume, x3)",
        "hlsl": "volume.Sample(volume_sampler, x3)",
        "wgsl": "textureSample(volume, volume_sampler, x3)",
        "dx9": "tex3D(volume, x3)",
        "urp": "SAMPLE_TEXTURE3D(volume, samplervolume, x3)",
    },
    "texture(cube, x3)": {
        "glsl": "texture(cube, x3)",
        "hlsl": "cube.Sample(cube_sampler, x3)",
        "wgsl": "textureSample(cube, cube_sampler, x3)",
        "dx9": "texCUBE(cube, x3)",
        "urp": "SAMPLE_TEXTURECUBE(cube, samplercube, x3)",
    },
    "texture(map, x2, y)": {
        "glsl": "texture(map, x2, y)",
        "hlsl": "map.SampleBias(map_sampler, x2, y)",
        "wgsl": "textureSampleBias(map, map_sampler, x2, y)",
        "dx9": "tex2Dbias(map, float4(x2, 0.0, y))",
        "urp": "SAMPLE_TEXTURE2D_BIAS(map, samplermap, x2, y)",
    },
    "texture(volume, x3, y)": {
        "glsl": "texture(volume, x3, y)",
        "hlsl": "volume.SampleBias(volume_sampler, x3, y)",
        "wgsl": "textureSampleBias(volume, volume_sampler, x3, y)",
        "dx9": "tex3Dbias(volume, float4(x3, y))",
        "urp": "volume.SampleBias(samplervolume, x3, y)",
    },
    "texture(cube, x3, y)": {
        "glsl": "texture(cube, x3, y)",
        "hlsl": "cube.SampleBias(cube_sampler, x3, y)",
        "wgsl": "textureSampleBias(cube, cube_sampler, x3, y)",
        "dx9": "texCUBEbias(cube, float4(x3, y))",
        "urp": "SAMPLE_TEXTURECUBE_BIAS(cube, samplercube, x3, y)",
    },
    "textureLod(map, x2, y)": {
        "glsl": "textureLod(map, x2, y)",
        "hlsl": "map.SampleLevel(map_sampler, x2, y)",
        "wgsl": "textureSampleLevel(map, map_sampler, x2, y)",
        "dx9": "tex2Dlod(map, float4(x2, 0.0, y))",
        "urp": "SAMPLE_TEXTURE2D_LOD(map, samplermap, x2, y)",
    },
    "textureLod(volume, x3, y)": {
        "glsl": "textureLod(volume, x3, y)",
        "hlsl": "volume.SampleLevel(volume_sampler, x3, y)",
        "wgsl": "textureSampleLevel(volume, volume_sampler, x3, y)",
        "dx9": "tex3Dlod(volume, float4(x3, y))",
        "urp": "SAMPLE_TEXTURE3D_LOD(volume, samplervolume, x3, y)",
    },
    "textureLod(cube, x3, y)": {
        "glsl": "textureLod(cube, x3, y)",
        "hlsl": "cube.SampleLevel(cube_sampler, x3, y)",
        "wgsl": "textureSampleLevel(cube, cube_sampler, x3, y)",
        "dx9": "texCUBElod(cube, float4(x3, y))",
        "urp": "SAMPLE_TEXTURECUBE_LOD(cube, samplercube, x3, y)",
    },
    "textureGrad(map, x2, y2, z2)": {
        "glsl": "textureGrad(map, x2, y2, z2)",
        "hlsl": "map.SampleGrad(map_sampler, x2, y2, z2)",
        "wgsl": "textureSampleGrad(map, map_sampler, x2, y2, z2)",
        "dx9": "tex2Dgrad(map, x2, y2, z2)",
        "urp": "SAMPLE_TEXTURE2D_GRAD(map, samplermap, x2, y2, z2)",
    },
    "textureGrad(volume, x3, y3, z3)": {
        "glsl": "textureGrad(volume, x3, y3, z3)",
        "hlsl": "volume.SampleGrad(volume_sampler, x3, y3, z3)",
        "wgsl": "textureSampleGrad(volume, volume_sampler, x3, y3, z3)",
        "dx9": "tex3Dgrad(volume, x3, y3, z3)",
        "urp": "volume.SampleGrad(samplervolume, x3, y3, z3)",
    },
    "textureGrad(cube, x3, y3, z3)": {
        "glsl": "textureGrad(cube, x3, y3, z3)",
        "hlsl": "cube.SampleGrad(cube_sampler, x3, y3, z3)",
        "wgsl": "textureSampleGrad(cube, cube_sampler, x3, y3, z3)",
        "dx9": "texCUBEgrad(cube, x3, y3, z3)",
        "urp": "cube.SampleGrad(samplercube, x3, y3, z3)",
    },
    "texelFetch(map, i2, j)": {
        "glsl": "texelFetch(map, i2, j)",
        "hlsl": "map.Load(int3(i2, j))",
        "wgsl": "textureLoad(map, i2, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "LOAD_TEXTURE2D_LOD(map, i2, j)",
    },
    "texelFetch(volume, i3, j)": {
        "glsl": "texelFetch(volume, i3, j)",
        "hlsl": "volume.Load(int4(i3, j))",
        "wgsl": "textureLoad(volume, i3, j)",
        "dx9": "error: this target has no texelFetch (unity-builtin)",
        "urp": "LOAD_TEXTURE3D_LOD(volume, i3, j)",
    },
    "dFdx(x)": {"glsl": "dFdx(x)", "hlsl": "ddx(x)", "wgsl": "dpdx(x)"},
    "dFdx(x3)": {"glsl": "dFdx(x3)", "hlsl": "ddx(x3)", "wgsl": "dpdx(x3)"},
    "dFdy(x)": {"glsl": "dFdy(x)", "hlsl": "ddy(x)", "wgsl": "dpdy(x)"},
    "dFdy(x3)": {"glsl": "dFdy(x3)", "hlsl": "ddy(x3)", "wgsl": "dpdy(x3)"},
}

for name, op in RELATIONS.items():
    for x, y in ("x3", "y3"), ("i3", "j3"), ("u3", "w3"), *([("p3", "q3")] if op in ("==", "!=") else []):
        written = f"{x} {op} {y}"
        CASES[f"{name}({x}, {y})"] = {"glsl": f"{name}({x}, {y})", "hlsl": written, "wgsl": written}


def refusals(builtin: str, *targets: str) -> dict[str, str]:
    return {target: f"error: this target has no {builtin} ({TARGETS[target]})" for target in targets}


def sized(name: str) -> str:
    """The HLSL function for the size of a texture, and its call."""
    spelt = load("hlsl").types[SAMPLERS[name]]
    parts = "width, height" + ", depth" * ("3D" in spelt) + ", layers" * ("Array" in spelt)
    size = f"int{parts.count(',') + 1}"
    return f"""
{size} texture_size({spelt} map, int level) {{
    uint {parts}, levels;
    map.GetDimensions(level, {parts}, levels);
    return {size}({parts});
}}

return texture_size({name}, i);
"""


def levels(name: str) -> str:
    """The HLSL function for the number of levels, and its call."""
    spelt = load("hlsl").types[SAMPLERS[name]]
    parts = "width, height" + ", depth" * ("3D" in spelt) + ", layers" * ("Array" in spelt)
    return f"""
int texture_levels({spelt} map) {{
    uint {parts}, levels;
    map.GetDimensions(0, {parts}, levels);
    return int(levels);
}}

return texture_levels({name});
"""


SAMPLED = ("samples", "intsamples", "uintsamples")
"""The textures with several samples, which have no levels."""


def sample_sizes(name: str) -> str:
    return f"""
int2 texture_size({load("hlsl").types[SAMPLERS[name]]} map) {{
    uint width, height, samples;
    map.GetDimensions(width, height, samples);
    return int2(width, height);
}}

return texture_size({name});
"""


for name in SAMPLED:
    lacking = {
        "glsl-es": f"error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no {SAMPLERS[name]}",
        "urp": f"error: Unity, Universal Render Pipeline has no {SAMPLERS[name]}",
    }
    read, size = f"texelFetch({name}, i2, j)", f"textureSize({name})"
    CASES[read] = {"glsl": read, "hlsl": f"{name}.Load(i2, j)", "wgsl": f"textureLoad({name}, i2, j)"}
    CASES[size] = {"glsl": size, "hlsl": sample_sizes(name), "wgsl": f"vec2i(textureDimensions({name}))"}
    CASES[read] |= {**lacking, **refusals("texelFetch", "dx9")}
    CASES[size] |= {**lacking, **refusals("textureSize", "dx9")}
for name in [each for each in SAMPLERS if each not in SAMPLED]:
    size = "vec3i" if name.endswith(("volume", "layers", "cubes", "shades")) else "vec2i"
    read = f"{size}(textureDimensions({name}, i))"
    if name.endswith(("layers", "cubes", "shades")):
        read = f"vec3i(vec3u(textureDimensions({name}, i), textureNumLayers({name})))"
    expected = {"glsl": f"textureSize({name}, i)", "wgsl": read, "hlsl": sized(name), **refusals("textureSize", "dx9")}
    if SAMPLERS[name] in load("unity-urp").types:
        expected["urp"] = expected["hlsl"]
    else:
        expected["urp"] = f"error: Unity, Universal Render Pipeline has no {SAMPLERS[name]}"
    if name == "cubes":
        expected["glsl"] = "error: GLSL 3.30 (OpenGL 3.3 core) has no samplerCubeArray"
        expected["glsl-es"] = "error: GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0) has no samplerCubeArray"
    CASES[f"textureSize({name}, i)"] = expected
for name in "map", "volume", "cube", "layers":
    read = f"textureQueryLevels({name})"
    CASES[read] = {"wgsl": f"i32(textureNumLevels({name}))", **refusals("textureQueryLevels", "glsl-es", "dx9")}
    CASES[read] |= {"glsl": read, "hlsl": levels(name), "urp": levels(name)}
    if name == "layers":
        CASES[read]["urp"] = "error: Unity, Universal Render Pipeline has no sampler2DArray"

ALL = {
    **{text.strip(): {"glsl": text.strip()} for text in SAME.split(";")},
    **CASES,
    **LATER,
    **READS,
    **OFFSETS,
    **GATHERS,
}
