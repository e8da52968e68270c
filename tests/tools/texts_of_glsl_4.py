"""The texts of the builtins of GLSL 4.00 to 4.60 in the targets; a part of texts_of_builtins.py."""

from __future__ import annotations

LATER = {
    "fma(x3, y3, z3)": {"glsl": "x3 * y3 + z3", "hlsl": "x3 * y3 + z3"},
    "ldexp(x3, i3)": {
        "glsl": """
            vec3 ldexp_(vec3 x, ivec3 y) {
                ivec3 whole = clamp(y, -252, 254);
                ivec3 part = whole >> 1u;
                return x * intBitsToFloat((part + 127) << 23u) * intBitsToFloat((whole - part + 127) << 23u);
            }

            return ldexp_(x3, i3);
        """,
        "hlsl": """
            float3 ldexp_(float3 x, int3 y) {
                int3 whole = clamp(y, -252, 254);
                int3 part = whole >> 1u;
                return x * asfloat((part + 127) << 23u) * asfloat((whole - part + 127) << 23u);
            }

            return ldexp_(x3, i3);
        """,
    },
    "mix(i3, j3, p3)": {
        "glsl": "ivec3(p3.x ? j3.x : i3.x, p3.y ? j3.y : i3.y, p3.z ? j3.z : i3.z)",
        "hlsl": "int3(p3.x ? j3.x : i3.x, p3.y ? j3.y : i3.y, p3.z ? j3.z : i3.z)",
        "wgsl": "select(i3, j3, p3)",
    },
    "mix(u3, v3, p3)": {
        "glsl": "uvec3(p3.x ? v3.x : u3.x, p3.y ? v3.y : u3.y, p3.z ? v3.z : u3.z)",
        "hlsl": "uint3(p3.x ? v3.x : u3.x, p3.y ? v3.y : u3.y, p3.z ? v3.z : u3.z)",
        "wgsl": "select(u3, v3, p3)",
    },
    "mix(p3, q3, p3)": {
        "glsl": "bvec3(p3.x ? q3.x : p3.x, p3.y ? q3.y : p3.y, p3.z ? q3.z : p3.z)",
        "hlsl": "bool3(p3.x ? q3.x : p3.x, p3.y ? q3.y : p3.y, p3.z ? q3.z : p3.z)",
        "wgsl": "select(p3, q3, p3)",
    },
    "bitCount(i3)": {
        "glsl": """
            ivec3 bitCount_(ivec3 x) {
                uvec3 bits = uvec3(x);
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return ivec3((bits * 0x1010101u) >> 24u);
            }

            return bitCount_(i3);
        """,
        "hlsl": "int3(countbits(asuint(i3)))",
        "wgsl": "countOneBits(i3)",
        "dx9": """
            int3 bitCount_(int3 x) {
                uint3 bits = (uint3)x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return (int3)((bits * 0x1010101u) >> 24u);
            }

            return bitCount_(i3);
        """,
    },
    "bitCount(u)": {
        "glsl": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            return bitCount_(u);
        """,
        "hlsl": "int(countbits(u))",
        "wgsl": "i32(countOneBits(u))",
        "dx9": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            return bitCount_(u);
        """,
    },
    "findLSB(i)": {
        "glsl": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            int findLSB_(int x) {
                uint bits = uint(x);
                int count = bitCount_(~bits & (bits - 1u));
                return count | -(count >> 5u);
            }

            return findLSB_(i);
        """,
        "hlsl": "int(firstbitlow(i))",
        "wgsl": "firstTrailingBit(i)",
        "dx9": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            int findLSB_(int x) {
                uint bits = uint(x);
                int count = bitCount_(~bits & (bits - 1u));
                return count | -(count >> 5u);
            }

            return findLSB_(i);
        """,
    },
    "findLSB(u3)": {
        "glsl": """
            ivec3 bitCount_(uvec3 x) {
                uvec3 bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return ivec3((bits * 0x1010101u) >> 24u);
            }

            ivec3 findLSB_(uvec3 x) {
                uvec3 bits = x;
                ivec3 count = bitCount_(~bits & (bits - 1u));
                return count | -(count >> 5u);
            }

            return findLSB_(u3);
        """,
        "hlsl": "int3(firstbitlow(u3))",
        "wgsl": "vec3i(firstTrailingBit(u3))",
        "dx9": """
            int3 bitCount_(uint3 x) {
                uint3 bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return (int3)((bits * 0x1010101u) >> 24u);
            }

            int3 findLSB_(uint3 x) {
                uint3 bits = x;
                int3 count = bitCount_(~bits & (bits - 1u));
                return count | -(count >> 5u);
            }

            return findLSB_(u3);
        """,
    },
    "findMSB(i3)": {
        "glsl": """
            ivec3 bitCount_(uvec3 x) {
                uvec3 bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return ivec3((bits * 0x1010101u) >> 24u);
            }

            ivec3 findMSB_(ivec3 x) {
                uvec3 bits = uvec3(x ^ (x >> 31u));
                bits |= bits >> 1u;
                bits |= bits >> 2u;
                bits |= bits >> 4u;
                bits |= bits >> 8u;
                bits |= bits >> 16u;
                return bitCount_(bits) - 1;
            }

            return findMSB_(i3);
        """,
        "hlsl": """
            int3 findMSB_(int3 x) {
                uint3 bits = (uint3)(x ^ (x >> 31u));
                bits |= bits >> 1u;
                bits |= bits >> 2u;
                bits |= bits >> 4u;
                bits |= bits >> 8u;
                bits |= bits >> 16u;
                return int3(countbits(bits)) - 1;
            }

            return findMSB_(i3);
        """,
        "wgsl": "firstLeadingBit(i3)",
        "dx9": """
            int3 bitCount_(uint3 x) {
                uint3 bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return (int3)((bits * 0x1010101u) >> 24u);
            }

            int3 findMSB_(int3 x) {
                uint3 bits = (uint3)(x ^ (x >> 31u));
                bits |= bits >> 1u;
                bits |= bits >> 2u;
                bits |= bits >> 4u;
                bits |= bits >> 8u;
                bits |= bits >> 16u;
                return bitCount_(bits) - 1;
            }

            return findMSB_(i3);
        """,
    },
    "findMSB(u)": {
        "glsl": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            int findMSB_(uint x) {
                uint bits = x;
                bits |= bits >> 1u;
                bits |= bits >> 2u;
                bits |= bits >> 4u;
                bits |= bits >> 8u;
                bits |= bits >> 16u;
                return bitCount_(bits) - 1;
            }

            return findMSB_(u);
        """,
        "hlsl": "int(firstbithigh(u))",
        "wgsl": "i32(firstLeadingBit(u))",
        "dx9": """
            int bitCount_(uint x) {
                uint bits = x;
                bits -= (bits >> 1u) & 0x55555555u;
                bits = (bits & 0x33333333u) + ((bits >> 2u) & 0x33333333u);
                bits = (bits + (bits >> 4u)) & 0xf0f0f0fu;
                return int((bits * 0x1010101u) >> 24u);
            }

            int findMSB_(uint x) {
                uint bits = x;
                bits |= bits >> 1u;
                bits |= bits >> 2u;
                bits |= bits >> 4u;
                bits |= bits >> 8u;
                bits |= bits >> 16u;
                return bitCount_(bits) - 1;
            }

            return findMSB_(u);
        """,
    },
    "bitfieldReverse(i)": {
        "glsl": """
            int bitfieldReverse_(int x) {
                uint bits = uint(x);
                bits = ((bits >> 1u) & 0x55555555u) | ((bits & 0x55555555u) << 1u);
                bits = ((bits >> 2u) & 0x33333333u) | ((bits & 0x33333333u) << 2u);
                bits = ((bits >> 4u) & 0xf0f0f0fu) | ((bits & 0xf0f0f0fu) << 4u);
                bits = ((bits >> 8u) & 0xff00ffu) | ((bits & 0xff00ffu) << 8u);
                return int((bits >> 16u) | (bits << 16u));
            }

            return bitfieldReverse_(i);
        """,
        "hlsl": "asint(reversebits(asuint(i)))",
        "wgsl": "reverseBits(i)",
        "dx9": """
            int bitfieldReverse_(int x) {
                uint bits = uint(x);
                bits = ((bits >> 1u) & 0x55555555u) | ((bits & 0x55555555u) << 1u);
                bits = ((bits >> 2u) & 0x33333333u) | ((bits & 0x33333333u) << 2u);
                bits = ((bits >> 4u) & 0xf0f0f0fu) | ((bits & 0xf0f0f0fu) << 4u);
                bits = ((bits >> 8u) & 0xff00ffu) | ((bits & 0xff00ffu) << 8u);
                return int((bits >> 16u) | (bits << 16u));
            }

            return bitfieldReverse_(i);
        """,
    },
    "bitfieldReverse(u3)": {
        "glsl": """
            uvec3 bitfieldReverse_(uvec3 x) {
                uvec3 bits = x;
                bits = ((bits >> 1u) & 0x55555555u) | ((bits & 0x55555555u) << 1u);
                bits = ((bits >> 2u) & 0x33333333u) | ((bits & 0x33333333u) << 2u);
                bits = ((bits >> 4u) & 0xf0f0f0fu) | ((bits & 0xf0f0f0fu) << 4u);
                bits = ((bits >> 8u) & 0xff00ffu) | ((bits & 0xff00ffu) << 8u);
                return (bits >> 16u) | (bits << 16u);
            }

            return bitfieldReverse_(u3);
        """,
        "hlsl": "reversebits(u3)",
        "wgsl": "reverseBits(u3)",
        "dx9": """
            uint3 bitfieldReverse_(uint3 x) {
                uint3 bits = x;
                bits = ((bits >> 1u) & 0x55555555u) | ((bits & 0x55555555u) << 1u);
                bits = ((bits >> 2u) & 0x33333333u) | ((bits & 0x33333333u) << 2u);
                bits = ((bits >> 4u) & 0xf0f0f0fu) | ((bits & 0xf0f0f0fu) << 4u);
                bits = ((bits >> 8u) & 0xff00ffu) | ((bits & 0xff00ffu) << 8u);
                return (bits >> 16u) | (bits << 16u);
            }

            return bitfieldReverse_(u3);
        """,
    },
    "bitfieldExtract(i3, j, k)": {
        "glsl": "k == 0 ? ivec3(0) : (i3 << (uint(32 - j - k) & 31u)) >> (uint(32 - k) & 31u)",
        "hlsl": "k == 0 ? (int3)0 : (i3 << (uint(32 - j - k) & 31u)) >> (uint(32 - k) & 31u)",
        "wgsl": "extractBits(i3, u32(j), u32(k))",
    },
    "bitfieldExtract(u, i, j)": {
        "glsl": "j == 0 ? 0u : (u << (uint(32 - i - j) & 31u)) >> (uint(32 - j) & 31u)",
        "hlsl": "j == 0 ? 0u : (u << (uint(32 - i - j) & 31u)) >> (uint(32 - j) & 31u)",
        "wgsl": "extractBits(u, u32(i), u32(j))",
    },
    "bitfieldInsert(i, j, k, k)": {
        "glsl": """
            int bitfieldInsert_(int x, int y, int z, int w) {
                int mask = int((w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u));
                return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
            }

            return bitfieldInsert_(i, j, k, k);
        """,
        "hlsl": """
            int bitfieldInsert_(int x, int y, int z, int w) {
                int mask = int((w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u));
                return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
            }

            return bitfieldInsert_(i, j, k, k);
        """,
        "wgsl": "insertBits(i, j, u32(k), u32(k))",
    },
    "bitfieldInsert(u3, v3, i, j)": {
        "glsl": """
            uvec3 bitfieldInsert_(uvec3 x, uvec3 y, int z, int w) {
                uvec3 mask = uvec3((w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u));
                return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
            }

            return bitfieldInsert_(u3, v3, i, j);
        """,
        "hlsl": """
            uint3 bitfieldInsert_(uint3 x, uint3 y, int z, int w) {
                uint3 mask = (uint3)((w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u));
                return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
            }

            return bitfieldInsert_(u3, v3, i, j);
        """,
        "wgsl": "insertBits(u3, v3, u32(i), u32(j))",
    },
    "packSnorm4x8(x4)": {
        "glsl": """
            uint packSnorm4x8_(vec4 x) {
                uvec4 u = uvec4(ivec4(roundEven(clamp(x, -1.0, 1.0) * 127.0))) & 255u;
                return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
            }

            return packSnorm4x8_(x4);
        """,
        "hlsl": """
            uint packSnorm4x8_(float4 x) {
                uint4 u = (uint4)((int4)round(clamp(x, -1.0, 1.0) * 127.0)) & 255u;
                return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
            }

            return packSnorm4x8_(x4);
        """,
        "wgsl": "pack4x8snorm(x4)",
    },
    "packUnorm4x8(x4)": {
        "glsl": """
            uint packUnorm4x8_(vec4 x) {
                uvec4 u = uvec4(roundEven(clamp(x, 0.0, 1.0) * 255.0));
                return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
            }

            return packUnorm4x8_(x4);
        """,
        "hlsl": """
            uint packUnorm4x8_(float4 x) {
                uint4 u = (uint4)round(clamp(x, 0.0, 1.0) * 255.0);
                return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
            }

            return packUnorm4x8_(x4);
        """,
        "wgsl": "pack4x8unorm(x4)",
    },
    "unpackSnorm4x8(u)": {
        "glsl": """
            vec4 unpackSnorm4x8_(uint x) {
                ivec4 parts = ivec4(int(x << 24u), int(x << 16u), int(x << 8u), int(x)) >> 24u;
                return clamp(vec4(parts) / 127.0, -1.0, 1.0);
            }

            return unpackSnorm4x8_(u);
        """,
        "hlsl": """
            float4 unpackSnorm4x8_(uint x) {
                int4 parts = int4(int(x << 24u), int(x << 16u), int(x << 8u), int(x)) >> 24u;
                return clamp((float4)parts / 127.0, -1.0, 1.0);
            }

            return unpackSnorm4x8_(u);
        """,
        "wgsl": "unpack4x8snorm(u)",
    },
    "unpackUnorm4x8(u)": {
        "glsl": "vec4(float(u & 255u), float((u >> 8u) & 255u), float((u >> 16u) & 255u), float(u >> 24u)) / 255.0",
        "hlsl": "float4(float(u & 255u), float((u >> 8u) & 255u), float((u >> 16u) & 255u), float(u >> 24u)) / 255.0",
        "wgsl": "unpack4x8unorm(u)",
    },
    "dFdxFine(x3)": {"glsl": "dFdx(x3)", "hlsl": "ddx_fine(x3)", "wgsl": "dpdxFine(x3)", "dx9": "ddx(x3)"},
    "dFdyFine(x3)": {"glsl": "dFdy(x3)", "hlsl": "ddy_fine(x3)", "wgsl": "dpdyFine(x3)", "dx9": "ddy(x3)"},
    "fwidthFine(x3)": {"glsl": "fwidth(x3)", "hlsl": "abs(ddx_fine(x3)) + abs(ddy_fine(x3))", "dx9": "fwidth(x3)"},
    "dFdxCoarse(x3)": {"glsl": "dFdx(x3)", "hlsl": "ddx_coarse(x3)", "wgsl": "dpdxCoarse(x3)", "dx9": "ddx(x3)"},
    "dFdyCoarse(x3)": {"glsl": "dFdy(x3)", "hlsl": "ddy_coarse(x3)", "wgsl": "dpdyCoarse(x3)", "dx9": "ddy(x3)"},
    "fwidthCoarse(x3)": {
        "glsl": "fwidth(x3)",
        "hlsl": "abs(ddx_coarse(x3)) + abs(ddy_coarse(x3))",
        "dx9": "fwidth(x3)",
    },
}
