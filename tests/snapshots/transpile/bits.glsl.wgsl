// bits
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Whole numbers: bits, shifts, remainders, and floats as their bits.
fn hash(x_in: u32) -> u32 {
    var x = x_in;
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    return x ^ (x >> 16u);
}

fn mixed(v_in: vec3u) -> vec3u {
    var v = v_in;
    v = v * 0x19660du + 0x3c6ef35fu;
    v.x += v.y * v.z;
    v ^= v >> vec3u(16u);
    return v << vec3u(1u, 2u, 3u);
}

fn shifts(n: i32) -> i32 {
    let wide = n << 3u;
    return (wide >> 1u) + (n >> 31u) + (~n & 240) + (1 << u32(n & 7));
}

fn remainders(a: i32, b: i32) -> i32 {
    let d = abs(b % 100) + 1;
    return a % 1000 / d + abs(a % 1000) % d;
}

fn of_vectors(a: vec2i, b: vec2i) -> vec2i {
    var c = (a & b) | vec2i(1);
    c ^= vec2i(a.x, 3);
    return (c >> vec2u(1u)) + (-a / 2) + ~b;
}

fn compared(a: u32, b: i32) -> bool {
    return (a > 7u && b != -1) || any(vec2u(a) == vec2u(3u, 4u));
}

fn from_bits(seed: u32) -> f32 {
    return bitcast<f32>((hash(seed) >> 9u) | 0x3f800000u) - 1.0;
}

fn to_bits(x: f32) -> i32 {
    return bitcast<i32>(x) ^ 10;
}

fn unit(x: u32) -> f32 {
    return f32(hash(x)) * (1.0 / 4294967296.0);
}
