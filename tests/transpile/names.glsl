#version 130
// Names that are words of a later GLSL, or of another language.

struct float3x3 {
    float float3;
    vec2 half4;
};

float buffer = 0.5;
const float lerp = 0.25;

float frac(float fn, float let) {
    float var = fn + let;
    float self = var * lerp;
    return self - floor(self);
}

vec4 tone(vec4 sample) {
    vec4 patch = sample * 2.0;
    float vec3f = patch.x, ptr = patch.y;
    return vec4(vec3f, ptr, patch.zw);
}

float saturate(float matrix) {
    float point = matrix, linear = 2.0, pass = 3.0;
    return min(max(point * linear, 0.0), pass);
}

float lambda(float def, float None, float and) {
    float f32 = def + None;
    return f32 * and;
}

float members(float3x3 register) {
    register.float3 += 1.0;
    return register.float3 + register.half4.y;
}

float main_(float abs_, float max_1) {
    float a = abs(abs_);
    float a_1 = max(max_1, a);
    return a + a_1 + buffer;
}

float mul(float x, float typedef_) {
    float cbuffer = x, groupshared = typedef_, loop = 1.0, override = 2.0, read = 3.0, type = 4.0;
    return cbuffer + groupshared + loop + override + read + type;
}
