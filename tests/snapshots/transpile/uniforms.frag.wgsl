// uniforms
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Light {
    position: vec3f,
    color: vec3f,
    range: f32,
}

struct Fog {
    color: vec3f,
    density: f32,
}

struct Material {
    view: mat4x4f,
    eye: vec3f,
    shading_base: vec4f,
    shading_weights: array<vec4f, 2>,
    lights_position: array<vec4f, 2>,
    lights_color: array<vec4f, 2>,
    lights_range: array<vec4f, 2>,
    fog_color: vec3f,
    fog_density: f32,
    time: f32,
    exposure: f32,
    count: i32,
    mask: u32,
    foggy: i32,
    points: array<vec4f, 3>,
    turn: mat3x3f,
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var albedo: texture_2d<f32>;
@group(1) @binding(2) var albedo_sampler: sampler;
@group(1) @binding(3) var sky: texture_cube<f32>;
@group(1) @binding(4) var sky_sampler: sampler;

var<private> v_position: vec3f;
var<private> v_normal: vec3f;
var<private> color: vec4f;

fn lit(light: Light, p: vec3f, n: vec3f) -> vec3f {
    let to = light.position - p;
    let fade = max(1.0 - length(to) / light.range, 0.0);
    return light.color * max(dot(normalize(to), n), 0.0) * fade;
}

fn main_() {
    let n = normalize(material.turn * v_normal);
    var sum = textureSample(sky, sky_sampler, n).rgb * material.shading_weights[0].x;
    for (var i = 0; i < 2; i++) {
        if (i >= material.count || (material.mask & (1u << u32(i))) == 0u) {
            continue;
        }
        sum += lit(Light(material.lights_position[i].xyz, material.lights_color[i].xyz,
            material.lights_range[i].x), v_position, n) * material.shading_weights[1].x;
    }
    if (material.foggy != 0) {
        sum = mix(sum, material.fog_color, 1.0
            - exp(-material.fog_density * distance(material.eye, v_position)));
    }
    let uv = (material.view * vec4f(v_position, 1.0)).xy + material.points[2].xy * material.time;
    color = vec4f(sum * material.exposure, 1.0) * material.shading_base
        * textureSample(albedo, albedo_sampler, uv);
}

@fragment
fn fragment_main(@location(0) v_normal_in: vec3f, @location(1) v_position_in: vec3f) -> @location(0) vec4f {
    v_normal = v_normal_in;
    v_position = v_position_in;
    main_();
    return color;
}
