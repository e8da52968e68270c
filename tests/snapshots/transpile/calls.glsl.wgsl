// calls
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

fn soft_float(x: f32) -> f32 {
    return smoothstep(0.0, 1.0, x);
}

fn soft_vec2(v: vec2f) -> vec2f {
    return vec2f(soft_float(v.x), soft_float(v.y));
}

fn soft_vec3(v: vec3f) -> vec3f {
    return vec3f(soft_vec2(v.xy), soft_float(v.z));
}

fn soft_int(n: i32) -> i32 {
    return select(0, 1, n > 0);
}

fn split(x: f32, whole: ptr<function, f32>, part: ptr<function, f32>) {
    *whole = floor(x);
    *part = x - *whole;
}

fn grow(v: ptr<function, vec3f>, by: f32, again: f32) {
    *v *= by;
    *v += again;
}

fn nothing() {
    return;
}

fn directions(v_in: vec3f, x: f32) -> f32 {
    var v = v_in;
    var whole: f32;
    var part: f32;
    split(x * 3.0, &whole, &part);
    var kept = v;
    grow(&kept, 2.0, part);
    grow(&v, part, whole);
    nothing();
    return whole + part * 10.0 + dot(kept, v);
}

fn into_parts(v_in: vec4f) -> f32 {
    var v = v_in;
    var list: array<f32, 2>;
    var whole: f32;
    var part: f32;
    split(v.x, &whole, &part);
    v.y = whole;
    v.z = part;
    var whole_2: f32;
    var part_2: f32;
    split(v.w, &whole_2, &part_2);
    list[0] = whole_2;
    list[1] = part_2;
    return v.y + v.z * 2.0 + list[0] * 3.0 + list[1];
}

fn later(x: f32) -> f32 {
    if (x < 0.0) {
        return -x;
    }
    return soft_float(x) + f32(soft_int(i32(x)));
}

fn changes_its_own(x_in: f32) -> f32 {
    var x = x_in;
    x += 1.0;
    x = later(x);
    return x;
}

fn all_(x: f32) -> vec3f {
    return soft_vec3(vec3f(x)) + vec3f(soft_vec2(vec2f(x, 0.5)), directions(vec3f(x), x));
}
