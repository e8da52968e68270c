// conversions
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

const HALF: f32 = 1.0 / 2.0;
const THREE: f32 = 3.0;
const BITS: u32 = 6u;

fn as_float(n: i32) -> f32 {
    return f32(n);
}

fn as_uint(n: i32) -> u32 {
    return u32(n & 255);
}

fn operators(x: f32, n: i32, u: u32) -> f32 {
    var a = f32(n) * x + 2.0;
    a -= f32(n);
    a /= f32(1 + n * n);
    return a + f32(u) * 0.5 + select(x, 1.0, x > f32(n)) + THREE * HALF;
}

fn with_uints(n: i32, u: u32) -> u32 {
    var a = u32(n & 7);
    a += 3u;
    a = u + u32(n);
    return (a ^ BITS) + select(1u, u, n > 0);
}

fn vectors(n: vec3i, v: vec3f, u: vec3u) -> vec3f {
    var w = vec3f(n);
    w += vec3f(n * 2);
    let z = v * vec3f(n) - vec3f(u);
    return w + z * 2.0 + vec3f(vec2f(n.xy), 1.0);
}

fn arguments(n: i32) -> f32 {
    return max(0.5, f32(n)) + pow(2.0, 3.0) + clamp(f32(n), 0.0, 1.5) + mix(f32(0.0), 1.0, 0.25)
        + as_float(3) + length(vec2f(f32(n), 2.0));
}

fn constructors(b: bool, n: i32, u: u32, x: f32) -> f32 {
    return f32(b) + f32(u) + f32(i32(x)) + f32(u32(abs(n))) + f32(bool(n)) + vec2f(f32(b), f32(n)).x
        + f32(vec2i(i32(x), n).x);
}

fn truncated(x: f32) -> i32 {
    return i32(x * 4.0) + (-1) + i32(vec2u(3u, 1u).x);
}
