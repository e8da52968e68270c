// names
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct float3x3 {
    float3: f32,
    half4: vec2f,
}

const lerp: f32 = 0.25;

var<private> buffer: f32 = 0.5;

fn frac(fn_: f32, let_: f32) -> f32 {
    let var_ = fn_ + let_;
    let self_ = var_ * lerp;
    return self_ - floor(self_);
}

fn tone(sample: vec4f) -> vec4f {
    let patch_ = sample * 2.0;
    let vec3f_ = patch_.x;
    let ptr_ = patch_.y;
    return vec4f(vec3f_, ptr_, patch_.zw);
}

fn saturate_(matrix: f32) -> f32 {
    let point = matrix;
    let linear = 2.0;
    let pass_ = 3.0;
    return min(max(point * linear, 0.0), pass_);
}

fn lambda(def: f32, None: f32, and: f32) -> f32 {
    let f32_ = def + None;
    return f32_ * and;
}

fn members(register_in: float3x3) -> f32 {
    var register_ = register_in;
    register_.float3 += 1.0;
    return register_.float3 + register_.half4.y;
}

fn main_(abs_: f32, max_1: f32) -> f32 {
    let a = abs(abs_);
    let a_1 = max(max_1, a);
    return a + a_1 + buffer;
}

fn mul(x: f32, typedef_: f32) -> f32 {
    let cbuffer = x;
    let groupshared_ = typedef_;
    let loop_ = 1.0;
    let override_ = 2.0;
    let read_ = 3.0;
    let type_ = 4.0;
    return cbuffer + groupshared_ + loop_ + override_ + read_ + type_;
}
