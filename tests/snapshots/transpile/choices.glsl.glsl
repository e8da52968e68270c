// choices
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Two {
    float a;
    vec2 b;
};

float ldexp_(float x, int y) {
    int whole = clamp(y, -252, 254);
    int part = whole >> 1u;
    return x * intBitsToFloat((part + 127) << 23u) * intBitsToFloat((whole - part + 127) << 23u);
}

float modf_(float x, out float whole) {
    whole = trunc(x);
    return x - whole;
}

float frexp_(float x, out int exponent) {
    uint bits = floatBitsToUint(x);
    int biased = int((bits >> 23u) & 255u);
    int normal = min(biased, 1);
    exponent = (biased - 126) * normal;
    return uintBitsToFloat((bits & 0x80000000u) | (((bits & 0x7fffffu) | 0x3f000000u) * uint(normal)));
}

vec3 by_bools(vec3 a, vec3 b) {
    return mix(a, b, lessThan(a, b)) + mix(vec3(0.0), vec3(1.0), bvec3(true, a.x > b.x, false));
}

bvec2 logic(vec2 a, vec2 b) {
    bvec2 less = lessThanEqual(a, b);
    return not(less) == bvec2(all(less), any(less)) ? less : greaterThan(a, b);
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
    Two made = first ? Two(x, vec2(1.0)) : Two(1.0, vec2(x));
    made.b = x > 0.0 ? made.b.yx : x < -0.5 ? vec2(0.25) : made.b + 1.0;
    return made;
}

float lazily(float x) {
    return x > 0.0 ? sqrt(x) : x == 0.0 ? 0.0 : log(-x);
}

bool together(float x, float y) {
    return ((x < y) == (y > 0.0) && !((x > 0.5) != (y > 0.5))) || (x < 0.0) != (y < 0.0);
}
