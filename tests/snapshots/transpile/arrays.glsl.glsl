// arrays
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Lamp {
    vec3 at;
    float power;
};

const int COUNT = 4;
const float WEIGHTS[3] = float[3](0.25, 0.5, 0.25);
const vec2 CORNERS[4] = vec2[4](vec2(0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(1.0));
const Lamp LAMPS[2] = Lamp[2](Lamp(vec3(0.0, 1.0, 0.0), 2.0), Lamp(vec3(1.0, 0.0, 0.5), 0.5));

float weighted(float x, float y) {
    float given[3] = float[3](x, y, x * y);
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        sum += given[i] * WEIGHTS[i];
    }
    return sum;
}

vec2 corner(int i) {
    return CORNERS[i & 3] + 4.0;
}

float lamps(vec3 p) {
    float light = 0.0;
    for (int i = 0; i < 2; i++) {
        light += LAMPS[i].power / (1.0 + distance(p, LAMPS[i].at));
    }
    return light;
}

void powers(float x, out float made[4]) {
    made[0] = 1.0;
    for (int i = 1; i < COUNT; i++) {
        made[i] = made[i - 1] * x;
    }
}

float sum(float values[4]) {
    return values[0] + values[1] + values[2] + values[3];
}

void doubled(inout float values[4]) {
    for (int i = 0; i < COUNT; i++) {
        values[i] *= 2.0;
    }
}

float passed_on(float x) {
    float p[4];
    powers(x, p);
    float before = sum(p);
    doubled(p);
    float copy[4] = p;
    copy[0] = -1.0;
    return before + sum(p) * 10.0 + copy[0] + (copy == p ? 1.0 : 0.0);
}

int lengths(vec3 v, mat4 m) {
    int n = COUNT * 2;
    int table[8];
    for (int i = 0; i < n; i++) {
        table[i] = i * i;
    }
    return table[3] + 8 * 100 + 3 * 1000;
}
