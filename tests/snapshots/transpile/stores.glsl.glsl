// stores
// Made by sssgen for GLSL 3.30 (OpenGL 3.3 core). Change the source and emit it again rather than this file.
// Paste it below the #version of your own shader.

struct Ray {
    vec3 from;
    vec3 towards;
};

struct Hit {
    Ray ray;
    float far[3];
    mat3 frame;
};

vec4 swizzles(vec4 v, float x) {
    v.xy = v.yx;
    v.zw *= 2.0;
    v.b += x;
    v.wx -= vec2(x, 1.0);
    v.xyz = v.zxy;
    v[2] = x;
    v[3] /= 2.0;
    return v;
}

mat3 columns(mat3 m, vec3 v, int i) {
    m[0] = v;
    m[1].xz = v.zx;
    m[2][1] = 4.0;
    m[1][2] += v.y;
    m[i & 1] *= 0.5;
    return m;
}

float elements(float x, int i) {
    vec2 points[3] = vec2[3](vec2(x), vec2(1.0, x), vec2(0.0));
    points[1].y = 2.0;
    points[2] += points[0];
    points[i & 1].x -= 1.0;
    return points[0].x + points[1].x * points[1].y + points[2].x;
}

Hit members(Ray ray, float x) {
    Hit hit;
    hit.ray = ray;
    hit.ray.towards.xy *= x;
    hit.far = float[3](x, 1.0, 2.0);
    hit.far[1] -= x;
    hit.frame = mat3(x);
    hit.frame[1].zx = ray.from.xy;
    hit.frame[2][0] = x;
    hit.ray.from = hit.frame * ray.from;
    return hit;
}

float of_a_hit(Hit hit) {
    return dot(hit.ray.from, hit.ray.towards) + hit.far[0] * hit.far[1] + hit.frame[1].z;
}

float whole_structs(vec3 v, float x) {
    Ray one = Ray(v, vec3(x));
    Ray two = one;
    two.from.y = x;
    bool same = one == two;
    return same ? one.from.y : two.from.x + of_a_hit(members(two, x));
}

void whole_numbers(inout ivec3 n, inout uint bits) {
    n.xy %= 7;
    n.z <<= 1;
    bits |= 5u;
    bits ^= uint(n.x);
    bits &= 255u;
    bits >>= 1;
}
