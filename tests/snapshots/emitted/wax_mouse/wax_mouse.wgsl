// Wax mouse: A candle in the shape of a mouse: the ears glow, the body stays deep.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Group 0: camera and lights; group 1: the material; group 2: the object.

struct Surface {
    albedo: vec3f,
    metallic: f32,
    roughness: f32,
}

const NEGLIGIBLE: f32 = 1.0e-6;
const DARKEST: f32 = 0.0001;
const OPAQUE_DISTANCE: f32 = 1.0e-6;
const ENDLESS: f32 = 10000.0;
const OPAQUE_DEPTH: f32 = 80.0;

struct Material {
    box_max: vec3f,  // The box's largest corner
    box_min: vec3f,  // The box's smallest corner
    distance_range: f32,  // The distance that the texture's 1 stands for
    object_scale: f32,  // World units in one unit of object space (uniform scale)
    tint: vec4f,  // Multiplies the texture
    metalness: f32,  // 0 = not a metal, 1 = metal
    surface_roughness: f32,  // 0 = a mirror, 1 = chalk
    attenuation_color: vec3f,  // The colour that white light has after attenuation_distance
    attenuation_distance: f32,  // The length after which white light has attenuation_color; 0 = opaque
    weight: f32,  // How much of the light goes in at all
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var distance_map: texture_3d<f32>;
@group(1) @binding(2) var distance_map_sampler: sampler;
@group(1) @binding(3) var base_color_texture: texture_2d<f32>;
@group(1) @binding(4) var base_color_texture_sampler: sampler;

// The direction of `x`; of a zero vector, 0.
fn safe_normalize(x: vec3f) -> vec3f {
    return x * inverseSqrt(max(dot(x, x), 1.0e-30));
}

// The box's size; a flat box is padded to a thousandth of its diagonal, about its centre.
fn box_size() -> vec3f {
    return max(material.box_max - material.box_min,
        vec3f(0.001 * distance(material.box_min, material.box_max)));
}

// The way from the box's centre to `p`.
fn from_box_center(p: vec3f) -> vec3f {
    return p - 0.5 * (material.box_min + material.box_max);
}

// How far it is from `p`, inside the box, along `direction` to the box's side.
fn box_exit(p: vec3f, direction: vec3f) -> f32 {
    let exits = (0.5 * box_size() - from_box_center(p) * sign(direction)) / max(abs(direction),
        vec3f(1.0e-20));
    // along a zero direction it would be endless
    return clamp(min(exits.x, min(exits.y, exits.z)), 0.0, length(box_size()));
}

// The signed distance to a mesh, from a 3-D texture that was baked over a box in object space.
fn distance_texture(p: vec3f) -> f32 {
    let uvw = clamp(from_box_center(p) / max(box_size(), vec3f(1.0e-20)) + 0.5, vec3f(0.0), vec3f(1.0));
    return (2.0 * textureSampleLevel(distance_map, distance_map_sampler, uvw, 0.0).r - 1.0)
        * material.distance_range;
}

// The part of a step that is inside the body, where the distance goes from `a` to `b` in a straight line.
fn inside_part(a: f32, b: f32) -> f32 {
    let inside = max(-a, 0.0) + max(-b, 0.0);
    let whole = abs(a) + abs(b);
    return inside / max(whole, 1.0e-20);
}

// The length inside the body from `p` to the box's side, along L.
fn length_to_light(p: vec3f, L: vec3f) -> f32 {
    let h = box_exit(p, L) / 8.0;
    var inside = 0.0;
    var before = distance_texture(p);
    // it ends where the body is farther away than the box's side
    for (var i = 1; i <= 8 && before < h * f32(9 - i); i++) {
        let after = distance_texture(p + L * (h * f32(i)));
        inside += inside_part(before, after);
        before = after;
    }
    return inside * h;
}

// Mean length, inside the body, of the light's ways to the eye: in along L, out along V.
fn march_distance_texture(P_object: vec3f, V_object: vec3f, L_object: vec3f) -> f32 {
    let length_of_view = box_exit(P_object, -V_object);
    var seen = 0.0;
    var way = 0.0;
    var last = 0.0;
    var before = distance_texture(P_object);
    for (var i = 1; i <= 8 && before < length_of_view - last; i++) {
        let x = f32(i) / 8.0;
        let t = length_of_view * x * x;
        let after = distance_texture(P_object - V_object * t);
        let inside = (t - last) * inside_part(before, after);
        if (inside > 0.0) {
            // the light scatters in the middle of what is inside
            let middle = select(t - 0.5 * inside, last + 0.5 * inside, before < after);
            way += inside * (seen + 0.5 * inside + length_to_light(P_object - V_object * middle, L_object));
            seen += inside;
        }
        before = after;
        last = t;
    }
    if (seen < NEGLIGIBLE) {
        // a view that only grazes the body sees the light leave where it is
        return material.object_scale * length_to_light(P_object, L_object);
    }
    let mean = way / seen;
    return material.object_scale * mean;
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

// `d` in mean free paths, 0 or more.
fn optical_depth(d: f32, mean_free_path: f32) -> f32 {
    let path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Light that comes through coloured by what the body absorbs: deeper colours where it is thicker.
fn absorption_tint(d: f32) -> vec3f {
    let sigma_d = -log(clamp(material.attenuation_color, vec3f(DARKEST), vec3f(1.0)))
        * optical_depth(d, material.attenuation_distance);
    return material.weight * exp(-min(sigma_d, vec3f(OPAQUE_DEPTH)));
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
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness);
    return Surface(albedo, metallic, roughness);
}

// What one light adds from behind, as a factor on its colour.
fn evaluate_translucency(surface: Surface, P_object: vec3f, V_object: vec3f, L_object: vec3f) -> vec3f {
    let thickness = march_distance_texture(P_object, V_object, L_object);
    return absorption_tint(thickness);
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
    @location(3) uv: vec2f,
}

struct Varyings {
    @builtin(position) clip_position: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(3) uv: vec2f,
}

@vertex
fn vertex_main(input: VertexInput) -> Varyings {
    let world_position = object.model * vec4f(input.position, 1.0);
    var output: Varyings;
    output.clip_position = camera.view_projection * world_position;
    output.position = world_position.xyz;
    output.normal = (vec4f(input.normal, 0.0) * object.inverse_model).xyz;
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
    let surface = evaluate_surface(input.uv);

    var color = lights.ambient * surface.albedo;
    for (var i = 0; i < min(lights.count, MAX_LIGHTS); i++) {
        let to_light = lights.positions[i].xyz - input.position * lights.positions[i].w;
        let distance_squared = max(dot(to_light, to_light), 1e-4);
        let L = to_light * inverseSqrt(distance_squared);
        let light_color = lights.colors[i].rgb * mix(1.0, 1.0 / distance_squared, lights.positions[i].w);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, (object.inverse_model * vec4f(input.position, 1.0)).xyz, unit_vector((object.inverse_model * vec4f(V, 0.0)).xyz), unit_vector((object.inverse_model * vec4f(L, 0.0)).xyz)) * light_color;
    }
    return vec4f(color, 1.0);
}
