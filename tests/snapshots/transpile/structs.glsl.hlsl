// structs
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef STRUCTS_HLSL_INCLUDED
#define STRUCTS_HLSL_INCLUDED

struct Wave {
    float height;
    float length_;
    float2 towards;
};

struct Foam {
    float3 color;
    float amount;
};

struct Sea {
    Wave waves[2];
    Foam foam;
    float2x2 frame;
};

struct Unnamed {
    float gain;
    float2 offset;
};

struct Level {
    int count;
    float bias;
};

struct Local {
    float kept;
};

static const Level LEVEL = { 2, 0.25 };

static Wave first = { 1.0, 2.0, float2(1.0, 0.0) };
static Wave second;
static Unnamed settings;

float surface(Sea sea, float2 p) {
    float sum = LEVEL.bias;
    [loop]
    for (int i = 0; i < LEVEL.count; i++) {
        Wave wave = sea.waves[i];
        sum += wave.height * sin(dot(mul(p, sea.frame), wave.towards) / (abs(wave.length_) + 1.0));
    }
    return sum + sea.foam.amount * sea.foam.color.g;
}

Sea calm(float x) {
    Local local = { x };
    second = first;
    second.towards.y = local.kept;
    settings.gain = 0.5;
    settings.offset = (float2)x;
    Sea sea;
    sea.waves[0] = first;
    sea.waves[1] = second;
    sea.waves[1].height *= settings.gain;
    sea.foam.color = (float3)x;
    sea.foam.amount = settings.offset.x;
    sea.frame = float2x2(1.0, x, -x, 1.0);
    return sea;
}

float of_both(float2 p, float x) {
    Sea calm_value = calm(x);
    Sea calm_value_2 = calm(p.y);
    return surface(calm_value, p) + surface(calm_value_2, (float2)x);
}

#endif
