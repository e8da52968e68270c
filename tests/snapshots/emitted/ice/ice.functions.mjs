// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for PlayCanvas. Change the material and emit it again rather than this file.
// The assembled functions in both languages; `entries` tells how to call them. ice.mjs has them as a material.

/** GLSL ES 3.00. */
export const glsl = /* glsl */ `
struct sss_Cell {
    vec2 nearest;
    vec2 second;
    float level;
};

struct sss_Surface {
    vec3 albedo;
    float alpha;
    vec3 normal;
    float metallic;
    float roughness;
    vec3 emission;
    float transmittance;
};

const float sss_JITTER = 0.6;
const float sss_OPAQUE_DISTANCE = 1.0e-6;
const float sss_ENDLESS = 10000.0;
const float sss_OPAQUE_DEPTH = 80.0;

// The direction of \`x\`; of a zero vector, 0.
vec2 sss_safe_normalize(vec2 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// The direction of \`x\`; of a zero vector, 0.
vec3 sss_safe_normalize(vec3 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// Scrambles the bits of \`x\`; 0 stays 0.
uint sss_hash_bits(uint x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of \`x\`.
float sss_hash_unit(uint x) {
    return float(sss_hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at \`p\`.
sss_Cell sss_cell_at(vec2 p, float variation) {
    vec2 nearest = vec2(4.0);
    vec2 second = vec2(4.0);
    // their squared lengths
    float first_square = 32.0;
    float second_square = 32.0;
    uint owner = 0u;
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    vec2 home = floor(p);
    vec2 within = p - home;
    for (int j = -1; j <= 1; j++) {
        for (int i = -1; i <= 1; i++) {
            vec2 offset = vec2(float(i), float(j));
            vec2 corner = home + offset;
            uint seed = sss_hash_bits(uint(int(corner.x)) + sss_hash_bits(uint(int(corner.y)) + 1u));
            vec2 shift = vec2(sss_hash_unit(seed + 1u), sss_hash_unit(seed + 2u)) - 0.5;
            vec2 to_site = offset + 0.5 + sss_JITTER * shift - within;
            float square = dot(to_site, to_site);
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
    float level = 1.0 - variation * sss_hash_unit(owner + 3u);
    return sss_Cell(nearest, second, level);
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
float sss_to_edge(sss_Cell cell) {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
float sss_voronoi_thickness(vec2 uv, float variation, float cell_count, float thickness_factor, float bevel) {
    sss_Cell cell = sss_cell_at(uv * cell_count, variation);
    return thickness_factor * cell.level * smoothstep(0.0, bevel, sss_to_edge(cell));
}

// The thickness \`d\` in mean free paths, 0 or more.
float sss_optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, sss_OPAQUE_DISTANCE);
    return clamp(d, 0.0, sss_ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
float sss_beer_lambert(float d, float attenuation_distance) {
    return exp(-min(sss_optical_depth(d, attenuation_distance), sss_OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
void sss_base_color(vec2 uv, out vec3 albedo, out float alpha, vec4 tint, sampler2D base_color_texture) {
    vec4 texel = tint * texture(base_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void sss_pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The gradient of to_edge.
vec2 sss_from_edge(sss_Cell cell) {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return sss_safe_normalize(cell.nearest) - normalize(cell.second);
}

// Adds \`detail\` to \`base\`: x and y are added, z is multiplied; for small slopes this adds the slopes.
vec3 sss_blend_normals(vec3 base, vec3 detail) {
    return sss_safe_normalize(vec3(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; \`slope\` is the increase in height per unit of length along T and B.
vec3 sss_normal_of_slope(vec2 slope) {
    return normalize(vec3(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
void sss_voronoi_normal(vec2 uv, inout vec3 normal, float variation, float cell_count, float bevel,
    float relief, vec2 uv_per_unit) {
    sss_Cell cell = sss_cell_at(uv * cell_count, variation);
    float x = clamp(sss_to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    vec2 slope = relief * uv_per_unit * cell_count * steepness * sss_from_edge(cell);
    normal = sss_blend_normals(normal, sss_normal_of_slope(slope));
}

// Only the bare ice transmits light.
void sss_ice_mask(vec2 uv, inout float through, float cover, sampler2D cover_texture) {
    float covered = cover * texture(cover_texture, uv).r;
    through = clamp(through * smoothstep(0.0, 0.1, 1.0 - covered), 0.0, 1.0);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
vec4 sss_layer(vec2 uv, vec2 speed, float time, sampler2D packed_texture) {
    return texture(packed_texture, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void sss_packed_scroll(vec2 uv, float time, inout vec3 emission, sampler2D packed_texture, vec2 red_speed,
    vec2 green_speed, vec2 blue_speed, vec3 vein_color, vec3 spark_color) {
    float veins = sss_layer(uv, red_speed, time, packed_texture).x
        * sss_layer(uv, green_speed, time, packed_texture).y;
    float sparks = sss_layer(uv, blue_speed, time, packed_texture).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0);
}

// The part of the surface that remains at \`uv\`: 1 = all, 0 = none.
float sss_left_at(vec2 uv, float edge, float erosion, sampler2D erosion_texture) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = mix(-edge, 1.0, erosion);
    return clamp((texture(erosion_texture, uv).r - threshold) / edge, 0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void sss_alpha_erosion(vec2 uv, inout float alpha, inout vec3 normal, vec2 uv_per_unit, float texel_size,
    float edge, float erosion, sampler2D erosion_texture, float edge_height) {
    vec2 e = vec2(texel_size, 0.0);
    float across = sss_left_at(uv + e, edge, erosion, erosion_texture)
        - sss_left_at(uv - e, edge, erosion, erosion_texture);
    float up = sss_left_at(uv + e.yx, edge, erosion, erosion_texture)
        - sss_left_at(uv - e.yx, edge, erosion, erosion_texture);
    vec2 slope = edge_height * uv_per_unit * vec2(across, up) / (2.0 * texel_size);
    normal = sss_blend_normals(normal, sss_normal_of_slope(slope));
    alpha *= sss_left_at(uv, edge, erosion, erosion_texture);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
vec3 sss_glow(float lobe, float through, vec3 subsurface_color, float attenuation, float scale,
    float ambient) {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
vec3 sss_lobe_normalized(vec3 V, vec3 N, vec3 L, float through, float distortion, vec3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    vec3 bent = sss_safe_normalize(L + N * distortion);
    return sss_glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation,
        scale, ambient);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
vec3 sss_lobe_surroundings(float mean_lobe, float through, vec3 irradiance_behind, vec3 subsurface_color,
    float attenuation, float scale, float ambient) {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * sss_glow(mean_lobe, through, subsurface_color, attenuation, scale, ambient)
        * irradiance_behind;
}

// The light of the surroundings that comes through.
vec3 sss_lobe_normalized_surroundings(float through, vec3 irradiance_behind, vec3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    return sss_lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind, subsurface_color,
        attenuation, scale, ambient);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
vec3 sss_standard(vec3 N, vec3 V, vec3 L, vec3 albedo, float metallic, float roughness, vec3 light_color) {
    vec3 H = sss_safe_normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 0.0001);
    float NoH = clamp(dot(N, H), 0.0, 1.0);
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but accurate at the peak, where N and H nearly coincide; never below a^2
    vec3 across = cross(N, H);
    float spread = NoH > 0.0 ? max(dot(across, across) + NoH * NoH * (a * a), a * a) : 1.0;
    // D times pi
    float facets = a * a / (spread * spread);
    // masking and shadowing, divided by 4 dot(N, L) dot(N, V)
    float visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // a surface reflects at most all light
    vec3 F0 = mix(vec3(0.04), min(albedo, 1.0), metallic);
    // what reflects less than 2 % from the front is no mirror from the side
    float F90 = min(max(dot(F0, vec3(17.0)), metallic), 1.0);
    vec3 F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    vec3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    vec3 reflected = (diffuse + facets * visible * F) * NoL;
    return reflected * light_color;
}

// The values of the surface that do not depend on a light.
sss_Surface sss_evaluate_surface(vec2 uv, float time, vec3 irradiance_behind, float variation,
    float cell_count, float thickness_factor, float bevel, float attenuation_distance, vec4 tint,
    sampler2D base_color_texture, float metalness, float surface_roughness, float relief, vec2 uv_per_unit,
    float cover, sampler2D cover_texture, sampler2D packed_texture, vec2 red_speed, vec2 green_speed,
    vec2 blue_speed, vec3 vein_color, vec3 spark_color, float texel_size, float edge, float erosion,
    sampler2D erosion_texture, float edge_height, vec3 subsurface_color, float attenuation, float scale,
    float ambient, float power) {
    float thickness = sss_voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel);
    float transmittance = sss_beer_lambert(thickness, attenuation_distance);
    vec3 albedo;
    float alpha;
    sss_base_color(uv, albedo, alpha, tint, base_color_texture);
    float metallic;
    float roughness;
    sss_pbr_constants(metallic, roughness, metalness, surface_roughness);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    sss_voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit);
    sss_ice_mask(uv, transmittance, cover, cover_texture);
    vec3 emission = vec3(0.0);
    sss_packed_scroll(uv, time, emission, packed_texture, red_speed, green_speed, blue_speed, vein_color,
        spark_color);
    sss_alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        edge_height);
    emission += sss_lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color,
        attenuation, scale, ambient, power);
    return sss_Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
}

// The transmitted light of one light, as a factor on its colour.
vec3 sss_evaluate_translucency(sss_Surface surface, vec3 V, vec3 N, vec3 L, float distortion,
    vec3 subsurface_color, float attenuation, float scale, float ambient, float power) {
    return sss_lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation,
        scale, ambient, power);
}

// The reflected light of one light.
vec3 sss_evaluate_lighting(sss_Surface surface, vec3 N, vec3 V, vec3 L, vec3 light_color) {
    return sss_standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
`;

/** WGSL. A texture is followed by its sampler. */
export const wgsl = /* wgsl */ `
struct sss_Cell {
    nearest: vec2f,
    second: vec2f,
    level: f32,
}

struct sss_Surface {
    albedo: vec3f,
    alpha: f32,
    normal: vec3f,
    metallic: f32,
    roughness: f32,
    emission: vec3f,
    transmittance: f32,
}

const sss_JITTER: f32 = 0.6;
const sss_OPAQUE_DISTANCE: f32 = 1.0e-6;
const sss_ENDLESS: f32 = 10000.0;
const sss_OPAQUE_DEPTH: f32 = 80.0;

// The direction of \`x\`; of a zero vector, 0.
fn sss_safe_normalize_vec2(x: vec2f) -> vec2f {
    return x * select(0.0, inverseSqrt(dot(x, x)), dot(x, x) > 1.0e-30);
}

// The direction of \`x\`; of a zero vector, 0.
fn sss_safe_normalize_vec3(x: vec3f) -> vec3f {
    return x * select(0.0, inverseSqrt(dot(x, x)), dot(x, x) > 1.0e-30);
}

// Scrambles the bits of \`x\`; 0 stays 0.
fn sss_hash_bits(x_in: u32) -> u32 {
    var x = x_in;
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of \`x\`.
fn sss_hash_unit(x: u32) -> f32 {
    return f32(sss_hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at \`p\`.
fn sss_cell_at(p: vec2f, variation: f32) -> sss_Cell {
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
            let seed = sss_hash_bits(u32(i32(corner.x)) + sss_hash_bits(u32(i32(corner.y)) + 1u));
            let shift = vec2f(sss_hash_unit(seed + 1u), sss_hash_unit(seed + 2u)) - 0.5;
            let to_site = offset + 0.5 + sss_JITTER * shift - within;
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
    let level = 1.0 - variation * sss_hash_unit(owner + 3u);
    return sss_Cell(nearest, second, level);
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
fn sss_to_edge(cell: sss_Cell) -> f32 {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
fn sss_voronoi_thickness(uv: vec2f, variation: f32, cell_count: f32, thickness_factor: f32,
    bevel: f32) -> f32 {
    let cell = sss_cell_at(uv * cell_count, variation);
    return thickness_factor * cell.level * smoothstep(0.0, bevel, sss_to_edge(cell));
}

// The thickness \`d\` in mean free paths, 0 or more.
fn sss_optical_depth(d: f32, mean_free_path: f32) -> f32 {
    let path = max(mean_free_path, sss_OPAQUE_DISTANCE);
    return clamp(d, 0.0, sss_ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
fn sss_beer_lambert(d: f32, attenuation_distance: f32) -> f32 {
    return exp(-min(sss_optical_depth(d, attenuation_distance), sss_OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
fn sss_base_color(uv: vec2f, albedo: ptr<function, vec3f>, alpha: ptr<function, f32>, tint: vec4f,
    base_color_texture: texture_2d<f32>, base_color_texture_sampler: sampler) {
    let texel = tint * textureSample(base_color_texture, base_color_texture_sampler, uv);
    *albedo = texel.xyz;
    *alpha = texel.w;
}

// The same metalness and roughness everywhere.
fn sss_pbr_constants(metallic: ptr<function, f32>, roughness: ptr<function, f32>, metalness: f32,
    surface_roughness: f32) {
    *metallic = metalness;
    *roughness = surface_roughness;
}

// The gradient of to_edge.
fn sss_from_edge(cell: sss_Cell) -> vec2f {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return sss_safe_normalize_vec2(cell.nearest) - normalize(cell.second);
}

// Adds \`detail\` to \`base\`: x and y are added, z is multiplied; for small slopes this adds the slopes.
fn sss_blend_normals(base: vec3f, detail: vec3f) -> vec3f {
    return sss_safe_normalize_vec3(vec3f(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; \`slope\` is the increase in height per unit of length along T and B.
fn sss_normal_of_slope(slope: vec2f) -> vec3f {
    return normalize(vec3f(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
fn sss_voronoi_normal(uv: vec2f, normal: ptr<function, vec3f>, variation: f32, cell_count: f32, bevel: f32,
    relief: f32, uv_per_unit: vec2f) {
    let cell = sss_cell_at(uv * cell_count, variation);
    let x = clamp(sss_to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    let steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    let slope = relief * uv_per_unit * cell_count * steepness * sss_from_edge(cell);
    *normal = sss_blend_normals(*normal, sss_normal_of_slope(slope));
}

// Only the bare ice transmits light.
fn sss_ice_mask(uv: vec2f, through: ptr<function, f32>, cover: f32, cover_texture: texture_2d<f32>,
    cover_texture_sampler: sampler) {
    let covered = cover * textureSample(cover_texture, cover_texture_sampler, uv).r;
    *through = clamp(*through * smoothstep(0.0, 0.1, 1.0 - covered), 0.0, 1.0);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
fn sss_layer(uv: vec2f, speed: vec2f, time: f32, packed_texture: texture_2d<f32>,
    packed_texture_sampler: sampler) -> vec4f {
    return textureSample(packed_texture, packed_texture_sampler, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
fn sss_packed_scroll(uv: vec2f, time: f32, emission: ptr<function, vec3f>, packed_texture: texture_2d<f32>,
    packed_texture_sampler: sampler, red_speed: vec2f, green_speed: vec2f, blue_speed: vec2f,
    vein_color: vec3f, spark_color: vec3f) {
    let veins = sss_layer(uv, red_speed, time, packed_texture, packed_texture_sampler).x
        * sss_layer(uv, green_speed, time, packed_texture, packed_texture_sampler).y;
    let sparks = sss_layer(uv, blue_speed, time, packed_texture, packed_texture_sampler).z;
    *emission = min(*emission + (vein_color * veins + spark_color * sparks), vec3f(65504.0));
}

// The part of the surface that remains at \`uv\`: 1 = all, 0 = none.
fn sss_left_at(uv: vec2f, edge: f32, erosion: f32, erosion_texture: texture_2d<f32>,
    erosion_texture_sampler: sampler) -> f32 {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    let threshold = mix(-edge, 1.0, erosion);
    return clamp((textureSample(erosion_texture, erosion_texture_sampler, uv).r - threshold) / edge, 0.0,
        1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
fn sss_alpha_erosion(uv: vec2f, alpha: ptr<function, f32>, normal: ptr<function, vec3f>, uv_per_unit: vec2f,
    texel_size: f32, edge: f32, erosion: f32, erosion_texture: texture_2d<f32>,
    erosion_texture_sampler: sampler, edge_height: f32) {
    let e = vec2f(texel_size, 0.0);
    let across = sss_left_at(uv + e, edge, erosion, erosion_texture, erosion_texture_sampler)
        - sss_left_at(uv - e, edge, erosion, erosion_texture, erosion_texture_sampler);
    let up = sss_left_at(uv + e.yx, edge, erosion, erosion_texture, erosion_texture_sampler)
        - sss_left_at(uv - e.yx, edge, erosion, erosion_texture, erosion_texture_sampler);
    let slope = edge_height * uv_per_unit * vec2f(across, up) / (2.0 * texel_size);
    *normal = sss_blend_normals(*normal, sss_normal_of_slope(slope));
    *alpha *= sss_left_at(uv, edge, erosion, erosion_texture, erosion_texture_sampler);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
fn sss_glow(lobe: f32, through: f32, subsurface_color: vec3f, attenuation: f32, scale: f32,
    ambient: f32) -> vec3f {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
fn sss_lobe_normalized(V: vec3f, N: vec3f, L: vec3f, through: f32, distortion: f32, subsurface_color: vec3f,
    attenuation: f32, scale: f32, ambient: f32, power: f32) -> vec3f {
    let bent = sss_safe_normalize_vec3(L + N * distortion);
    return sss_glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation,
        scale, ambient);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
fn sss_lobe_surroundings(mean_lobe: f32, through: f32, irradiance_behind: vec3f, subsurface_color: vec3f,
    attenuation: f32, scale: f32, ambient: f32) -> vec3f {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * sss_glow(mean_lobe, through, subsurface_color, attenuation, scale, ambient)
        * irradiance_behind;
}

// The light of the surroundings that comes through.
fn sss_lobe_normalized_surroundings(through: f32, irradiance_behind: vec3f, subsurface_color: vec3f,
    attenuation: f32, scale: f32, ambient: f32, power: f32) -> vec3f {
    return sss_lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind, subsurface_color,
        attenuation, scale, ambient);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
fn sss_standard(N: vec3f, V: vec3f, L: vec3f, albedo: vec3f, metallic: f32, roughness: f32,
    light_color: vec3f) -> vec3f {
    let H = sss_safe_normalize_vec3(V + L);
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
fn sss_evaluate_surface(uv: vec2f, time: f32, irradiance_behind: vec3f, variation: f32, cell_count: f32,
    thickness_factor: f32, bevel: f32, attenuation_distance: f32, tint: vec4f,
    base_color_texture: texture_2d<f32>, base_color_texture_sampler: sampler, metalness: f32,
    surface_roughness: f32, relief: f32, uv_per_unit: vec2f, cover: f32, cover_texture: texture_2d<f32>,
    cover_texture_sampler: sampler, packed_texture: texture_2d<f32>, packed_texture_sampler: sampler,
    red_speed: vec2f, green_speed: vec2f, blue_speed: vec2f, vein_color: vec3f, spark_color: vec3f,
    texel_size: f32, edge: f32, erosion: f32, erosion_texture: texture_2d<f32>,
    erosion_texture_sampler: sampler, edge_height: f32, subsurface_color: vec3f, attenuation: f32,
    scale: f32, ambient: f32, power: f32) -> sss_Surface {
    let thickness = sss_voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel);
    var transmittance = sss_beer_lambert(thickness, attenuation_distance);
    var albedo: vec3f;
    var alpha: f32;
    sss_base_color(uv, &albedo, &alpha, tint, base_color_texture, base_color_texture_sampler);
    var metallic: f32;
    var roughness: f32;
    sss_pbr_constants(&metallic, &roughness, metalness, surface_roughness);
    var normal = vec3f(0.0, 0.0, 1.0);
    sss_voronoi_normal(uv, &normal, variation, cell_count, bevel, relief, uv_per_unit);
    sss_ice_mask(uv, &transmittance, cover, cover_texture, cover_texture_sampler);
    var emission = vec3f(0.0);
    sss_packed_scroll(uv, time, &emission, packed_texture, packed_texture_sampler, red_speed, green_speed,
        blue_speed, vein_color, spark_color);
    sss_alpha_erosion(uv, &alpha, &normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        erosion_texture_sampler, edge_height);
    emission += sss_lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color,
        attenuation, scale, ambient, power);
    return sss_Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
}

// The transmitted light of one light, as a factor on its colour.
fn sss_evaluate_translucency(surface: sss_Surface, V: vec3f, N: vec3f, L: vec3f, distortion: f32,
    subsurface_color: vec3f, attenuation: f32, scale: f32, ambient: f32, power: f32) -> vec3f {
    return sss_lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation,
        scale, ambient, power);
}

// The reflected light of one light.
fn sss_evaluate_lighting(surface: sss_Surface, N: vec3f, V: vec3f, L: vec3f, light_color: vec3f) -> vec3f {
    return sss_standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
`;

/** What to call: each function's result, and its parameters in order. */
export const entries = {
  surface: {
    name: "sss_evaluate_surface",
    result: "sss_Surface",
    parameters: [
      { name: "uv", type: "vec2", input: "uv" },
      { name: "time", type: "float", input: "time" },
      { name: "irradiance_behind", type: "vec3", input: "irradiance_behind" },
      { name: "variation", type: "float", uniform: "sss_variation" },
      { name: "cell_count", type: "float", uniform: "sss_cell_count" },
      { name: "thickness_factor", type: "float", uniform: "sss_thickness_factor" },
      { name: "bevel", type: "float", uniform: "sss_bevel" },
      { name: "attenuation_distance", type: "float", uniform: "sss_attenuation_distance" },
      { name: "tint", type: "vec4", uniform: "sss_tint" },
      { name: "base_color_texture", type: "sampler2D", uniform: "sss_base_color_texture" },
      { name: "metalness", type: "float", uniform: "sss_metalness" },
      { name: "surface_roughness", type: "float", uniform: "sss_surface_roughness" },
      { name: "relief", type: "float", uniform: "sss_relief" },
      { name: "uv_per_unit", type: "vec2", uniform: "sss_uv_per_unit" },
      { name: "cover", type: "float", uniform: "sss_cover" },
      { name: "cover_texture", type: "sampler2D", uniform: "sss_cover_texture" },
      { name: "packed_texture", type: "sampler2D", uniform: "sss_packed_texture" },
      { name: "red_speed", type: "vec2", uniform: "sss_red_speed" },
      { name: "green_speed", type: "vec2", uniform: "sss_green_speed" },
      { name: "blue_speed", type: "vec2", uniform: "sss_blue_speed" },
      { name: "vein_color", type: "vec3", uniform: "sss_vein_color" },
      { name: "spark_color", type: "vec3", uniform: "sss_spark_color" },
      { name: "texel_size", type: "float", uniform: "sss_texel_size" },
      { name: "edge", type: "float", uniform: "sss_edge" },
      { name: "erosion", type: "float", uniform: "sss_erosion" },
      { name: "erosion_texture", type: "sampler2D", uniform: "sss_erosion_texture" },
      { name: "edge_height", type: "float", uniform: "sss_edge_height" },
      { name: "subsurface_color", type: "vec3", uniform: "sss_subsurface_color" },
      { name: "attenuation", type: "float", uniform: "sss_attenuation" },
      { name: "scale", type: "float", uniform: "sss_scale" },
      { name: "ambient", type: "float", uniform: "sss_ambient" },
      { name: "power", type: "float", uniform: "sss_power" },
    ],
  },
  translucency: {
    name: "sss_evaluate_translucency",
    result: "vec3",
    parameters: [
      { name: "surface", type: "sss_Surface", input: "surface" },
      { name: "V", type: "vec3", input: "V" },
      { name: "N", type: "vec3", input: "N" },
      { name: "L", type: "vec3", input: "L" },
      { name: "distortion", type: "float", uniform: "sss_distortion" },
      { name: "subsurface_color", type: "vec3", uniform: "sss_subsurface_color" },
      { name: "attenuation", type: "float", uniform: "sss_attenuation" },
      { name: "scale", type: "float", uniform: "sss_scale" },
      { name: "ambient", type: "float", uniform: "sss_ambient" },
      { name: "power", type: "float", uniform: "sss_power" },
    ],
  },
  lighting: {
    name: "sss_evaluate_lighting",
    result: "vec3",
    parameters: [
      { name: "surface", type: "sss_Surface", input: "surface" },
      { name: "N", type: "vec3", input: "N" },
      { name: "V", type: "vec3", input: "V" },
      { name: "L", type: "vec3", input: "L" },
      { name: "light_color", type: "vec3", input: "light_color" },
    ],
  },
};
