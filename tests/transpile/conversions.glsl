#version 420
// Whole numbers where others are wanted.

const float HALF = 1 / 2.0;
const float THREE = 3;
const uint BITS = 6;

float as_float(int n) {
    return n;
}

uint as_uint(int n) {
    return n & 255;
}

float operators(float x, int n, uint u) {
    float a = n * x + 2;
    a -= n;
    a /= 1 + n * n;
    return a + u * 0.5 + (x > n ? 1 : x) + THREE * HALF;
}

uint with_uints(int n, uint u) {
    uint a = n & 7;
    a += 3;
    a = u + n;
    return (a ^ BITS) + (n > 0 ? u : 1);
}

vec3 vectors(ivec3 n, vec3 v, uvec3 u) {
    vec3 w = n;
    w += n * 2;
    vec3 z = v * n - u;
    return w + z * 2 + vec3(n.xy, 1);
}

float arguments(int n) {
    return max(0.5, n) + pow(2, 3) + clamp(n, 0, 1.5) + mix(0, 1, 0.25) + as_float(3) + length(vec2(n, 2));
}

float constructors(bool b, int n, uint u, float x) {
    return float(b) + float(u) + float(int(x)) + float(uint(abs(n))) + float(bool(n)) + vec2(b, n).x + ivec2(x, n).x;
}

int truncated(float x) {
    return int(x * 4.0) + int(-1.5) + int(uvec2(3.7, 1).x);
}
