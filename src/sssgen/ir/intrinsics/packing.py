"""Packing of several numbers into a uint; the first component is in the low bits."""

from __future__ import annotations

import struct

from sssgen.ir.intrinsics.table import NOT_FINITE_BITS, Builtin, Samples
from sssgen.ir.vector_ranges import all_within, any_numbers

# A table: several fields to a line.
# fmt: off
ROWS = (
    Builtin("packSnorm2x16", ("uint(vec2)",),
        "Two numbers in [-1, 1], each as a signed 16-bit fraction of 32767.",
        es=300, componentwise=False, range=any_numbers, float32_bits=True, not_constant=("wgsl",),
        inside=lambda rt, x: abs(rt.fract(rt.clamp(x, -1.0, 1.0) * 32767.0) - 0.5) > 0.01,
        texts={"glsl-330": "", "hlsl": "", "wgsl": "pack2x16snorm", "wgsl-metal": ""},
        polyfill="""
uint packSnorm2x16(vec2 x) {
    ivec2 i = ivec2(round(clamp(x, -1.0, 1.0) * 32767.0));
    return (uint(i.x) & 0xffffu) | (uint(i.y) << 16u);
}
""",
        cost=9, vectors=((((-1.0, 1.0),), 0x7FFF8001), (((0.0, 0.0),), 0), (((4.0, -4.0),), 0x80017FFF)),
    ),
    Builtin("packUnorm2x16", ("uint(vec2)",), "Two numbers in [0, 1], each as a 16-bit fraction of 65535.",
        es=300, componentwise=False, range=any_numbers, float32_bits=True, not_constant=("wgsl",),
        inside=lambda rt, x: abs(rt.fract(rt.clamp(x, 0.0, 1.0) * 65535.0) - 0.5) > 0.01,
        texts={"glsl-330": "", "hlsl": "", "wgsl": "pack2x16unorm", "wgsl-metal": ""},
        polyfill="""
uint packUnorm2x16(vec2 x) {
    uvec2 u = uvec2(round(clamp(x, 0.0, 1.0) * 65535.0));
    return u.x | (u.y << 16u);
}
""",
        cost=8, vectors=((((0.0, 1.0),), 0xFFFF0000), (((0.0, 0.0),), 0), (((2.0, -1.0),), 0xFFFF)),
    ),
    Builtin("packHalf2x16", ("uint(vec2)",), "Two numbers as float16.",
        es=300, fold=lambda x: [int.from_bytes(struct.pack("<2e", *x), "little")], samples=Samples(halves=True), componentwise=False, range=any_numbers, float32_bits=True, not_constant=("wgsl",),
        inside=lambda rt, x: rt.unpackHalf2x16(rt.packHalf2x16(x)) == x,
        domain="representable in float16: the rounding is the target's",
        texts={"glsl-330": "", "hlsl": "dot(f32tof16({0}), uint2(1u, 65536u))", "hlsl-dx9": "", "wgsl": "pack2x16float", "wgsl-metal": ""},
        polyfill="""
uint packHalf2x16(vec2 x) {
    uvec2 bits = floatBitsToUint(abs(x));
    uvec2 normal = (bits - 0x37fff001u + ((bits >> 13u) & 1u)) >> 13u;
    uvec2 tiny = uvec2(round(abs(x) * 16777216.0));
    uvec2 halves = uvec2(bits.x < 0x38800000u ? tiny.x : normal.x, bits.y < 0x38800000u ? tiny.y : normal.y);
    halves |= (floatBitsToUint(x) >> 16u) & 0x8000u;
    return halves.x | (halves.y << 16u);
}
""",
        cost=3,
        vectors=((((1.0, -2.0),), 0xC0003C00), (((0.5, 0.0),), 0x3800), (((65504.0, 0.25),), 0x34007BFF)),
    ),
    Builtin("unpackSnorm2x16", ("vec2(uint)",),
        "Two numbers in [-1, 1] from signed 16-bit fractions of 32767.",
        es=300, float32_bits=True, not_constant=("wgsl",), componentwise=False, range=all_within(-1.0, 1.0),
        texts={"glsl-330": "", "hlsl": "", "wgsl": "unpack2x16snorm", "wgsl-metal": ""},
        polyfill="""
vec2 unpackSnorm2x16(uint x) {
    return clamp(vec2(float(int(x << 16u) >> 16), float(int(x) >> 16)) / 32767.0, -1.0, 1.0);
}
""",
        cost=4,
        vectors=(((0x80007FFF,), (1.0, -1.0)), ((0,), (0.0, 0.0)), ((0x4000,), (0.500015259254738, 0.0))),
    ),
    Builtin("unpackUnorm2x16", ("vec2(uint)",), "Two numbers in [0, 1] from 16-bit fractions of 65535.",
        es=300, float32_bits=True, not_constant=("wgsl",), componentwise=False, range=all_within(0.0, 1.0),
        texts={"glsl-330": "", "hlsl": "", "wgsl": "unpack2x16unorm", "wgsl-metal": ""},
        polyfill="vec2 unpackUnorm2x16(uint x) { return vec2(float(x & 65535u), float(x >> 16u)) / 65535.0; }",
        cost=3,
        vectors=(((0xFFFF,), (1.0, 0.0)), ((0,), (0.0, 0.0)), ((0x80000000,), (0.0, 0.5000076295109483))),
    ),
    Builtin("unpackHalf2x16", ("vec2(uint)",), "Two numbers from float16.",
        es=300, fold=lambda x: struct.unpack("<2e", x[0].to_bytes(4, "little")), float32_bits=True, not_constant=("wgsl",),
        componentwise=False, range=all_within(-65504.0, 65504.0),
        guards=(NOT_FINITE_BITS._replace(text=NOT_FINITE_BITS.text.replace("LARGEST", "65504.0")),),
        inside=lambda rt, x: abs(rt.unpackHalf2x16(x)) < 1e5,
        domain="both are finite",
        texts={
            "glsl-330": "", "hlsl": "f16tof32(({0}) >> uint2(0u, 16u))", "hlsl-dx9": "", "wgsl": "unpack2x16float", "wgsl-metal": "",
        },
        polyfill="""
vec2 unpackHalf2x16(uint x) {
    uvec2 halves = uvec2(x & 0xffffu, x >> 16u);
    uvec2 bits = halves & 0x7fffu;
    vec2 normal = uintBitsToFloat((bits << 13u) + 0x38000000u);
    vec2 tiny = vec2(bits) / 16777216.0;
    vec2 size = vec2(bits.x < 1024u ? tiny.x : normal.x, bits.y < 1024u ? tiny.y : normal.y);
    return uintBitsToFloat(floatBitsToUint(size) | ((halves & 0x8000u) << 16u));
}
""",
        cost=2,
        ulp=0.0, vectors=(((0xC0003C00,), (1.0, -2.0)), ((0x3800,), (0.5, 0.0)), ((0x34007BFF,), (65504.0, 0.25))),
    ),
    Builtin("packSnorm4x8", ("uint(vec4)",), "Four numbers in [-1, 1], each as a signed 8-bit fraction of 127.",
        es=310, componentwise=False, range=any_numbers, float32_bits=True, not_constant=("wgsl",),
        inside=lambda rt, x: abs(rt.fract(rt.clamp(x, -1.0, 1.0) * 127.0) - 0.5) > 0.01,
        texts={"glsl": "", "hlsl": "", "wgsl": "pack4x8snorm", "wgsl-metal": ""},
        polyfill="""
uint packSnorm4x8(vec4 x) {
    uvec4 u = uvec4(ivec4(round(clamp(x, -1.0, 1.0) * 127.0))) & 0xffu;
    return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
}
""",
        cost=5, vectors=(
            (((-1.0, 1.0, 0.0, 4.0),), 0x7F007F81), (((0.0, 0.0, 0.0, 0.0),), 0), (((0.5, -0.25, 0.0, -4.0),), 0x8100E040),
        ),
    ),
    Builtin("packUnorm4x8", ("uint(vec4)",), "Four numbers in [0, 1], each as an 8-bit fraction of 255.",
        es=310, componentwise=False, range=any_numbers, float32_bits=True, not_constant=("wgsl",),
        inside=lambda rt, x: abs(rt.fract(rt.clamp(x, 0.0, 1.0) * 255.0) - 0.5) > 0.01,
        texts={"glsl": "", "hlsl": "", "wgsl": "pack4x8unorm", "wgsl-metal": ""},
        polyfill="""
uint packUnorm4x8(vec4 x) {
    uvec4 u = uvec4(round(clamp(x, 0.0, 1.0) * 255.0));
    return u.x | (u.y << 8u) | (u.z << 16u) | (u.w << 24u);
}
""",
        cost=5, vectors=(
            (((0.0, 1.0, 0.25, 2.0),), 0xFF40FF00), (((0.0, 0.0, 0.0, 0.0),), 0), (((-1.0, 0.125, 0.0, 0.75),), 0xBF002000),
        ),
    ),
    Builtin("unpackSnorm4x8", ("vec4(uint)",), "Four numbers in [-1, 1] from signed 8-bit fractions of 127.",
        es=310, float32_bits=True, not_constant=("wgsl",), componentwise=False, range=all_within(-1.0, 1.0),
        texts={"glsl": "", "hlsl": "", "wgsl": "unpack4x8snorm", "wgsl-metal": ""},
        polyfill="""
vec4 unpackSnorm4x8(uint x) {
    ivec4 parts = ivec4(int(x << 24u), int(x << 16u), int(x << 8u), int(x)) >> 24u;
    return clamp(vec4(parts) / 127.0, -1.0, 1.0);
}
""",
        cost=5, vectors=(
            ((0x7F8081,), (-1.0, -1.0, 1.0, 0.0)), ((0,), (0.0, 0.0, 0.0, 0.0)), ((0x40000000,), (0.0, 0.0, 0.0, 0.5039370078740157)),
        ),
    ),
    Builtin("unpackUnorm4x8", ("vec4(uint)",), "Four numbers in [0, 1] from 8-bit fractions of 255.",
        es=310, float32_bits=True, not_constant=("wgsl",), componentwise=False, range=all_within(0.0, 1.0),
        texts={"glsl": "", "hlsl": "", "wgsl": "unpack4x8unorm", "wgsl-metal": ""},
        polyfill="""
vec4 unpackUnorm4x8(uint x) {
    return vec4(float(x & 255u), float((x >> 8u) & 255u), float((x >> 16u) & 255u), float(x >> 24u)) / 255.0;
}
""",
        cost=3, vectors=(
            ((0xFF00FF,), (1.0, 0.0, 1.0, 0.0)), ((0,), (0.0, 0.0, 0.0, 0.0)), ((0x80000000,), (0.0, 0.0, 0.0, 0.5019607843137255)),
        ),
    ),
)
