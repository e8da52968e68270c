// Matrices that are not square: types, constructors, parts, products, and their builtins.

uniform mat4x3 bones[2];
uniform mat2x4 dual;
uniform mat3x2 to_uv;
uniform float scale;

const mat2x3 BASIS = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);

struct Pose {
    mat4x3 frame;
    mat2x4 parts[2];
};

vec3 skinned(vec3 p, float w) {
    return (bones[0] * w + bones[1] * (1.0 - w)) * vec4(p, 1.0);
}

vec2 projected(vec3 p) {
    return to_uv * p + p * BASIS + transpose(BASIS) * p;
}

vec4 blended(vec4 q, vec2 w) {
    vec2 both = q * dual;
    return dual * w + vec4(both, both);
}

mat3x4 flipped(mat4x3 m) {
    return transpose(m);
}

mat2x3 spread(vec3 a, vec2 b) {
    return outerProduct(a, b);
}

mat4x2 product(mat3x2 a, mat4x3 b) {
    return a * b;
}

mat4x3 column_set(mat4x3 m, int i, vec3 v) {
    m[i] = v;
    m[3].xy *= scale;
    m[0][2] += 1.0;
    return m;
}

mat3x4 resized(mat2x3 a, mat4 b, float s) {
    mat3x4 wide = mat3x4(a);
    wide += mat3x4(b) - mat3x4(s);
    return -wide / 2.0;
}

mat2x4 pieces(vec3 a, float b, vec4 c) {
    return mat2x4(a, b, c.wzyx);
}

bool same(mat3x2 a, mat3x2 b) {
    return a == b || matrixCompMult(a, b) != a;
}

vec4 posed(Pose pose, vec3 p) {
    mat2x4 sum = pose.parts[0] + pose.parts[1];
    return vec4(pose.frame * vec4(p, 1.0), 1.0) + sum[1] + float(sum.length() + sum[0].length());
}

void swap(inout mat2x3 m) {
    vec3 first = m[0];
    m = mat2x3(m[1], first);
}

vec3 swapped(mat2x3 m, vec2 v) {
    swap(m);
    return m * v;
}
