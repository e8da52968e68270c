// arrays
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef ARRAYS_HLSL_INCLUDED
#define ARRAYS_HLSL_INCLUDED

struct Lamp {
    float3 at;
    float power;
};

static const int COUNT = 4;
static const float WEIGHTS[3] = { 0.25, 0.5, 0.25 };
static const float2 CORNERS[4] = { (float2)0.0, float2(1.0, 0.0), float2(0.0, 1.0), (float2)1.0 };
static const Lamp LAMPS[2] = { { float3(0.0, 1.0, 0.0), 2.0 }, { float3(1.0, 0.0, 0.5), 0.5 } };

float weighted(float x, float y) {
    float given[3] = { x, y, x * y };
    float sum = 0.0;
    [unroll]
    for (int i = 0; i < 3; i++) {
        sum += given[i] * WEIGHTS[i];
    }
    return sum;
}

float2 corner(int i) {
    return CORNERS[i & 3] + 4.0;
}

float lamps(float3 p) {
    float light = 0.0;
    [unroll]
    for (int i = 0; i < 2; i++) {
        light += LAMPS[i].power / (1.0 + distance(p, LAMPS[i].at));
    }
    return light;
}

void powers(float x, out float made[4]) {
    made[0] = 1.0;
    [unroll]
    for (int i = 1; i < COUNT; i++) {
        made[i] = made[i - 1] * x;
    }
}

float sum(float values[4]) {
    return values[0] + values[1] + values[2] + values[3];
}

void doubled(inout float values[4]) {
    [unroll]
    for (int i = 0; i < COUNT; i++) {
        values[i] *= 2.0;
    }
}

float passed_on(float x) {
    float p[4];
    powers(x, p);
    float before = sum(p);
    doubled(p);
    float copy[4] = p;
    copy[0] = -1.0;
    return before + sum(p) * 10.0 + copy[0]
        + (copy[0] == p[0] && copy[1] == p[1] && copy[2] == p[2] && copy[3] == p[3] ? 1.0 : 0.0);
}

int lengths(float3 v, float4x4 m) {
    int n = COUNT * 2;
    int table[8];
    [loop]
    for (int i = 0; i < n; i++) {
        table[i] = i * i;
    }
    return table[3] + 8 * 100 + 3 * 1000;
}

#endif
