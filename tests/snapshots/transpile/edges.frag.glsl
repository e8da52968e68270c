#version 330 core
// edges
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

struct Sphere {
    vec2 center;
    float radius;
};

struct Plane {
    vec3 normal;
};

const int FAR = 40;

uniform int bits;
uniform uint mask;
uniform int rounds;

out vec4 color;

uint bitfieldInsert_(uint x, uint y, int z, int w) {
    uint mask = (w > 31 ? 0xffffffffu : (1u << (uint(w) & 31u)) - 1u) << (uint(z) & 31u);
    return (x & ~mask) | ((y << (uint(z) & 31u)) & mask);
}

float area(Sphere s) {
    return s.radius * s.radius;
}

float area(Plane p) {
    return p.normal.z;
}

void main() {
    float steps[3] = float[3](1.0, 2.0, 3.0);
    vec3 weights = vec3(0.25, 0.5, 1.0);
    int after = 7;
    int before = -1;
    color = vec4(area(Sphere(vec2(1.0), 2.0)), area(Plane(vec3(0.5))), 0.0, 1.0);
    if (rounds > 100) {
        color.x = steps[after] + weights[before] + mat2(1.0)[before][after];
        color.y = float(1 == 0 ? 0 : (bits << (uint(32 - (-1) - 1) & 31u)) >> (uint(32 - 1) & 31u))
            + float(2 == 0 ? 0u : (mask << (uint(32 - FAR - 2) & 31u)) >> (uint(32 - 2) & 31u));
        color.z = float(bitfieldInsert_(mask, 3u, 30, 9));
    }
}
