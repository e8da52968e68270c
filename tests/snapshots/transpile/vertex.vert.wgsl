// vertex
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Material {
    view_projection: mat4x4f,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var heights: texture_2d<f32>;
@group(1) @binding(2) var heights_sampler: sampler;

var<private> position: vec3f;
var<private> texcoord: vec2f;
var<private> instance: mat4x4f;
var<private> uv: vec2f;
var<private> kind: i32;
var<private> VertexID: i32;
var<private> InstanceID: i32;
var<private> PointSize: f32;
var<private> Position: vec4f;

fn main_() {
    let row = f32(VertexID / 8 + InstanceID);
    var p = position;
    p.y += textureSampleLevel(heights, heights_sampler, texcoord, 0.0).r + row * 0.25;
    uv = texcoord * 2.0 - 1.0;
    kind = VertexID % 3;
    PointSize = 4.0;
    Position = material.view_projection * instance * vec4f(p, 1.0);
}

struct VertexOutput {
    @location(0) @interpolate(flat) kind: i32,
    @location(1) uv: vec2f,
    @builtin(position) Position: vec4f,
}

@vertex
fn vertex_main(@location(0) position_in: vec3f, @location(1) texcoord_in: vec2f,
    @location(2) instance_in_0: vec4f, @location(3) instance_in_1: vec4f, @location(4) instance_in_2: vec4f,
    @location(5) instance_in_3: vec4f, @builtin(vertex_index) VertexID_in: u32,
    @builtin(instance_index) InstanceID_in: u32) -> VertexOutput {
    position = position_in;
    texcoord = texcoord_in;
    instance[0] = instance_in_0;
    instance[1] = instance_in_1;
    instance[2] = instance_in_2;
    instance[3] = instance_in_3;
    VertexID = i32(VertexID_in);
    InstanceID = i32(InstanceID_in);
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    return VertexOutput(kind, uv, Position);
}
