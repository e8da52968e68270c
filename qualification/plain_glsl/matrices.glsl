// Rotations, quaternions, projections.

mat2 turn(float a) { float c = cos(a), s = sin(a); return mat2(c, s, -s, c); }

mat3 look(vec3 from, vec3 to, float roll) {
    vec3 f = normalize(to - from);
    vec3 r = normalize(cross(f, vec3(sin(roll), cos(roll), 0.0)));
    return mat3(r, cross(r, f), -f);
}

vec4 multiplied(vec4 a, vec4 b) {
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

mat4 perspective(float slope, float near, float far) {
    mat4 m = mat4(0.0);
    m[0][0] = slope;
    m[1][1] = slope;
    m[2][2] = (far + near) / (near - far);
    m[2][3] = -1.0;
    m[3][2] = 2.0 * far * near / (near - far);
    return m;
}

vec2 octahedral(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 s = vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * s;
}

vec2 sphere_hit(vec3 o, vec3 d, float r) {
    float b = dot(o, d), c = dot(o, o) - r * r, h = b * b - c;
    if (h < 0.0) return vec2(-1.0);
    h = sqrt(h);
    return vec2(-b - h, -b + h);
}

float median(float a[5]) {
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4 - i; j++)
            if (a[j] > a[j + 1]) { float t = a[j]; a[j] = a[j + 1]; a[j + 1] = t; }
    return a[2];
}

float fresnel(float cosine, float ior) {
    float g = ior * ior - 1.0 + cosine * cosine;
    if (g < 0.0) return 1.0;
    g = sqrt(g);
    float a = (g - cosine) / (g + cosine), b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

vec3 spline(vec3 a, vec3 b, vec3 c, vec3 d, float t) {
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}
