// names
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct float3x3 {
    float float3;
    vec2 half4;
};

const float lerp = 0.25;

float buffer_ = 0.5;

float frac(float fn, float let) {
    float var = fn + let;
    float self = var * lerp;
    return self - floor(self);
}

vec4 tone(vec4 sample_) {
    vec4 patch_ = sample_ * 2.0;
    float vec3f = patch_.x;
    float ptr = patch_.y;
    return vec4(vec3f, ptr, patch_.zw);
}

float saturate(float matrix) {
    float point = matrix;
    float linear = 2.0;
    float pass = 3.0;
    return min(max(point * linear, 0.0), pass);
}

float lambda(float def, float None, float and) {
    float f32 = def + None;
    return f32 * and;
}

float members(float3x3 register_) {
    register_.float3 += 1.0;
    return register_.float3 + register_.half4.y;
}

float main_(float abs_, float max_1) {
    float a = abs(abs_);
    float a_1 = max(max_1, a);
    return a + a_1 + buffer_;
}

float mul(float x, float typedef_) {
    float cbuffer = x;
    float groupshared = typedef_;
    float loop = 1.0;
    float override = 2.0;
    float read = 3.0;
    float type = 4.0;
    return cbuffer + groupshared + loop + override + read + type;
}
