// Ice with an inlay: Leaves frozen into a sheet of ice: they lie below its surface, and the sun shines
// through around them.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Group 0: camera and lights; group 1: the material; group 2: the object.

struct Surface {
    albedo: vec3f,
    metallic: f32,
    roughness: f32,
    transmittance: f32,
}

const FLAT_FRAME: f32 = 0.01;
const OPAQUE_DISTANCE: f32 = 1.0e-6;
const ENDLESS: f32 = 10000.0;
const OPAQUE_DEPTH: f32 = 80.0;

struct Material {
    ior: f32,  // Refractive index of the body
    depth: f32,  // How far the image lies below the surface
    uv_per_unit: vec2f,  // How far the texture coordinates move for one world unit along T and along B
    thickness_factor: f32,  // The thickness that white means
    attenuation_distance: f32,  // The length after which 1/e (37 %) of the light is left; 0 = opaque
    tint: vec4f,  // Multiplies the texture
    metalness: f32,  // 0 = not a metal, 1 = metal
    surface_roughness: f32,  // 0 = a mirror, 1 = chalk
    distortion: f32,  // How much the normal bends the light on its way through: 0 ignores the shape
    subsurface_color: vec3f,  // Colour of the light that has passed through
    scale: f32,  // Strength of the glow towards the light
    ambient: f32,  // Glow that is there from every side
    power: f32,  // How tight the glow is around the light: the larger, the smaller the spot
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var thickness_texture: texture_2d<f32>;
@group(1) @binding(2) var thickness_texture_sampler: sampler;
@group(1) @binding(3) var base_color_texture: texture_2d<f32>;
@group(1) @binding(4) var base_color_texture_sampler: sampler;

// A texel within its range; 0 in place of NaN.
fn valid_texel(x: f32) -> f32 {
    return select(clamp(x, 0.0, 1.0), 0.0, (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// The components of `v` along unit T, unit B and N. A frame that spans no space gives (0, 0, dot(v, N)).
fn tangent_from_world(v: vec3f, T: vec3f, B: vec3f, N: vec3f) -> vec3f {
    let volume = dot(T, cross(B, N));
    if (abs(volume) < FLAT_FRAME) {
        return vec3f(0.0, 0.0, dot(v, N));
    }
    let along = vec3f(dot(v, cross(B, N)) * length(T), dot(v, cross(N, T)) * length(B), dot(v, cross(T, B)));
    return along / volume;
}

// The texture coordinates where `ray`, going in, meets the inner layer.
fn slide(uv: vec2f, ray: vec3f, T: vec3f, B: vec3f, N: vec3f) -> vec2f {
    let r = tangent_from_world(ray, T, B, N);
    // to the surface itself, which a sheared frame does not lie in
    let cosine = -dot(ray, N);
    // 1 / cosine, but smoothly down to 0 where a grazing ray would slide without end
    let x = clamp(cosine / 0.2, 0.0, 1.0);
    let reciprocal = x * x * (4.0 - 3.0 * x) / max(cosine, 0.2);
    return uv + material.depth * reciprocal * material.uv_per_unit * r.xy;
}

// Subsurface parallax with refraction: the texture as if it were cast into resin, glass or ice.
fn parallax_refracted(uv: vec2f, V: vec3f, T: vec3f, B: vec3f, N: vec3f) -> vec2f {
    let facing = faceForward(N, -V, N);
    // past the critical angle refract() gives 0, which slides nothing
    let ray = refract(-V, facing, 1.0 / material.ior);
    return slide(uv, ray, T, B, facing);
}

// Thickness from a baked map, bright where the body is thick.
fn thickness_map(uv: vec2f) -> f32 {
    return material.thickness_factor
        * valid_texel(textureSample(thickness_texture, thickness_texture_sampler, uv).r);
}

// `d` in mean free paths, 0 or more.
fn optical_depth(d: f32, mean_free_path: f32) -> f32 {
    let path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Thickness to transmittance: what absorption leaves of the light.
fn beer_lambert(d: f32) -> f32 {
    return exp(-min(optical_depth(d, material.attenuation_distance), OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
fn base_color(uv: vec2f, albedo: ptr<function, vec3f>, alpha: ptr<function, f32>) {
    let texel = material.tint * textureSample(base_color_texture, base_color_texture_sampler, uv);
    *albedo = texel.xyz;
    *alpha = texel.w;
}

// The same metalness and roughness everywhere.
fn pbr_constants(metallic: ptr<function, f32>, roughness: ptr<function, f32>) {
    *metallic = material.metalness;
    *roughness = material.surface_roughness;
}

// The light that comes through where `lobe` (0..1) points at the eye.
fn glow(lobe: f32, through: f32) -> vec3f {
    return material.subsurface_color * ((lobe * material.scale + material.ambient) * through);
}

// The back-light lobe of GDC 2011: the eye looks into light that comes through, bent by the normal.
fn lobe_gdc2011(V: vec3f, N: vec3f, L: vec3f, through: f32) -> vec3f {
    let bent = L + N * material.distortion;
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
fn evaluate_surface(uv_in: vec2f, V: vec3f, T: vec3f, B: vec3f, N: vec3f) -> Surface {
    var uv = uv_in;
    uv = parallax_refracted(uv, V, T, B, N);
    let thickness = thickness_map(uv);
    let transmittance = beer_lambert(thickness);
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness);
    return Surface(albedo, metallic, roughness, transmittance);
}

// What one light adds from behind, as a factor on its colour.
fn evaluate_translucency(surface: Surface, V: vec3f, N: vec3f, L: vec3f) -> vec3f {
    return lobe_gdc2011(V, N, L, surface.transmittance);
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
    let N = unit_vector(input.normal);
    let T = unit_vector(input.tangent.xyz);
    let B = cross(N, T) * input.tangent.w;
    let surface = evaluate_surface(input.uv, V, T, B, N);

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
