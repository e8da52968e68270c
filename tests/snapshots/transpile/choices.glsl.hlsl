// choices
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef CHOICES_HLSL_INCLUDED
#define CHOICES_HLSL_INCLUDED

struct Two {
    float a;
    float2 b;
};

float3 mix(float3 x, float3 y, bool3 a) {
    return float3(a.x ? y.x : x.x, a.y ? y.y : x.y, a.z ? y.z : x.z);
}

float ldexp_(float x, int y) {
    int whole = clamp(y, -252, 254);
    int part = whole >> 1u;
    return x * asfloat((part + 127) << 23u) * asfloat((whole - part + 127) << 23u);
}

float modf_(float x, out float whole) {
    whole = trunc(x);
    return x - whole;
}

float frexp_(float x, out int exponent) {
    uint bits = asuint(x);
    int biased = int((bits >> 23u) & 255u);
    int normal = min(biased, 1);
    exponent = (biased - 126) * normal;
    return asfloat((bits & 0x80000000u) | (((bits & 0x7fffffu) | 0x3f000000u) * uint(normal)));
}

float3 by_bools(float3 a, float3 b) {
    return mix(a, b, a < b) + mix((float3)0.0, (float3)1.0, bool3(true, a.x > b.x, false));
}

bool2 logic(float2 a, float2 b) {
    bool2 less = a <= b;
    return all(!less == bool2(all(less), any(less))) ? less : a > b;
}

float parts(float x) {
    float whole;
    float part = modf_(x * 5.0, whole);
    return whole * 10.0 + part;
}

float powers_of_two(float x) {
    int power;
    float significand = frexp_(x + 3.0, power);
    return significand + float(power) * 4.0 + ldexp_(significand, 2);
}

float at_once(float a, float b, float c) {
    return a * b + c + (b * c + 1.0);
}

Two structs(bool first, float x) {
    Two made;
    if (first) {
        Two two = { x, (float2)1.0 };
        made = two;
    } else {
        Two two_2 = { 1.0, (float2)x };
        made = two_2;
    }
    made.b = x > 0.0 ? made.b.yx : x < -0.5 ? (float2)0.25 : made.b + 1.0;
    return made;
}

float lazily(float x) {
    return x > 0.0 ? sqrt(x) : x == 0.0 ? 0.0 : log(-x);
}

bool together(float x, float y) {
    return ((x < y) == (y > 0.0) && !((x > 0.5) != (y > 0.5))) || (x < 0.0) != (y < 0.0);
}

#endif
