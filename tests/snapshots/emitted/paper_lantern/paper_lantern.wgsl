// Paper lantern: Paper on a frame with a lamp inside: warm light comes through, the wooden ribs stay
// dark.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Group 0: camera and lights; group 1: the material; group 2: the object.

struct Surface {
    albedo: vec3f,
    normal: vec3f,
    metallic: f32,
    roughness: f32,
    transmittance: f32,
}

struct Material {
    tint: vec4f,  // Multiplies the texture
    normal_scale: f32,  // How strong they are
    metalness: f32,  // 0 = not a metal, 1 = metal
    surface_roughness: f32,  // 0 = a mirror, 1 = chalk
    distortion: f32,  // How much the normal bends the light on its way through: 0 ignores the shape
    subsurface_color: vec3f,  // Colour of the light that has passed through
    scale: f32,  // Strength of the glow towards the light
    power: f32,  // How tight the glow is around the light: the larger, the smaller the spot
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var thickness_texture: texture_2d<f32>;
@group(1) @binding(2) var thickness_texture_sampler: sampler;
@group(1) @binding(3) var base_color_texture: texture_2d<f32>;
@group(1) @binding(4) var base_color_texture_sampler: sampler;
@group(1) @binding(5) var normal_texture: texture_2d<f32>;
@group(1) @binding(6) var normal_texture_sampler: sampler;

// A texel within its range; 0 in place of NaN.
fn valid_texel(x: f32) -> f32 {
    return select(clamp(x, 0.0, 1.0), 0.0, (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// Thickness from a baked map, bright where the body is thick.
fn thickness_map(uv: vec2f) -> f32 {
    return valid_texel(textureSample(thickness_texture, thickness_texture_sampler, uv).r);
}

// Thickness to thinness, in a straight line.
fn thinness_from_thickness(d: f32) -> f32 {
    return clamp(1.0 - d, 0.0, 1.0);
}

// Colour and opacity from a texture and a tint.
fn base_color(uv: vec2f, albedo: ptr<function, vec3f>, alpha: ptr<function, f32>) {
    let texel = material.tint * textureSample(base_color_texture, base_color_texture_sampler, uv);
    *albedo = texel.xyz;
    *alpha = texel.w;
}

// Lays `detail` over `base`: x and y add, z multiplies; for gentle normals their slopes add.
fn blend_normals(base: vec3f, detail: vec3f) -> vec3f {
    return safe_normalize(vec3f(base.xy + detail.xy, base.z * detail.z));
}

// Detail in the normal, from a texture.
fn normal_map(uv: vec2f, normal: ptr<function, vec3f>) {
    let texel = textureSample(normal_texture, normal_texture_sampler, uv).rgb * 2.0 - 1.0;
    *normal = blend_normals(*normal, vec3f(texel.xy * material.normal_scale, texel.z));
}

// The same metalness and roughness everywhere.
fn pbr_constants(metallic: ptr<function, f32>, roughness: ptr<function, f32>) {
    *metallic = material.metalness;
    *roughness = material.surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
fn glow(lobe: f32, through: f32) -> vec3f {
    return material.subsurface_color * (lobe * material.scale * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
fn lobe_normalized(V: vec3f, N: vec3f, L: vec3f, through: f32) -> vec3f {
    let bent = safe_normalize(L + N * material.distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), material.power), through);
}

// The standard light of plain targets: Lambert and GGX with metallic and roughness, for one light.
fn standard(N: vec3f, V: vec3f, L: vec3f, albedo: vec3f, metallic: f32, roughness: f32,
    light_color: vec3f) -> vec3f {
    let H = safe_normalize(V + L);
    let NoL = max(dot(N, L), 0.0);
    let NoV = max(dot(N, V), 0.0001);
    let NoH = clamp(dot(N, H), 0.0, 1.0);
    let a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but exact where N and H nearly meet and a mirror has its peak; never below a^2
    let across = cross(N, H);
    let spread = select(1.0, max(dot(across, across) + NoH * NoH * (a * a), a * a), NoH > 0.0);
    // D times pi
    let facets = a * a / (spread * spread);
    // masking and shadowing, over 4 dot(N, L) dot(N, V)
    let visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // nothing reflects more than all
    let F0 = mix(vec3f(0.04), min(albedo, vec3f(1.0)), metallic);
    let F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    let diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    return (diffuse + facets * visible * F) * NoL * light_color;
}

// Everything about the surface that does not depend on a light.
fn evaluate_surface(uv: vec2f) -> Surface {
    let thickness = thickness_map(uv);
    let thinness = thinness_from_thickness(thickness);
    let transmittance = thinness;
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha);
    var normal = vec3f(0.0, 0.0, 1.0);
    normal_map(uv, &normal);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness);
    return Surface(albedo, normal, metallic, roughness, transmittance);
}

// What one light adds from behind, as a factor on its colour.
fn evaluate_translucency(surface: Surface, V: vec3f, N: vec3f, L: vec3f) -> vec3f {
    return lobe_normalized(V, N, L, surface.transmittance);
}

// What one light adds from the front.
fn evaluate_lighting(surface: Surface, N: vec3f, V: vec3f, L: vec3f, light_color: vec3f) -> vec3f {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

struct Camera {
    view_projection: mat4x4f,
    inverse_view_projection: mat4x4f,
    position: vec3f,
    time: f32,  // s
}
@group(0) @binding(0) var<uniform> camera: Camera;

const MAX_LIGHTS = 4;

struct Lights {
    ambient: vec3f,
    count: i32,
    positions: array<vec4f, MAX_LIGHTS>,  // w = 1: where the light is; w = 0: the direction towards it
    colors: array<vec4f, MAX_LIGHTS>,
}
@group(0) @binding(1) var<uniform> lights: Lights;

struct Object {
    model: mat4x4f,
    inverse_model: mat4x4f,
}
@group(2) @binding(0) var<uniform> object: Object;

struct VertexInput {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,  // w: handedness, +1 or -1
    @location(3) uv: vec2f,
}

struct Varyings {
    @builtin(position) clip_position: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

@vertex
fn vertex_main(input: VertexInput) -> Varyings {
    let world_position = object.model * vec4f(input.position, 1.0);
    var output: Varyings;
    output.clip_position = camera.view_projection * world_position;
    output.position = world_position.xyz;
    output.normal = (vec4f(input.normal, 0.0) * object.inverse_model).xyz;
    let mirrored = sign(determinant(mat3x3f(object.model[0].xyz, object.model[1].xyz, object.model[2].xyz)));
    output.tangent = vec4f((object.model * vec4f(input.tangent.xyz, 0.0)).xyz, input.tangent.w * mirrored);
    output.uv = input.uv;
    return output;
}

// v / |v|; 0 stays 0, of which normalize makes NaN.
fn unit_vector(v: vec3f) -> vec3f {
    let square = dot(v, v);
    if (square > 1e-30) {
        return v * inverseSqrt(square);
    }
    return vec3f(0.0);
}

@fragment
fn fragment_main(input: Varyings) -> @location(0) vec4f {
    let V = unit_vector(camera.position - input.position);
    var N = unit_vector(input.normal);
    let T = unit_vector(input.tangent.xyz);
    let B = cross(N, T) * input.tangent.w;
    let surface = evaluate_surface(input.uv);
    N = unit_vector(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);

    var color = lights.ambient * surface.albedo;
    for (var i = 0; i < min(lights.count, MAX_LIGHTS); i++) {
        let to_light = lights.positions[i].xyz - input.position * lights.positions[i].w;
        let distance_squared = max(dot(to_light, to_light), 1e-4);
        let L = to_light * inverseSqrt(distance_squared);
        let light_color = lights.colors[i].rgb * mix(1.0, 1.0 / distance_squared, lights.positions[i].w);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L) * light_color;
    }
    return vec4f(color, 1.0);
}
