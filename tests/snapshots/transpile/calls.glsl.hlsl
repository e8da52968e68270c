// calls
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef CALLS_HLSL_INCLUDED
#define CALLS_HLSL_INCLUDED

float soft(float x) {
    return smoothstep(0.0, 1.0, x);
}

float2 soft(float2 v) {
    return float2(soft(v.x), soft(v.y));
}

float3 soft(float3 v) {
    return float3(soft(v.xy), soft(v.z));
}

int soft(int n) {
    return n > 0 ? 1 : 0;
}

void split(float x, out float whole, out float part) {
    whole = floor(x);
    part = x - whole;
}

void grow(inout float3 v, float by, float again) {
    v *= by;
    v += again;
}

void nothing() {
    return;
}

float directions(float3 v, float x) {
    float whole;
    float part;
    split(x * 3.0, whole, part);
    float3 kept = v;
    grow(kept, 2.0, part);
    grow(v, part, whole);
    nothing();
    return whole + part * 10.0 + dot(kept, v);
}

float into_parts(float4 v) {
    float list[2];
    split(v.x, v.y, v.z);
    split(v.w, list[0], list[1]);
    return v.y + v.z * 2.0 + list[0] * 3.0 + list[1];
}

float later(float x) {
    if (x < 0.0) {
        return -x;
    }
    return soft(x) + float(soft(int(x)));
}

float changes_its_own(float x) {
    x += 1.0;
    x = later(x);
    return x;
}

float3 all_(float x) {
    return soft((float3)x) + float3(soft(float2(x, 0.5)), directions((float3)x, x));
}

#endif
