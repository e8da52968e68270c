// macros
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef MACROS_HLSL_INCLUDED
#define MACROS_HLSL_INCLUDED

static const float PI = 3.14159265;
static const float TAU = 2.0 * PI;
static const int STEPS = 6;
static const int ROUNDS = STEPS * 2;

// The distance to a ball.
float sphere(float3 p, float radius) {
    return length(p) - radius;
}

// The distance to a box.
float box(float3 p, float3 half_size) {
    float3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// A scene: a ball
// on the ground.
float scene(float3 p) {
    float ball = sphere(p - float3(0.0, 0.5, 0.0), 0.5);  // what stands
    p.xz = mul(float2x2(cos(PI * 0.25), -sin(PI * 0.25), sin(PI * 0.25), cos(PI * 0.25)), p.xz);
    return min(ball, box(p, float3(2.0, 0.1, 2.0)));
}

float shadow(float3 from, float3 to) {
    float light = 1.0;
    float t = 0.02;
    [loop]
    for (int i = 0; i < ROUNDS; i++) {
        float d = scene(from + to * t);
        light = min(light, clamp(8.0 * d / t, 0.0, 1.0));
        t += max(d, 0.02);
    }
    return clamp(light, 0.0, 1.0);
}

float3 swapped(float3 a, float3 b) {
    float part1 = TAU;
    float3 kept = a;
    a = b;
    b = kept;
    return a + 2.0 * b + part1;
}

int three() {
    return 3;
}

#endif
