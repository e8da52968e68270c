// matrices
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Matrices: columns, arithmetic, and making one from another.
fn turned(a: f32) -> mat2x2f {
    let s = sin(a);
    let c = cos(a);
    return mat2x2f(c, s, -s, c);
}

fn around(p_in: vec2f, a: f32) -> vec2f {
    var p = p_in;
    p = p * turned(a);
    return turned(-a) * p + p * turned(a);
}

fn from_columns(x: vec3f, y: vec3f) -> mat3x3f {
    let m = mat3x3f(x, y, cross(x, y));
    return transpose(m) * m + m - mat3x3f(0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5) * 2.0;
}

fn grown(m: mat3x3f, move_: vec3f) -> mat4x4f {
    var all_ = mat4x4f(vec4f(m[0], 0.0), vec4f(m[1], 0.0), vec4f(m[2], 0.0), vec4f(0.0, 0.0, 0.0, 1.0));
    all_[3] = vec4f(move_, all_[3].w);
    return all_;
}

fn cut(m: mat4x4f) -> mat3x3f {
    return mat3x3f(m[0].xyz, m[1].xyz, m[2].xyz) * (1.0 / 2.0);
}

fn mixed(m: mat2x2f, v: vec4f) -> vec4f {
    return vec4f(m[0], m[1]) * v;
}

fn entries(m: mat3x3f, i: i32) -> f32 {
    let column = m[i & 1];
    return column.y + m[2].x + m[0][1] + mat3x3f(m[0] * m[0], m[1] * m[1], m[2] * m[2])[1][1];
}

fn inverted(m: mat2x2f) -> f32 {
    let safe = m + mat2x2f(3.0, 0.0, 0.0, 3.0);
    return determinant(safe)
        + (mat2x2f(safe[1].y, -safe[0].y, -safe[1].x, safe[0].x)
        * (1.0 / (safe[0].x * safe[1].y - safe[1].x * safe[0].y)))[0].x;
}

fn outer(a: vec3f, b: vec3f) -> mat3x3f {
    var m = mat3x3f(a * b.x, a * b.y, a * b.z);
    m = mat3x3f(m[0] + 1.0, m[1] + 1.0, m[2] + 1.0);
    m = m * m;
    m -= mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    return m * -1.0;
}

fn spelled_twice(m: mat4x4f) -> mat2x2f {
    return mat2x2f(m[0].xy, m[1].zw);
}

fn of_parts(v: vec2f, w: vec3f, x: f32) -> mat2x2f {
    let m = mat2x2f(v, vec2f(-v.y, v.x));
    return m * mat2x2f(w.xy, vec2f(w.z, x)) * mat2x2f(vec2f(x, v.x), vec2f(v.y, x));
}

fn of_more_parts(v: vec2f, w: vec4f) -> mat3x3f {
    let part = v * 2.0;
    return mat3x3f(vec3f(v, w.x), w.yzw, vec3f(w.xy, 1.0)) - mat3x3f(vec3f(part, w.x), w.yzw, vec3f(v, 1.0));
}
