// Signed distances, and a march.

float sphere(vec3 p, float r) { return length(p) - r; }

float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float capsule(vec3 p, vec3 a, vec3 b, float r) {
    vec3 pa = p - a, ba = b - a;
    float h = clamp(dot(pa, ba) / dot(ba, ba), 0.0, 1.0);
    return length(pa - ba * h) - r;
}

float smooth_union(float a, float b, float k) {
    float h = clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return mix(b, a, h) - k * h * (1.0 - h);
}

vec2 fold(vec2 p, int count) {
    for (int i = 0; i < 5; i++) {
        if (i >= count) break;
        p = abs(p) - vec2(0.5, 0.25);
        if (p.x < p.y) p = p.yx;
    }
    return p;
}

float scene(vec3 p) {
    float ground = p.y + 1.0;
    return min(ground, smooth_union(sphere(p, 1.0), box(p - vec3(0.8, 0.0, 0.0), vec3(0.5)), 0.2));
}

float march(vec3 origin, vec3 direction) {
    float t = 0.0;
    for (int i = 0; i < 32; i++) {
        float d = scene(origin + direction * t);
        if (d < 0.001) return t;
        t += d;
        if (t > 20.0) break;
    }
    return -1.0;
}

vec3 normal_of(vec3 p) {
    vec2 e = vec2(0.05, 0.0);
    return normalize(vec3(scene(p + e.xyy) - scene(p - e.xyy), scene(p + e.yxy) - scene(p - e.yxy),
                          scene(p + e.yyx) - scene(p - e.yyx)));
}
