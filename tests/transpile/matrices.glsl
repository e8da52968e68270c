#version 330
// Matrices: columns, arithmetic, and making one from another.

mat2 turned(float a) {
    float s = sin(a), c = cos(a);
    return mat2(c, s, -s, c);
}

vec2 around(vec2 p, float a) {
    p *= turned(a);
    return turned(-a) * p + p * turned(a);
}

mat3 from_columns(vec3 x, vec3 y) {
    mat3 m = mat3(x, y, cross(x, y));
    return transpose(m) * m + m - mat3(0.5) * 2.0;
}

mat4 grown(mat3 m, vec3 move) {
    mat4 all = mat4(m);
    all[3].xyz = move;
    return all;
}

mat3 cut(mat4 m) {
    return mat3(m) / 2.0;
}

vec4 mixed(mat2 m, vec4 v) {
    return vec4(m) * v;
}

float entries(mat3 m, int i) {
    vec3 column = m[i & 1];
    return column.y + m[2].x + m[0][1] + matrixCompMult(m, m)[1][1];
}

float inverted(mat2 m) {
    mat2 safe = m + mat2(3.0, 0.0, 0.0, 3.0);
    return determinant(safe) + inverse(safe)[0].x;
}

mat3 outer(vec3 a, vec3 b) {
    mat3 m = outerProduct(a, b);
    m += 1.0;
    m *= m;
    m -= mat3(1.0);
    return -m;
}

mat2x2 spelled_twice(mat4x4 m) {
    return mat2x2(m[0].xy, m[1].zw);
}

mat2 of_parts(vec2 v, vec3 w, float x) {
    mat2 m = mat2(v, -v.y, v.x);
    return m * mat2(w, x) * mat2(x, v, x);
}

mat3 of_more_parts(vec2 v, vec4 w) {
    return mat3(v, w, w.xy, 1.0) - mat3(v * 2.0, w.x, w.yzw, v, 1.0);
}
