// structs
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Wave {
    float height;
    float length_;
    vec2 towards;
};

struct Foam {
    vec3 color;
    float amount;
};

struct Sea {
    Wave waves[2];
    Foam foam;
    mat2 frame;
};

struct Unnamed {
    float gain;
    vec2 offset;
};

struct Level {
    int count;
    float bias;
};

struct Local {
    float kept;
};

const Level LEVEL = Level(2, 0.25);

Wave first = Wave(1.0, 2.0, vec2(1.0, 0.0));
Wave second;
Unnamed settings;

float surface(Sea sea, vec2 p) {
    float sum = LEVEL.bias;
    for (int i = 0; i < LEVEL.count; i++) {
        Wave wave = sea.waves[i];
        sum += wave.height * sin(dot(sea.frame * p, wave.towards) / (abs(wave.length_) + 1.0));
    }
    return sum + sea.foam.amount * sea.foam.color.g;
}

Sea calm(float x) {
    Local local = Local(x);
    second = first;
    second.towards.y = local.kept;
    settings.gain = 0.5;
    settings.offset = vec2(x);
    Sea sea;
    sea.waves[0] = first;
    sea.waves[1] = second;
    sea.waves[1].height *= settings.gain;
    sea.foam.color = vec3(x);
    sea.foam.amount = settings.offset.x;
    sea.frame = mat2(1.0, x, -x, 1.0);
    return sea;
}

float of_both(vec2 p, float x) {
    return surface(calm(x), p) + surface(calm(p.y), vec2(x));
}
