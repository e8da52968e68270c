// array_results
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

// Functions that return arrays, which HLSL has not.
fn thirds(x: f32) -> array<f32, 3> {
    let made = array<f32, 3>(x, x * 2.0, x * 3.0);
    return made;
}

fn middle(x: f32) -> f32 {
    let parts = thirds(x);
    return parts[1] + thirds(x * 0.5)[2];
}
