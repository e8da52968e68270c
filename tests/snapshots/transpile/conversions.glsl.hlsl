// conversions
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef CONVERSIONS_HLSL_INCLUDED
#define CONVERSIONS_HLSL_INCLUDED

static const float HALF = 1.0 / 2.0;
static const float THREE = 3.0;
static const uint BITS = 6u;

float as_float(int n) {
    return float(n);
}

uint as_uint(int n) {
    return uint(n & 255);
}

float operators(float x, int n, uint u) {
    float a = float(n) * x + 2.0;
    a -= float(n);
    a /= float(1 + n * n);
    return a + float(u) * 0.5 + (x > float(n) ? 1.0 : x) + THREE * HALF;
}

uint with_uints(int n, uint u) {
    uint a = uint(n & 7);
    a += 3u;
    a = u + uint(n);
    return (a ^ BITS) + (n > 0 ? u : 1u);
}

float3 vectors(int3 n, float3 v, uint3 u) {
    float3 w = (float3)n;
    w += (float3)(n * 2);
    float3 z = v * (float3)n - (float3)u;
    return w + z * 2.0 + float3((float2)n.xy, 1.0);
}

float arguments(int n) {
    return max(0.5, float(n)) + pow(2.0, 3.0) + clamp(float(n), 0.0, 1.5) + lerp(0.0, 1.0, 0.25)
        + as_float(3) + length(float2(float(n), 2.0));
}

float constructors(bool b, int n, uint u, float x) {
    return float(b) + float(u) + float(int(x)) + float(uint(abs(n))) + float(n != 0)
        + float2(float(b), float(n)).x + float(int2(int(x), n).x);
}

int truncated(float x) {
    return int(x * 4.0) + (-1) + int(uint2(3u, 1u).x);
}

#endif
