// conversions
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

const float HALF = 1.0 / 2.0;
const float THREE = 3.0;
const uint BITS = 6u;

float as_float(int n) {
    return float(n);
}

uint as_uint(int n) {
    return uint(n & 255);
}

float operators(float x, int n, uint u) {
    float a = float(n) * x + 2.0;
    a -= float(n);
    a /= float(1 + n * n);
    return a + float(u) * 0.5 + (x > float(n) ? 1.0 : x) + THREE * HALF;
}

uint with_uints(int n, uint u) {
    uint a = uint(n & 7);
    a += 3u;
    a = u + uint(n);
    return (a ^ BITS) + (n > 0 ? u : 1u);
}

vec3 vectors(ivec3 n, vec3 v, uvec3 u) {
    vec3 w = vec3(n);
    w += vec3(n * 2);
    vec3 z = v * vec3(n) - vec3(u);
    return w + z * 2.0 + vec3(vec2(n.xy), 1.0);
}

float arguments(int n) {
    return max(0.5, float(n)) + pow(2.0, 3.0) + clamp(float(n), 0.0, 1.5) + mix(0.0, 1.0, 0.25) + as_float(3)
        + length(vec2(float(n), 2.0));
}

float constructors(bool b, int n, uint u, float x) {
    return float(b) + float(u) + float(int(x)) + float(uint(abs(n))) + float(bool(n))
        + vec2(float(b), float(n)).x + float(ivec2(int(x), n).x);
}

int truncated(float x) {
    return int(x * 4.0) + (-1) + int(uvec2(3u, 1u).x);
}
