// oblong_matrices
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef OBLONG_MATRICES_HLSL_INCLUDED
#define OBLONG_MATRICES_HLSL_INCLUDED

struct Pose {
    float4x3 frame;
    float2x4 parts[2];
};

static const float2x3 BASIS = float2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);

float3 skinned(float3 p, float w, float4x3 bones[2]) {
    return mul(float4(p, 1.0), bones[0] * w + bones[1] * (1.0 - w));
}

float2 projected(float3 p, float3x2 to_uv) {
    return mul(p, to_uv) + mul(BASIS, p) + mul(p, transpose(BASIS));
}

float4 blended(float4 q, float2 w, float2x4 dual) {
    float2 both = mul(dual, q);
    return mul(w, dual) + float4(both, both);
}

float3x4 flipped(float4x3 m) {
    return transpose(m);
}

float2x3 spread(float3 a, float2 b) {
    return float2x3(a * b.x, a * b.y);
}

float4x2 product(float3x2 a, float4x3 b) {
    return mul(b, a);
}

float4x3 column_set(float4x3 m, int i, float3 v, float scale) {
    m = float4x3(i == 0 ? v : m[0], i == 1 ? v : m[1], i == 2 ? v : m[2], i == 3 ? v : m[3]);
    m[3].xy *= scale;
    m[0][2] += 1.0;
    return m;
}

float3x4 resized(float2x3 a, float4x4 b, float s) {
    float3x4 wide = float3x4(float4(a[0], 0.0), float4(a[1], 0.0), float4(0.0, 0.0, 1.0, 0.0));
    wide += float3x4(b[0], b[1], b[2]) - float3x4(s, 0.0, 0.0, 0.0, 0.0, s, 0.0, 0.0, 0.0, 0.0, s, 0.0);
    return -wide / 2.0;
}

float2x4 pieces(float3 a, float b, float4 c) {
    return float2x4(a, b, c.wzyx);
}

bool same(float3x2 a, float3x2 b) {
    float3x2 compared = float3x2(a[0] * b[0], a[1] * b[1], a[2] * b[2]);
    return (all(a[0] == b[0]) && all(a[1] == b[1]) && all(a[2] == b[2]))
        || (any(compared[0] != a[0]) || any(compared[1] != a[1]) || any(compared[2] != a[2]));
}

float4 posed(Pose pose, float3 p) {
    float2x4 sum = pose.parts[0] + pose.parts[1];
    return float4(mul(float4(p, 1.0), pose.frame), 1.0) + sum[1] + float(2 + 4);
}

void swap(inout float2x3 m) {
    float3 first = m[0];
    m = float2x3(m[1], first);
}

float3 swapped(float2x3 m, float2 v) {
    swap(m);
    return mul(v, m);
}

#endif
