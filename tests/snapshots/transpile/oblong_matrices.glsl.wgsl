// oblong_matrices
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Pose {
    frame: mat4x3f,
    parts: array<mat2x4f, 2>,
}

const BASIS: mat2x3f = mat2x3f(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);

fn skinned(p: vec3f, w: f32, bones: array<mat4x3f, 2>) -> vec3f {
    return (bones[0] * w + bones[1] * (1.0 - w)) * vec4f(p, 1.0);
}

fn projected(p: vec3f, to_uv: mat3x2f) -> vec2f {
    return to_uv * p + p * BASIS + transpose(BASIS) * p;
}

fn blended(q: vec4f, w: vec2f, dual: mat2x4f) -> vec4f {
    let both = q * dual;
    return dual * w + vec4f(both, both);
}

fn flipped(m: mat4x3f) -> mat3x4f {
    return transpose(m);
}

fn spread(a: vec3f, b: vec2f) -> mat2x3f {
    return mat2x3f(a * b.x, a * b.y);
}

fn product(a: mat3x2f, b: mat4x3f) -> mat4x2f {
    return a * b;
}

fn column_set(m_in: mat4x3f, i: i32, v: vec3f, scale: f32) -> mat4x3f {
    var m = m_in;
    m[i] = v;
    let m_xy = m[3].xy * scale;
    m[3] = vec3f(m_xy, m[3].z);
    m[0][2] += 1.0;
    return m;
}

fn resized(a: mat2x3f, b: mat4x4f, s: f32) -> mat3x4f {
    var wide = mat3x4f(vec4f(a[0], 0.0), vec4f(a[1], 0.0), vec4f(0.0, 0.0, 1.0, 0.0));
    wide += mat3x4f(b[0], b[1], b[2]) - mat3x4f(s, 0.0, 0.0, 0.0, 0.0, s, 0.0, 0.0, 0.0, 0.0, s, 0.0);
    return wide * -1.0 * (1.0 / 2.0);
}

fn pieces(a: vec3f, b: f32, c: vec4f) -> mat2x4f {
    return mat2x4f(vec4f(a, b), c.wzyx);
}

fn same(a: mat3x2f, b: mat3x2f) -> bool {
    let compared = mat3x2f(a[0] * b[0], a[1] * b[1], a[2] * b[2]);
    return (all(a[0] == b[0]) && all(a[1] == b[1]) && all(a[2] == b[2]))
        || (any(compared[0] != a[0]) || any(compared[1] != a[1]) || any(compared[2] != a[2]));
}

fn posed(pose: Pose, p: vec3f) -> vec4f {
    let sum = pose.parts[0] + pose.parts[1];
    return vec4f(pose.frame * vec4f(p, 1.0), 1.0) + sum[1] + f32(2 + 4);
}

fn swap(m: ptr<function, mat2x3f>) {
    let first = (*m)[0];
    *m = mat2x3f((*m)[1], first);
}

fn swapped(m_in: mat2x3f, v: vec2f) -> vec3f {
    var m = m_in;
    swap(&m);
    return m * v;
}
