// macros
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

const float PI = 3.14159265;
const float TAU = 2.0 * PI;
const int STEPS = 6;
const int ROUNDS = STEPS * 2;

// The distance to a ball.
float sphere(vec3 p, float radius) {
    return length(p) - radius;
}

// The distance to a box.
float box(vec3 p, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// A scene: a ball
// on the ground.
float scene(vec3 p) {
    float ball = sphere(p - vec3(0.0, 0.5, 0.0), 0.5);  // what stands
    p.xz = p.xz * mat2(cos(PI * 0.25), -sin(PI * 0.25), sin(PI * 0.25), cos(PI * 0.25));
    return min(ball, box(p, vec3(2.0, 0.1, 2.0)));
}

float shadow(vec3 from, vec3 to) {
    float light = 1.0;
    float t = 0.02;
    for (int i = 0; i < ROUNDS; i++) {
        float d = scene(from + to * t);
        light = min(light, clamp(8.0 * d / t, 0.0, 1.0));
        t += max(d, 0.02);
    }
    return clamp(light, 0.0, 1.0);
}

vec3 swapped(vec3 a, vec3 b) {
    float part1 = TAU;
    vec3 kept = a;
    a = b;
    b = kept;
    return a + 2.0 * b + part1;
}

int three() {
    return 3;
}
