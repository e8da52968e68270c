// macros
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

const PI: f32 = 3.14159265;
const TAU: f32 = 2.0 * PI;
const STEPS: i32 = 6;
const ROUNDS: i32 = STEPS * 2;

// The distance to a ball.
fn sphere(p: vec3f, radius: f32) -> f32 {
    return length(p) - radius;
}

// The distance to a box.
fn box(p: vec3f, half_size: vec3f) -> f32 {
    let q = abs(p) - half_size;
    return length(max(q, vec3f(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// A scene: a ball
// on the ground.
fn scene(p_in: vec3f) -> f32 {
    var p = p_in;
    let ball = sphere(p - vec3f(0.0, 0.5, 0.0), 0.5);  // what stands
    let p_xz = p.xz * mat2x2f(cos(PI * 0.25), -sin(PI * 0.25), sin(PI * 0.25), cos(PI * 0.25));
    p = vec3f(p_xz.x, p.y, p_xz.y);
    return min(ball, box(p, vec3f(2.0, 0.1, 2.0)));
}

fn shadow(from_: vec3f, to: vec3f) -> f32 {
    var light = 1.0;
    var t = 0.02;
    for (var i = 0; i < ROUNDS; i++) {
        let d = scene(from_ + to * t);
        light = min(light, clamp(8.0 * d / t, 0.0, 1.0));
        t += max(d, 0.02);
    }
    return clamp(light, 0.0, 1.0);
}

fn swapped(a_in: vec3f, b_in: vec3f) -> vec3f {
    var a = a_in;
    var b = b_in;
    let part1 = TAU;
    let kept = a;
    a = b;
    b = kept;
    return a + 2.0 * b + part1;
}

fn three() -> i32 {
    return 3;
}
