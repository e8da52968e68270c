#version 330
// Whole numbers: bits, shifts, remainders, and floats as their bits.

uint hash(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

uvec3 mixed(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v ^= v >> 16u;
    return v << uvec3(1u, 2u, 3u);
}

int shifts(int n) {
    int wide = n << 3;
    return (wide >> 1) + (n >> 31) + (~n & 0xF0) + (1 << (n & 7));
}

int remainders(int a, int b) {
    int d = abs(b % 100) + 1;
    return (a % 1000) / d + abs(a % 1000) % d;
}

ivec2 of_vectors(ivec2 a, ivec2 b) {
    ivec2 c = a & b | 1;
    c ^= ivec2(a.x, 3);
    return (c >> 1) + (-a / 2) + ~b;
}

bool compared(uint a, int b) {
    return a > 7u && b != -1 || any(equal(uvec2(a), uvec2(3u, 4u)));
}

float from_bits(uint seed) {
    return uintBitsToFloat((hash(seed) >> 9) | 0x3f800000u) - 1.0;
}

int to_bits(float x) {
    return floatBitsToInt(x) ^ 012;
}

float unit(uint x) {
    return float(hash(x)) * (1.0 / 4294967296.0);
}
