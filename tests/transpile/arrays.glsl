#version 420
// Arrays: their constructors, lengths, and where they may stand.

#define COUNT 4

struct Lamp {
    vec3 at;
    float power;
};

const float WEIGHTS[3] = float[3](0.25, 0.5, 0.25);
const vec2 CORNERS[] = vec2[](vec2(0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(1.0));
const Lamp LAMPS[2] = Lamp[2](Lamp(vec3(0.0, 1.0, 0.0), 2.0), Lamp(vec3(1.0, 0.0, 0.5), 0.5));

float weighted(float x, float y) {
    float given[] = float[](x, y, x * y);
    float sum = 0.0;
    for (int i = 0; i < given.length(); i++) {
        sum += given[i] * WEIGHTS[i];
    }
    return sum;
}

vec2 corner(int i) {
    return CORNERS[i & 3] + float(CORNERS.length());
}

float lamps(vec3 p) {
    float light = 0.0;
    for (int i = 0; i < LAMPS.length(); i++)
        light += LAMPS[i].power / (1.0 + distance(p, LAMPS[i].at));
    return light;
}

void powers(float x, out float made[COUNT]) {
    made[0] = 1.0;
    for (int i = 1; i < COUNT; i++) {
        made[i] = made[i - 1] * x;
    }
}

float sum(const float values[COUNT]) {
    return values[0] + values[1] + values[2] + values[3];
}

void doubled(inout float values[COUNT]) {
    for (int i = 0; i < COUNT; ++i) values[i] *= 2.0;
}

float passed_on(float x) {
    float[COUNT] p;
    powers(x, p);
    float before = sum(p);
    doubled(p);
    float[] copy = p;
    copy[0] = -1.0;
    return before + sum(p) * 10.0 + copy[0] + (copy == p ? 1.0 : 0.0);
}

int lengths(vec3 v, mat4 m) {
    const int n = COUNT * 2;
    int table[n];
    for (int i = 0; i < n; i++) table[i] = i * i;
    return table[3] + table.length() * 100 + v.length() * 1000;
}
