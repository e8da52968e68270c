// names
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef NAMES_HLSL_INCLUDED
#define NAMES_HLSL_INCLUDED

struct float3x3_ {
    float float3_;
    float2 half4_;
};

static const float lerp_ = 0.25;

static float buffer = 0.5;

float frac_(float fn, float let) {
    float var = fn + let;
    float self = var * lerp_;
    return self - floor(self);
}

float4 tone(float4 sample_) {
    float4 patch = sample_ * 2.0;
    float vec3f = patch.x;
    float ptr = patch.y;
    return float4(vec3f, ptr, patch.zw);
}

float saturate_(float matrix_) {
    float point_ = matrix_;
    float linear_ = 2.0;
    float pass_ = 3.0;
    return min(max(point_ * linear_, 0.0), pass_);
}

float lambda(float def, float None, float and_) {
    float f32 = def + None;
    return f32 * and_;
}

float members(float3x3_ register_) {
    register_.float3_ += 1.0;
    return register_.float3_ + register_.half4_.y;
}

float main_(float abs_, float max_1) {
    float a = abs(abs_);
    float a_1 = max(max_1, a);
    return a + a_1 + buffer;
}

float mul_(float x, float typedef_) {
    float cbuffer_ = x;
    float groupshared_ = typedef_;
    float loop = 1.0;
    float override = 2.0;
    float read = 3.0;
    float type = 4.0;
    return cbuffer_ + groupshared_ + loop + override + read + type;
}

#endif
