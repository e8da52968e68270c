// old
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Material {
    u_tint: vec4f,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var u_map: texture_2d<f32>;
@group(1) @binding(2) var u_map_sampler: sampler;
@group(1) @binding(3) var u_sky: texture_cube<f32>;
@group(1) @binding(4) var u_sky_sampler: sampler;

var<private> v_uv: vec2f;
var<private> v_normal: vec3f;
var<private> FragColor: vec4f;

fn grain(p: vec2f) -> f32 {
    return fract(sin(dot(p, vec2f(12.9898, 78.233))) * 43758.5453);
}

fn main_() {
    let n = normalize(v_normal);
    var base = textureSample(u_map, u_map_sampler, v_uv) * material.u_tint;
    base += textureSampleLevel(u_map, u_map_sampler, v_uv, 2.0) * 0.25;
    let place = vec3f(v_uv, 2.0);
    base += textureSampleBias(u_map, u_map_sampler, v_uv * 2.0, 1.0)
        + textureSample(u_map, u_map_sampler, place.xy / place.z);
    let sky = textureSample(u_sky, u_sky_sampler, reflect(vec3f(0.0, 0.0, -1.0), n)).rgb;
    let lines = length(dpdx(v_uv)) + grain(v_uv);
    FragColor = vec4f(base.rgb * sky, base.a);
    FragColor.a *= lines;
}

@fragment
fn fragment_main(@location(0) v_normal_in: vec3f, @location(1) v_uv_in: vec2f) -> @location(0) vec4f {
    v_normal = v_normal_in;
    v_uv = v_uv_in;
    main_();
    return FragColor;
}
