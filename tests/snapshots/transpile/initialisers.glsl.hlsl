// initialisers
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef INITIALISERS_HLSL_INCLUDED
#define INITIALISERS_HLSL_INCLUDED

struct Material_ {
    float3 colour;
    float rough;
};

struct Scene {
    Material_ materials[2];
    float2x2 turn;
    int count;
};

static const Material_ WAX = { float3(1.0, 0.5, 0.25), 0.75 };
static const float2 TABLE[2] = { float2(1.0, 2.0), (float2)4.0 };

float in_braces(float x, int i) {
    float3 v = float3(x, 1.0, 2.0);
    float list[3] = { x, 2.0, 3.0 };
    float open[2] = { 1.0, x };
    float2x2 m = float2x2(float2(1.0, x), float2(0.0, 1.0));
    Material_ material = { v, 0.5 };
    Scene scene = { { material, { (float3)x, 1.0 } }, m, 2 };
    float2 p = mul(float2(list[i & 1], open[1]), scene.turn);
    return p.x + p.y + scene.materials[i & 1].colour.z + scene.materials[1].rough + float(scene.count);
}

float of_constants(int i) {
    return TABLE[i & 1][1] + TABLE[1][0] + WAX.colour.y;
}

#endif
