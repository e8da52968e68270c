#version 330 core
// ends
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.

struct Hit {
    float t;
    int steps;
};

uniform float limit;
uniform int rounds;

in vec2 uv;
out vec4 color;

// Discards in loops: a discarded invocation must end in every language.
Hit march(float start) {
    float t = start;
    for (int i = 0; i < 8; i++) {
        if (t > limit) {
            discard;
        }
        t += 0.25;
    }
    return Hit(t, 8);
}

float below(float x) {
    if (x < limit) {
        return x;
    }
    discard;
}

float either(float x) {
    if (x < limit) {
        discard;
    } else {
        return 2.0 * x;
    }
}

void main() {
    color = vec4(march(uv.x).t, below(uv.y), either(uv.x), 1.0);
    for (; ; ) {
        color.x += 0.5;
        if (color.x > limit) {
            break;
        }
    }
    if (rounds > 50) {
        for (; ; ) {
            color.z += uv.x;
            discard;
        }
    }
}
