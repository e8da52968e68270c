#version 330
// Variables of the module, which functions share.

int seed = 17;
vec3 tint = vec3(1.0, 0.5, 0.25), last;
float history[3];

float random() {
    seed = (seed * 1103 + 12345) & 0xFFFF;
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
    for (int i = 2; i > 0; i--) history[i] = history[i - 1];
    history[0] = x;
    return history[0] + history[1] * 2.0;
}

float shadows(float tint) {
    float x = tint;
    {
        float x = 2.0, tint = x * 3.0;
        if (x > 1.0) {
            int x = 4;
            tint += float(x);
        }
        last.x = tint;
    }
    for (int x = 0; x < 2; x++) last.x += float(x);
    return x + last.x;
}
