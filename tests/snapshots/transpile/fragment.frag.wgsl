// fragment
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Material {
    resolution: vec2f,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var map: texture_2d<f32>;
@group(1) @binding(2) var map_sampler: sampler;

var<private> uv: vec2f;
var<private> kind: i32;
var<private> normal: vec3f;
var<private> along: f32;
var<private> shade: vec4f;
var<private> color: vec4f;
var<private> motion: vec2f;
var<private> FragCoord: vec4f;
var<private> FragDepth: f32;
var<private> FrontFacing: bool;

fn edge(x: f32) -> f32 {
    let width = fwidth(x);
    return smoothstep(0.5 - width, 0.5 + width, x);
}

fn main_() {
    let at = FragCoord.xy / material.resolution;
    let texel = textureSample(map, map_sampler, uv);
    let slope = vec2f(dpdx(texel.x), -dpdy(texel.x));
    let sharp = edge(along);
    if (texel.a < 0.5) {
        discard;
    }
    motion = slope;
    FragDepth = FragCoord.z;
    if (kind == 0) {
        color = vec4f(at, 0.0, 1.0);
        return;
    }
    let facing = select(-normal, normal, FrontFacing);
    let color_xyz = normalize(facing) * 0.5 + 0.5;
    color = vec4f(color_xyz, color.w);
    color.a = sharp;
    color *= shade;
}

struct FragmentOutput {
    @location(0) color: vec4f,
    @location(1) motion: vec2f,
    @builtin(frag_depth) FragDepth: f32,
}

@fragment
fn fragment_main(@location(0) @interpolate(linear) along_in: f32,
    @location(1) @interpolate(flat) kind_in: i32,
    @location(2) @interpolate(perspective, centroid) normal_in: vec3f, @location(3) shade_in: vec4f,
    @location(4) uv_in: vec2f, @builtin(position) FragCoord_in: vec4f,
    @builtin(front_facing) FrontFacing_in: bool) -> FragmentOutput {
    along = along_in;
    kind = kind_in;
    normal = normal_in;
    shade = shade_in;
    uv = uv_in;
    FragCoord = FragCoord_in;
    FrontFacing = FrontFacing_in;
    main_();
    return FragmentOutput(color, motion, FragDepth);
}
