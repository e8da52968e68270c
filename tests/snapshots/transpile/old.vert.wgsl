// old
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Material {
    u_matrix: mat4x4f,
}
@group(1) @binding(0) var<uniform> material: Material;

// GLSL without a version, which is 1.10.
var<private> a_position: vec3f;
var<private> a_uv: vec2f;
var<private> v_uv: vec2f;
var<private> Position: vec4f;

fn main_() {
    v_uv = a_uv;
    Position = material.u_matrix * vec4f(a_position, 1.0);
}

struct VertexOutput {
    @location(0) v_uv: vec2f,
    @builtin(position) Position: vec4f,
}

@vertex
fn vertex_main(@location(0) a_position_in: vec3f, @location(1) a_uv_in: vec2f) -> VertexOutput {
    a_position = a_position_in;
    a_uv = a_uv_in;
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    return VertexOutput(v_uv, Position);
}
