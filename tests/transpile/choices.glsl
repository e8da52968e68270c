#version 450
// Choosing without a branch, and builtins with more than one result.

struct Two {
    float a;
    vec2 b;
};

vec3 by_bools(vec3 a, vec3 b) {
    return mix(a, b, lessThan(a, b)) + mix(vec3(0.0), vec3(1.0), bvec3(true, a.x > b.x, false));
}

bvec2 logic(vec2 a, vec2 b) {
    bvec2 less = lessThanEqual(a, b);
    return not(less) == bvec2(all(less), any(less)) ? less : greaterThan(a, b);
}

float parts(float x) {
    float whole;
    float part = modf(x * 5.0, whole);
    return whole * 10.0 + part;
}

float powers_of_two(float x) {
    int power;
    float significand = frexp(x + 3.0, power);
    return significand + float(power) * 4.0 + ldexp(significand, 2);
}

float at_once(float a, float b, float c) {
    return fma(a, b, c) + fma(b, c, 1.0);
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
    return (x < y) == (y > 0.0) && !(x > 0.5 != y > 0.5) || (x < 0.0 ^^ y < 0.0);
}
