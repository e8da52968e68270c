// ends
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.

struct Hit {
    float t;
    int steps;
};

cbuffer Material : register(b3) {
    float limit;
    int rounds;
};

static float2 uv;
static float4 color;

// Discards in loops: a discarded invocation must end in every language.
Hit march(float start) {
    float t = start;
    [unroll]
    for (int i = 0; i < 8; i++) {
        if (t > limit) {
            discard;
            Hit hit = { 0.0, 0 };
            return hit;
        }
        t += 0.25;
    }
    Hit hit_2 = { t, 8 };
    return hit_2;
}

float below(float x) {
    if (x < limit) {
        return x;
    }
    discard;
    return 0.0;
}

float either(float x) {
    if (x < limit) {
        discard;
    } else {
        return 2.0 * x;
    }
    return 0.0;
}

void main_() {
    color = float4(march(uv.x).t, below(uv.y), either(uv.x), 1.0);
    [loop]
    for (; ; ) {
        color.x += 0.5;
        if (color.x > limit) {
            break;
        }
    }
    if (rounds > 50) {
        [loop]
        for (; ; ) {
            color.z += uv.x;
            discard;
            return;
        }
    }
}

float4 fragment_main(float2 uv_in : UV) : SV_Target0 {
    uv = uv_in;
    main_();
    return color;
}
