// matrices
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef MATRICES_HLSL_INCLUDED
#define MATRICES_HLSL_INCLUDED

// Matrices: columns, arithmetic, and making one from another.
float2x2 turned(float a) {
    float s = sin(a);
    float c = cos(a);
    return float2x2(c, s, -s, c);
}

float2 around(float2 p, float a) {
    p = mul(turned(a), p);
    return mul(p, turned(-a)) + mul(turned(a), p);
}

float3x3 from_columns(float3 x, float3 y) {
    float3x3 m = float3x3(x, y, cross(x, y));
    return mul(m, transpose(m)) + m - float3x3(0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5) * 2.0;
}

float4x4 grown(float3x3 m, float3 move) {
    float4x4 all_ = float4x4(float4(m[0], 0.0), float4(m[1], 0.0), float4(m[2], 0.0),
        float4(0.0, 0.0, 0.0, 1.0));
    all_[3].xyz = move;
    return all_;
}

float3x3 cut(float4x4 m) {
    return float3x3(m[0].xyz, m[1].xyz, m[2].xyz) / 2.0;
}

float4 mixed(float2x2 m, float4 v) {
    return float4(m[0], m[1]) * v;
}

float entries(float3x3 m, int i) {
    float3 column = m[i & 1];
    return column.y + m[2].x + m[0][1] + float3x3(m[0] * m[0], m[1] * m[1], m[2] * m[2])[1][1];
}

float inverted(float2x2 m) {
    float2x2 safe = m + float2x2(3.0, 0.0, 0.0, 3.0);
    return determinant(safe)
        + (float2x2(safe[1].y, -safe[0].y, -safe[1].x, safe[0].x)
        * (1.0 / (safe[0].x * safe[1].y - safe[1].x * safe[0].y)))[0].x;
}

float3x3 outer(float3 a, float3 b) {
    float3x3 m = float3x3(a * b.x, a * b.y, a * b.z);
    m += 1.0;
    m = mul(m, m);
    m -= float3x3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    return -m;
}

float2x2 spelled_twice(float4x4 m) {
    return float2x2(m[0].xy, m[1].zw);
}

float2x2 of_parts(float2 v, float3 w, float x) {
    float2x2 m = float2x2(v, -v.y, v.x);
    return mul(float2x2(x, v, x), mul(float2x2(w, x), m));
}

float3x3 of_more_parts(float2 v, float4 w) {
    return float3x3(v, w, w.xy, 1.0) - float3x3(v * 2.0, w.x, w.yzw, v, 1.0);
}

#endif
