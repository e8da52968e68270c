// bits
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef BITS_HLSL_INCLUDED
#define BITS_HLSL_INCLUDED

// Whole numbers: bits, shifts, remainders, and floats as their bits.
uint hash(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

uint3 mixed(uint3 v) {
    v = v * 0x19660du + 0x3c6ef35fu;
    v.x += v.y * v.z;
    v ^= v >> 16u;
    return v << uint3(1u, 2u, 3u);
}

int shifts(int n) {
    int wide = n << 3;
    return (wide >> 1) + (n >> 31) + (~n & 240) + (1 << (n & 7));
}

int remainders(int a, int b) {
    int d = abs(b % 100) + 1;
    return a % 1000 / d + abs(a % 1000) % d;
}

int2 of_vectors(int2 a, int2 b) {
    int2 c = (a & b) | 1;
    c ^= int2(a.x, 3);
    return (c >> 1) + (-a / 2) + ~b;
}

bool compared(uint a, int b) {
    return (a > 7u && b != -1) || any((uint2)a == uint2(3u, 4u));
}

float from_bits(uint seed) {
    return asfloat((hash(seed) >> 9) | 0x3f800000u) - 1.0;
}

int to_bits(float x) {
    return asint(x) ^ 10;
}

float unit(uint x) {
    return float(hash(x)) * (1.0 / 4294967296.0);
}

#endif
