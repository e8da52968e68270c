// instanced
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

const TARGETS: i32 = 3;

struct Material {
    morph_weights: array<vec4f, 3>,
    base_weight: f32,
    view_projections: array<mat4x4f, 2>,
    model: mat4x4f,
    DrawID: i32,
    ViewID_OVR: u32,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var morph_texture: texture_2d_array<f32>;
@group(1) @binding(2) var morph_texture_sampler: sampler;
@group(1) @binding(3) var batch_texture: texture_2d<f32>;
@group(1) @binding(4) var batch_texture_sampler: sampler;
@group(1) @binding(5) var batch_ids: texture_2d<u32>;
@group(1) @binding(6) var batch_ids_sampler: sampler;

var<private> position: vec3f;
var<private> normal: vec3f;
var<private> joints: vec4u;
var<private> instance: mat4x4f;
var<private> instance_color: vec3f;
var<private> v_normal: vec3f;
var<private> v_joints: vec2u;
var<private> v_color: vec3f;
var<private> v_depth: f32;
var<private> VertexID: i32;
var<private> InstanceID: i32;
var<private> Position: vec4f;

fn texelFetch(map: texture_2d_array<f32>, map_sampler: sampler, P: vec3i, level: i32) -> vec4f {
    return textureLoad(map, P.xy, P.z, level);
}

fn morph(vertex: i32, target_: i32, part: i32) -> vec4f {
    let width = vec3i(vec3u(textureDimensions(morph_texture, 0), textureNumLayers(morph_texture))).x;
    let texel = vertex * 2 + part;
    return texelFetch(morph_texture, morph_texture_sampler, vec3i(texel % width, texel / width, target_), 0);
}

fn batched(id: u32) -> mat4x4f {
    let size = vec2i(textureDimensions(batch_texture, 0)).x;
    let first = i32(id) * 4;
    let at = vec2i(first % size, first / size);
    return mat4x4f(textureLoad(batch_texture, at, 0), textureLoad(batch_texture, at + vec2i(1, 0), 0),
        textureLoad(batch_texture, at + vec2i(2, 0), 0), textureLoad(batch_texture, at + vec2i(3, 0), 0));
}

fn batch_id(draw: i32) -> u32 {
    let size = vec2i(textureDimensions(batch_ids, 0)).x;
    return textureLoad(batch_ids, vec2i(draw % size, draw / size), 0).r;
}

fn main_() {
    var p = position * material.base_weight;
    var n = normal * material.base_weight;
    for (var i = 0; i < TARGETS; i++) {
        if (material.morph_weights[i].x != 0.0) {
            p += morph(VertexID, i, 0).xyz * material.morph_weights[i].x;
            n += morph(VertexID, i, 1).xyz * material.morph_weights[i].x;
        }
    }
    let turn = mat3x3f(instance[0].xyz, instance[1].xyz, instance[2].xyz);
    n /= vec3f(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
    v_normal = mat3x3f(material.model[0].xyz, material.model[1].xyz, material.model[2].xyz) * (turn * n);
    v_joints = joints.xy;
    v_color = instance_color * f32(InstanceID);
    let world = material.model * batched(batch_id(material.DrawID)) * instance * vec4f(p, 1.0);
    Position = material.view_projections[material.ViewID_OVR] * world;
    v_depth = Position.w;
}

struct VertexOutput {
    @location(0) @interpolate(flat) v_color: vec3f,
    @location(1) v_depth: f32,
    @location(2) @interpolate(flat) v_joints: vec2u,
    @location(3) v_normal: vec3f,
    @builtin(position) Position: vec4f,
}

@vertex
fn vertex_main(@location(0) position_in: vec3f, @location(1) normal_in: vec3f, @location(2) joints_in: vec4u,
    @location(5) instance_in_0: vec4f, @location(6) instance_in_1: vec4f, @location(7) instance_in_2: vec4f,
    @location(8) instance_in_3: vec4f, @location(9) instance_color_in: vec3f,
    @builtin(vertex_index) VertexID_in: u32, @builtin(instance_index) InstanceID_in: u32) -> VertexOutput {
    position = position_in;
    normal = normal_in;
    joints = joints_in;
    instance[0] = instance_in_0;
    instance[1] = instance_in_1;
    instance[2] = instance_in_2;
    instance[3] = instance_in_3;
    instance_color = instance_color_in;
    VertexID = i32(VertexID_in);
    InstanceID = i32(InstanceID_in);
    main_();
    Position.z = (Position.z + Position.w) * 0.5;
    return VertexOutput(v_color, v_depth, v_joints, v_normal, Position);
}
