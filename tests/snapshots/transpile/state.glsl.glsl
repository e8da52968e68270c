// state
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

int seed = 17;
vec3 tint = vec3(1.0, 0.5, 0.25);
vec3 last;
float history[3];

float random() {
    seed = (seed * 1103 + 12345) & 65535;
    return float(seed) / 65536.0;
}

vec2 random2() {
    return vec2(random(), random());
}

float use(float x) {
    seed = int(x * 100.0) & 255;
    vec2 p = random2();
    last = tint * p.x;
    last.y += random() - random();
    return last.x + last.y + p.y;
}

float remember(float x) {
    for (int i = 2; i > 0; i--) {
        history[i] = history[i - 1];
    }
    history[0] = x;
    return history[0] + history[1] * 2.0;
}

float shadows(float tint) {
    float x = tint;
    float x_2 = 2.0;
    float tint_2 = x_2 * 3.0;
    if (x_2 > 1.0) {
        int x_3 = 4;
        tint_2 += float(x_3);
    }
    last.x = tint_2;
    for (int x_3 = 0; x_3 < 2; x_3++) {
        last.x += float(x_3);
    }
    return x + last.x;
}
