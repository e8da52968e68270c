// alike
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Overloads that differ in a vec4 and a mat2 alone, which HLSL cannot tell apart.
fn f_vec4(a: vec4f) -> f32 {
    return a.x;
}

fn f_mat2(a: mat2x2f) -> f32 {
    return a[0].y;
}

fn g(v: vec4f) -> f32 {
    return f_vec4(v) + f_mat2(mat2x2f(v.xy, v.zw));
}
