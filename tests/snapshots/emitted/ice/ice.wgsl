// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for WGSL (WebGPU). Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Group 0: camera and lights; group 1: the material; group 2: the object.

struct Cell {
    nearest: vec2f,
    second: vec2f,
    level: f32,
}

struct Surface {
    albedo: vec3f,
    alpha: f32,
    normal: vec3f,
    metallic: f32,
    roughness: f32,
    emission: vec3f,
    transmittance: f32,
}

const JITTER: f32 = 0.6;
const OPAQUE_DISTANCE: f32 = 1.0e-6;
const ENDLESS: f32 = 10000.0;
const OPAQUE_DEPTH: f32 = 80.0;
const MAX_LIGHTS: i32 = 4;

struct Material {
    variation: f32,  // How much the levels of the cells differ: 0 = all are equal
    cell_count: f32,  // Number of cells along one unit of texture coordinate
    thickness_factor: f32,  // Thickness of a cell of level 1
    bevel: f32,  // Width of the slope next to an edge, in cells
    attenuation_distance: f32,  // The length after which 1/e (37 %) of the light remains; 0 = opaque
    tint: vec4f,  // Multiplies the texture
    metalness: f32,  // 0 = not a metal, 1 = metal
    surface_roughness: f32,  // 0 = smooth as a mirror, 1 = rough as chalk
    relief: f32,  // Height of the thickest cells above their edges
    uv_per_unit: vec2f,  // Change of the texture coordinates per world unit along T and along B
    cover: f32,  // Multiplies the texture
    red_speed: vec2f,  // Velocity of the red layer
    green_speed: vec2f,  // Velocity of the green layer
    blue_speed: vec2f,  // Velocity of the blue layer
    vein_color: vec3f,  // Colour of the light in the red and green layers, where both are bright
    spark_color: vec3f,  // Colour of the light in the blue layer
    texel_size: f32,  // The length, in texture coordinates, over which slopes are measured: about one texel
    edge: f32,  // Width of the soft edge, in the texture's values
    erosion: f32,  // How much is eroded: 0 = nothing, 1 = everything
    edge_height: f32,  // Height of the step in the surface at the edge
    distortion: f32,  // How far the normal bends the light's direction inside the body: 0 ignores the shape
    subsurface_color: vec3f,  // Colour of the transmitted light
    attenuation: f32,  // Factor on the whole result
    scale: f32,  // Strength of the glow towards the light
    ambient: f32,  // Glow that does not depend on the direction
    power: f32,  // How narrow the glow around the light is: the larger, the smaller the spot
}
@group(1) @binding(0) var<uniform> material: Material;

@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
@group(1) @binding(2) var base_color_texture_sampler: sampler;
@group(1) @binding(3) var cover_texture: texture_2d<f32>;
@group(1) @binding(4) var cover_texture_sampler: sampler;
@group(1) @binding(5) var packed_texture: texture_2d<f32>;
@group(1) @binding(6) var packed_texture_sampler: sampler;
@group(1) @binding(7) var erosion_texture: texture_2d<f32>;
@group(1) @binding(8) var erosion_texture_sampler: sampler;

// The direction of `x`; of a zero vector, 0.
fn safe_normalize_vec2(x: vec2f) -> vec2f {
    return x * select(0.0, inverseSqrt(dot(x, x)), dot(x, x) > 1.0e-30);
}

// The direction of `x`; of a zero vector, 0.
fn safe_normalize_vec3(x: vec3f) -> vec3f {
    return x * select(0.0, inverseSqrt(dot(x, x)), dot(x, x) > 1.0e-30);
}

// Scrambles the bits of `x`; 0 stays 0.
fn hash_bits(x_in: u32) -> u32 {
    var x = x_in;
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of `x`.
fn hash_unit(x: u32) -> f32 {
    return f32(hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at `p`.
fn cell_at(p: vec2f) -> Cell {
    var nearest = vec2f(4.0);
    var second = vec2f(4.0);
    // their squared lengths
    var first_square = 32.0;
    var second_square = 32.0;
    var owner = 0u;
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    let home = floor(p);
    let within = p - home;
    for (var j = -1; j <= 1; j++) {
        for (var i = -1; i <= 1; i++) {
            let offset = vec2f(f32(i), f32(j));
            let corner = home + offset;
            let seed = hash_bits(u32(i32(corner.x)) + hash_bits(u32(i32(corner.y)) + 1u));
            let shift = vec2f(hash_unit(seed + 1u), hash_unit(seed + 2u)) - 0.5;
            let to_site = offset + 0.5 + JITTER * shift - within;
            let square = dot(to_site, to_site);
            if (square < first_square) {
                second = nearest;
                second_square = first_square;
                nearest = to_site;
                first_square = square;
                owner = seed;
            } else if (square < second_square) {
                second = to_site;
                second_square = square;
            }
        }
    }
    let level = 1.0 - material.variation * hash_unit(owner + 3u);
    return Cell(nearest, second, level);
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
fn to_edge(cell: Cell) -> f32 {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
fn voronoi_thickness(uv: vec2f) -> f32 {
    let cell = cell_at(uv * material.cell_count);
    return material.thickness_factor * cell.level * smoothstep(0.0, material.bevel, to_edge(cell));
}

// The thickness `d` in mean free paths, 0 or more.
fn optical_depth(d: f32, mean_free_path: f32) -> f32 {
    let path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
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

// The gradient of to_edge.
fn from_edge(cell: Cell) -> vec2f {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize_vec2(cell.nearest) - normalize(cell.second);
}

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
fn blend_normals(base: vec3f, detail: vec3f) -> vec3f {
    return safe_normalize_vec3(vec3f(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
fn normal_of_slope(slope: vec2f) -> vec3f {
    return normalize(vec3f(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
fn voronoi_normal(uv: vec2f, normal: ptr<function, vec3f>) {
    let cell = cell_at(uv * material.cell_count);
    let x = clamp(to_edge(cell) / material.bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    let steepness = cell.level * 6.0 * x * (1.0 - x) / material.bevel;
    let slope = material.relief * material.uv_per_unit * material.cell_count * steepness * from_edge(cell);
    *normal = blend_normals(*normal, normal_of_slope(slope));
}

// Only the bare ice transmits light.
fn ice_mask(uv: vec2f, through: ptr<function, f32>) {
    let covered = material.cover * textureSample(cover_texture, cover_texture_sampler, uv).r;
    *through = *through * smoothstep(0.0, 0.1, 1.0 - covered);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
fn layer(uv: vec2f, speed: vec2f, time: f32) -> vec4f {
    return textureSample(packed_texture, packed_texture_sampler, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
fn packed_scroll(uv: vec2f, time: f32, emission: ptr<function, vec3f>) {
    let veins = layer(uv, material.red_speed, time).x * layer(uv, material.green_speed, time).y;
    let sparks = layer(uv, material.blue_speed, time).z;
    *emission = min(*emission + (material.vein_color * veins + material.spark_color * sparks),
        vec3f(65504.0));
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
fn left_at(uv: vec2f) -> f32 {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    let threshold = mix(-material.edge, 1.0, material.erosion);
    return clamp((textureSample(erosion_texture, erosion_texture_sampler, uv).r - threshold) / material.edge,
        0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
fn alpha_erosion(uv: vec2f, alpha: ptr<function, f32>, normal: ptr<function, vec3f>) {
    let e = vec2f(material.texel_size, 0.0);
    let across = left_at(uv + e) - left_at(uv - e);
    let up = left_at(uv + e.yx) - left_at(uv - e.yx);
    let slope = material.edge_height * material.uv_per_unit * vec2f(across, up) / (2.0 * material.texel_size);
    *normal = blend_normals(*normal, normal_of_slope(slope));
    *alpha *= left_at(uv);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
fn glow(lobe: f32, through: f32) -> vec3f {
    return material.subsurface_color
        * (material.attenuation * (lobe * material.scale + material.ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
fn lobe_normalized(V: vec3f, N: vec3f, L: vec3f, through: f32) -> vec3f {
    let bent = safe_normalize_vec3(L + N * material.distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), material.power), through);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
fn lobe_surroundings(mean_lobe: f32, through: f32, irradiance_behind: vec3f) -> vec3f {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through) * irradiance_behind;
}

// The light of the surroundings that comes through.
fn lobe_normalized_surroundings(through: f32, irradiance_behind: vec3f) -> vec3f {
    return lobe_surroundings(1.0 / (material.power + 1.0), through, irradiance_behind);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
fn standard(N: vec3f, V: vec3f, L: vec3f, albedo: vec3f, metallic: f32, roughness: f32,
    light_color: vec3f) -> vec3f {
    let H = safe_normalize_vec3(V + L);
    let NoL = max(dot(N, L), 0.0);
    let NoV = max(dot(N, V), 0.0001);
    let NoH = clamp(dot(N, H), 0.0, 1.0);
    let a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but accurate at the peak, where N and H nearly coincide; never below a^2
    let across = cross(N, H);
    let spread = select(1.0, max(dot(across, across) + NoH * NoH * (a * a), a * a), NoH > 0.0);
    // D times pi
    let facets = a * a / (spread * spread);
    // masking and shadowing, divided by 4 dot(N, L) dot(N, V)
    let visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // a surface reflects at most all light
    let F0 = mix(vec3f(0.04), min(albedo, vec3f(1.0)), metallic);
    // what reflects less than 2 % from the front is no mirror from the side
    let F90 = min(max(dot(F0, vec3f(17.0)), metallic), 1.0);
    let F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    let diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    let reflected = (diffuse + facets * visible * F) * NoL;
    return reflected * light_color;
}

// The values of the surface that do not depend on a light.
fn evaluate_surface(uv: vec2f, time: f32, irradiance_behind: vec3f) -> Surface {
    let thickness = voronoi_thickness(uv);
    var transmittance = beer_lambert(thickness);
    var albedo: vec3f;
    var alpha: f32;
    base_color(uv, &albedo, &alpha);
    var metallic: f32;
    var roughness: f32;
    pbr_constants(&metallic, &roughness);
    var normal = vec3f(0.0, 0.0, 1.0);
    voronoi_normal(uv, &normal);
    ice_mask(uv, &transmittance);
    var emission = vec3f(0.0);
    packed_scroll(uv, time, &emission);
    alpha_erosion(uv, &alpha, &normal);
    emission += lobe_normalized_surroundings(transmittance, irradiance_behind);
    return Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
}

// The transmitted light of one light, as a factor on its colour.
fn evaluate_translucency(surface: Surface, V: vec3f, N: vec3f, L: vec3f) -> vec3f {
    return lobe_normalized(V, N, L, surface.transmittance);
}

// The reflected light of one light.
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

struct Lights {
    ambient: vec3f,
    count: i32,
    positions: array<vec4f, 4>,  // w = 1: where the light is; w = 0: the direction towards it
    colors: array<vec4f, 4>,
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
fn vertex_main(mesh: VertexInput) -> Varyings {
    var output: Varyings;
    let world_position = object.model * vec4f(mesh.position, 1.0);
    output.clip_position = camera.view_projection * world_position;
    output.position = world_position.xyz;
    output.normal = (vec4f(mesh.normal, 0.0) * object.inverse_model).xyz;
    let mirrored = sign(determinant(mat3x3f(object.model[0].xyz, object.model[1].xyz, object.model[2].xyz)));
    output.tangent = vec4f((object.model * vec4f(mesh.tangent.xyz, 0.0)).xyz, mesh.tangent.w * mirrored);
    output.uv = mesh.uv;
    return output;
}

@fragment
fn fragment_main(input: Varyings) -> @location(0) vec4f {
    let V = safe_normalize_vec3(camera.position - input.position);
    var N = safe_normalize_vec3(input.normal);
    let T = safe_normalize_vec3(input.tangent.xyz);
    let B = cross(N, T) * input.tangent.w;
    let surface = evaluate_surface(input.uv, camera.time, lights.ambient);
    let across = T * surface.normal.x + B * surface.normal.y;
    N = safe_normalize_vec3(across + N * surface.normal.z);
    var color = lights.ambient * surface.albedo + surface.emission;
    for (var i = 0; i < min(lights.count, MAX_LIGHTS); i++) {
        let near = lights.positions[i].w;
        let to_light = lights.positions[i].xyz - input.position * near;
        let distance_squared = max(dot(to_light, to_light), 0.0001);
        let L = to_light * inverseSqrt(distance_squared);
        let light_color = lights.colors[i].xyz * mix(1.0, 1.0 / distance_squared, near);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L) * light_color;
    }
    if (surface.alpha < 0.5) {
        discard;
    }
    return vec4f(color, surface.alpha);
}
