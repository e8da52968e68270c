// state
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef STATE_HLSL_INCLUDED
#define STATE_HLSL_INCLUDED

static int seed = 17;
static float3 tint = float3(1.0, 0.5, 0.25);
static float3 last;
static float history[3];

float random() {
    seed = (seed * 1103 + 12345) & 65535;
    return float(seed) / 65536.0;
}

float2 random2() {
    float random_value = random();
    float random_value_2 = random();
    return float2(random_value, random_value_2);
}

float use(float x) {
    seed = int(x * 100.0) & 255;
    float2 p = random2();
    last = tint * p.x;
    float random_value = random();
    float random_value_2 = random();
    last.y += random_value - random_value_2;
    return last.x + last.y + p.y;
}

float remember(float x) {
    [unroll]
    for (int i = 2; i > 0; i--) {
        history[i] = history[i - 1];
    }
    history[0] = x;
    return history[0] + history[1] * 2.0;
}

float shadows(float tint) {
    float x = tint;
    float x_2 = 2.0;
    float tint_2 = x_2 * 3.0;
    if (x_2 > 1.0) {
        int x_3 = 4;
        tint_2 += float(x_3);
    }
    last.x = tint_2;
    [unroll]
    for (int x_3 = 0; x_3 < 2; x_3++) {
        last.x += float(x_3);
    }
    return x + last.x;
}

#endif
