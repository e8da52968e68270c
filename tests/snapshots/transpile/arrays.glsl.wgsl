// arrays
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Lamp {
    at: vec3f,
    power: f32,
}

const COUNT: i32 = 4;
const WEIGHTS: array<f32, 3> = array<f32, 3>(0.25, 0.5, 0.25);
const CORNERS: array<vec2f, 4> = array<vec2f, 4>(vec2f(0.0), vec2f(1.0, 0.0), vec2f(0.0, 1.0), vec2f(1.0));
const LAMPS: array<Lamp, 2> = array<Lamp, 2>(Lamp(vec3f(0.0, 1.0, 0.0), 2.0),
    Lamp(vec3f(1.0, 0.0, 0.5), 0.5));

fn weighted(x: f32, y: f32) -> f32 {
    let given = array<f32, 3>(x, y, x * y);
    var sum = 0.0;
    for (var i = 0; i < 3; i++) {
        sum += given[i] * WEIGHTS[i];
    }
    return sum;
}

fn corner(i: i32) -> vec2f {
    return CORNERS[i & 3] + 4.0;
}

fn lamps(p: vec3f) -> f32 {
    var light = 0.0;
    for (var i = 0; i < 2; i++) {
        light += LAMPS[i].power / (1.0 + distance(p, LAMPS[i].at));
    }
    return light;
}

fn powers(x: f32, made: ptr<function, array<f32, 4>>) {
    (*made)[0] = 1.0;
    for (var i = 1; i < COUNT; i++) {
        (*made)[i] = (*made)[i - 1] * x;
    }
}

fn sum(values: array<f32, 4>) -> f32 {
    return values[0] + values[1] + values[2] + values[3];
}

fn doubled(values: ptr<function, array<f32, 4>>) {
    for (var i = 0; i < COUNT; i++) {
        (*values)[i] *= 2.0;
    }
}

fn passed_on(x: f32) -> f32 {
    var p: array<f32, 4>;
    powers(x, &p);
    let before = sum(p);
    doubled(&p);
    var copy = p;
    copy[0] = -1.0;
    return before + sum(p) * 10.0 + copy[0]
        + select(0.0, 1.0, copy[0] == p[0] && copy[1] == p[1] && copy[2] == p[2] && copy[3] == p[3]);
}

fn lengths(v: vec3f, m: mat4x4f) -> i32 {
    let n = COUNT * 2;
    var table: array<i32, 8>;
    for (var i = 0; i < n; i++) {
        table[i] = i * i;
    }
    return table[3] + 8 * 100 + 3 * 1000;
}
