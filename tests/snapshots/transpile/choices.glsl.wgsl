// choices
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Two {
    a: f32,
    b: vec2f,
}

fn modf_(x: f32, whole: ptr<function, f32>) -> f32 {
    *whole = trunc(x);
    return x - *whole;
}

fn frexp_(x: f32, exponent: ptr<function, i32>) -> f32 {
    let bits = bitcast<u32>(x);
    let biased = i32((bits >> 23u) & 255u);
    let normal = min(biased, 1);
    *exponent = (biased - 126) * normal;
    return bitcast<f32>((bits & 0x80000000u) | (((bits & 0x7fffffu) | 0x3f000000u) * u32(normal)));
}

fn by_bools(a: vec3f, b: vec3f) -> vec3f {
    return select(a, b, a < b) + select(vec3f(0.0), vec3f(1.0), vec3<bool>(true, a.x > b.x, false));
}

fn logic(a: vec2f, b: vec2f) -> vec2<bool> {
    let less = a <= b;
    return select(a > b, less, all(!less == vec2<bool>(all(less), any(less))));
}

fn parts(x: f32) -> f32 {
    var whole: f32;
    let part = modf_(x * 5.0, &whole);
    return whole * 10.0 + part;
}

fn powers_of_two(x: f32) -> f32 {
    var power: i32;
    let significand = frexp_(x + 3.0, &power);
    return significand + f32(power) * 4.0 + ldexp(significand, 2);
}

fn at_once(a: f32, b: f32, c: f32) -> f32 {
    return fma(a, b, c) + fma(b, c, 1.0);
}

fn structs(first: bool, x: f32) -> Two {
    var made: Two;
    if (first) {
        made = Two(x, vec2f(1.0));
    } else {
        made = Two(1.0, vec2f(x));
    }
    made.b = select(select(made.b + 1.0, vec2f(0.25), x < -0.5), made.b.yx, x > 0.0);
    return made;
}

fn lazily(x: f32) -> f32 {
    return select(select(log(-x), 0.0, x == 0.0), sqrt(x), x > 0.0);
}

fn together(x: f32, y: f32) -> bool {
    return ((x < y) == (y > 0.0) && !((x > 0.5) != (y > 0.5))) || (x < 0.0) != (y < 0.0);
}
