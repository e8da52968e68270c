#version 330 core
#extension GL_ARB_shading_language_420pack : enable
#pragma optimize(on)
#include "include/shapes.glsl"
#include <include/shapes.glsl>

#define PI 3.14159265
#define TAU (2.0 * PI)
#define STEPS 6
#define saturate(x) clamp(x, 0.0, 1.0)
#define rot(a) mat2(cos(a), -sin(a), \
                    sin(a), cos(a))
#define NAMED(kind, number) kind##number
#define SWAP(a, b) { vec3 kept = a; a = b; b = kept; }
#define EACH(i, n) for (int i = 0; i < n; i++)

#if defined(QUALITY) && QUALITY > 1
const int ROUNDS = 32;
#elif STEPS >= 6 && !defined(LOW)
const int ROUNDS = STEPS * 2;
#else
#error no such quality
#endif

#ifdef GL_ES
precision highp float;
#endif

/* A scene: a ball
   on the ground. */
float scene(vec3 p) {
    float ball = sphere(p - vec3(0.0, 0.5, 0.0), 0.5);  // what stands
    p.xz *= rot(PI * 0.25);
    return min(ball, box(p, vec3(2.0, 0.1, 2.0)));
}

float shadow(vec3 from, vec3 to) {
    float light = 1.0, t = 0.02;
    EACH(i, ROUNDS) {
        float d = scene(from + to * t);
        light = min(light, saturate(8.0 * d / t));
        t += max(d, 0.02);
    }
    return saturate(light);
}

vec3 swapped(vec3 a, vec3 b) {
    float NAMED(part, 1) = TAU;
    SWAP(a, b)
    return a + 2.0 * b + part1;
}

#undef PI
#define PI 3
int three() { return PI; }
