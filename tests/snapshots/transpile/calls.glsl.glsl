// calls
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

float soft(float x) {
    return smoothstep(0.0, 1.0, x);
}

vec2 soft(vec2 v) {
    return vec2(soft(v.x), soft(v.y));
}

vec3 soft(vec3 v) {
    return vec3(soft(v.xy), soft(v.z));
}

int soft(int n) {
    return n > 0 ? 1 : 0;
}

void split(float x, out float whole, out float part) {
    whole = floor(x);
    part = x - whole;
}

void grow(inout vec3 v, float by, float again) {
    v *= by;
    v += again;
}

void nothing() {
    return;
}

float directions(vec3 v, float x) {
    float whole;
    float part;
    split(x * 3.0, whole, part);
    vec3 kept = v;
    grow(kept, 2.0, part);
    grow(v, part, whole);
    nothing();
    return whole + part * 10.0 + dot(kept, v);
}

float into_parts(vec4 v) {
    float list[2];
    split(v.x, v.y, v.z);
    split(v.w, list[0], list[1]);
    return v.y + v.z * 2.0 + list[0] * 3.0 + list[1];
}

float later(float x) {
    if (x < 0.0) {
        return -x;
    }
    return soft(x) + float(soft(int(x)));
}

float changes_its_own(float x) {
    x += 1.0;
    x = later(x);
    return x;
}

vec3 all_(float x) {
    return soft(vec3(x)) + vec3(soft(vec2(x, 0.5)), directions(vec3(x), x));
}
