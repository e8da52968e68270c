// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for PlayCanvas. Change the material and emit it again rather than this file.
//
//   import { createMaterial } from './ice.mjs';
//   entity.render.material = createMaterial(app.graphicsDevice, { variation: 0.6 });
//
// A StandardMaterial for WebGL 2 and WebGPU.
// Lights, shadows, fog and the environment are PlayCanvas's.

import { materialClass } from './sssgen-playcanvas.mjs';

/** The parameters: type, default, range, unit, and the name in the shaders. */
export const parameters = {
  /** How much the levels of the cells differ: 0 = all are equal. */
  variation: { type: 'float', default: 0.6, range: [0.0, 1.0], unit: '1', name: 'sss_variation' },
  /** Number of cells along one unit of texture coordinate. */
  cellCount: { type: 'float', default: 10.0, range: [1.0, 200.0], unit: '1', name: 'sss_cell_count' },
  /** Thickness of a cell of level 1. */
  thicknessFactor: { type: 'float', default: 0.3, range: [0.0, 10.0], unit: 'm', name: 'sss_thickness_factor' },
  /** Width of the slope next to an edge, in cells. */
  bevel: { type: 'float', default: 0.35, range: [0.05, 1.0], unit: '1', name: 'sss_bevel' },
  /** The length after which 1/e (37 %) of the light remains; 0 = opaque. */
  sssAttenuationDistance: { type: 'float', default: 0.25, range: [0.0, 10.0], unit: 'm', name: 'sss_attenuation_distance' },
  /** Multiplies the texture. */
  tint: { type: 'vec4', default: [0.75, 0.9, 1.0, 1.0], name: 'sss_tint' },
  /** 0 = not a metal, 1 = metal. */
  sssMetalness: { type: 'float', default: 0.0, range: [0.0, 1.0], unit: '1', name: 'sss_metalness' },
  /** 0 = smooth as a mirror, 1 = rough as chalk. */
  surfaceRoughness: { type: 'float', default: 0.12, range: [0.0, 1.0], unit: '1', name: 'sss_surface_roughness' },
  /** Height of the thickest cells above their edges. */
  relief: { type: 'float', default: 0.01, range: [0.0, 1.0], unit: 'm', name: 'sss_relief' },
  /** Change of the texture coordinates per world unit along T and along B. */
  uvPerUnit: { type: 'vec2', default: [1.0, 1.0], unit: '1/m', name: 'sss_uv_per_unit' },
  /** Multiplies the texture. */
  cover: { type: 'float', default: 1.0, range: [0.0, 1.0], unit: '1', name: 'sss_cover' },
  /** Velocity of the red layer. */
  redSpeed: { type: 'vec2', default: [0.02, 0.0], unit: '1/s', name: 'sss_red_speed' },
  /** Velocity of the green layer. */
  greenSpeed: { type: 'vec2', default: [-0.01, 0.015], unit: '1/s', name: 'sss_green_speed' },
  /** Velocity of the blue layer. */
  blueSpeed: { type: 'vec2', default: [0.0, -0.025], unit: '1/s', name: 'sss_blue_speed' },
  /** Colour of the light in the red and green layers, where both are bright. */
  veinColor: { type: 'vec3', default: [0.3, 0.8, 1.0], color: true, name: 'sss_vein_color' },
  /** Colour of the light in the blue layer. */
  sparkColor: { type: 'vec3', default: [0.6, 0.9, 1.0], color: true, name: 'sss_spark_color' },
  /** The length, in texture coordinates, over which slopes are measured: about one texel. */
  texelSize: { type: 'float', default: 0.002, range: [0.0001, 0.1], unit: '1', name: 'sss_texel_size' },
  /** Width of the soft edge, in the texture's values. */
  edge: { type: 'float', default: 0.15, range: [0.01, 1.0], unit: '1', name: 'sss_edge' },
  /** How much is eroded: 0 = nothing, 1 = everything. */
  erosion: { type: 'float', default: 0.2, range: [0.0, 1.0], unit: '1', name: 'sss_erosion' },
  /** Height of the step in the surface at the edge. */
  edgeHeight: { type: 'float', default: 0.02, range: [0.0, 1.0], unit: 'm', name: 'sss_edge_height' },
  /** How far the normal bends the light's direction inside the body: 0 ignores the shape. */
  distortion: { type: 'float', default: 0.2, range: [0.0, 1.0], unit: '1', name: 'sss_distortion' },
  /** Colour of the transmitted light. */
  subsurfaceColor: { type: 'vec3', default: [0.55, 0.85, 1.0], color: true, name: 'sss_subsurface_color' },
  /** Factor on the whole result. */
  sssAttenuation: { type: 'float', default: 0.8, range: [0.0, 1.0], unit: '1', name: 'sss_attenuation' },
  /** Strength of the glow towards the light. */
  scale: { type: 'float', default: 2.0, range: [0.0, 20.0], unit: '1', name: 'sss_scale' },
  /** Glow that does not depend on the direction. */
  sssAmbient: { type: 'float', default: 0.12, range: [0.0, 1.0], unit: '1', name: 'sss_ambient' },
  /** How narrow the glow around the light is: the larger, the smaller the spot. */
  power: { type: 'float', default: 6.0, range: [1.0, 32.0], unit: '1', name: 'sss_power' },
};

/** The textures: type, the one texel of the default, whether it has colours in sRGB, and the name in the shaders. */
export const textures = {
  /** Colour of the surface (an sRGB texture), with its opacity in alpha. */
  baseColorTexture: { type: 'sampler2D', default: 'white', colorSpace: 'srgb', name: 'sss_base_color_texture' },
  /** Cover on the ice (snow, rock): black = bare ice, white = covered. */
  coverTexture: { type: 'sampler2D', default: 'black', colorSpace: 'linear', name: 'sss_cover_texture' },
  /** Three pictures in one texture: red, green and blue each hold a layer. */
  packedTexture: { type: 'sampler2D', default: 'black', colorSpace: 'linear', name: 'sss_packed_texture' },
  /** Mask of the erosion: dark parts disappear first. */
  erosionTexture: { type: 'sampler2D', default: 'white', colorSpace: 'linear', name: 'sss_erosion_texture' },
};

const GLSL = /* glsl */ `
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

// The unit direction from P towards a light, and as w 1 / the distance, 0 for a light from afar. \`place\` is
// where the light is, with w = 1, or the direction towards it, with w = 0.
vec4 sss_towards_light(vec4 place, vec3 P) {
    vec3 way = place.xyz - P * place.w;
    return vec4(way, place.w) * inversesqrt(max(dot(way, way), 0.0001));
}

// The unit direction to one of four points that stand for an area of light, and as w 1 / the distance. The
// columns of \`area\` are the way to its centre, and halves of its sides.
vec4 sss_towards_area(int index, float spread, mat3 area) {
    float across = index - index / 2 * 2 == 0 ? -spread : spread;
    float up = index < 2 ? -spread : spread;
    return sss_towards_light(vec4(area * vec3(1.0, across, up), 1.0), vec3(0.0));
}

// The irradiance of a surface that faces a quarter of a rectangle of light with the radiance 1; negative
// behind the light.
float sss_area_light(mat3 area, vec4 way) {
    vec3 quarter = cross(area[1], area[2]);
    return dot(quarter, way.xyz) * min(way.w * way.w, 6.2831855 / max(length(quarter), 1.0e-6));
}

// The direction of \`x\`; of a zero vector, 0.
vec3 sss_safe_normalize(vec3 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// The tangent, the bitangent and the normal as columns. \`tangent\` is that of the mesh, with the handedness as
// w; where it is 0, both come from the derivatives of \`uv\`, and the longer one has the length 1.
mat3 sss_tangent_frame(vec3 P, vec3 V, vec3 N, float side, vec2 uv, vec4 tangent) {
    vec3 across = dFdx(P);
    vec3 up = dFdy(P);
    vec2 uv_across = dFdx(uv);
    vec2 uv_up = dFdy(uv);
    // the rows of some render targets count downwards
    float upwards = dot(cross(across, up), V) < 0.0 ? -1.0 : 1.0;
    vec3 first = cross(up, N) * upwards;
    vec3 second = cross(N, across) * upwards;
    vec3 T = first * uv_across.x + second * uv_up.x;
    vec3 B = first * uv_across.y + second * uv_up.y;
    float scale = inversesqrt(max(max(dot(T, T), dot(B, B)), 1.0e-30));
    T *= scale;
    B *= scale;
    if (dot(tangent.xyz, tangent.xyz) > 0.0) {
        T = sss_safe_normalize(tangent.xyz);
        B = cross(N * side, T) * tangent.w;
    }
    return mat3(T, B, N);
}

// How far light travelled inside a box that contains the body: from where it entered the box to a point \`at\`
// of the body, in lengths of \`towards\`, which points to the light.
float sss_way_out_of_box(vec3 at, vec3 towards, vec3 box_min, vec3 box_max) {
    // a component of 0 never leaves the box
    vec3 slopes = max(abs(towards), vec3(1.0e-12));
    vec3 side = mix(at - box_min, box_max - at, greaterThan(towards, vec3(0.0)));
    vec3 ways = max(side, 0.0) / slopes;
    return min(min(ways.x, ways.y), ways.z);
}

// Where the light that reaches \`P\` entered a box around the body, in world space: there an engine's shadow
// map says what lies between the light and the body.
vec3 sss_light_entry(vec3 P, vec3 L, float nearness, vec3 P_object, mat3 to_object, vec3 box_min,
    vec3 box_max) {
    // A shadow is read over some texels. While these are within the margin, none of them has a part of the
    // body before this place, also where light grazes a side of the box.
    float margin = 0.02 * distance(box_min, box_max);
    float way = sss_way_out_of_box(P_object, L * to_object, box_min - margin, box_max + margin);
    // to world space: a matrix of cofactors is the inverse times a determinant, whose square it has
    way *= sqrt(abs(determinant(to_object)));
    // before the light, where no shadow map begins
    return P + L * min(way, nearness > 0.0 ? 0.99 / max(nearness, 1.0e-20) : way);
}

// The direction of \`x\`; of a zero vector, 0.
vec2 sss_safe_normalize(vec2 x) {
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
    through = through * smoothstep(0.0, 0.1, 1.0 - covered);
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

const WGSL = /* wgsl */ `
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

// The unit direction from P towards a light, and as w 1 / the distance, 0 for a light from afar. \`place\` is
// where the light is, with w = 1, or the direction towards it, with w = 0.
fn sss_towards_light(place: vec4f, P: vec3f) -> vec4f {
    let way = place.xyz - P * place.w;
    return vec4f(way, place.w) * inverseSqrt(max(dot(way, way), 0.0001));
}

// The unit direction to one of four points that stand for an area of light, and as w 1 / the distance. The
// columns of \`area\` are the way to its centre, and halves of its sides.
fn sss_towards_area(index: i32, spread: f32, area: mat3x3f) -> vec4f {
    let across = select(spread, -spread, index % 2 == 0);
    let up = select(spread, -spread, index < 2);
    return sss_towards_light(vec4f(area * vec3f(1.0, across, up), 1.0), vec3f(0.0));
}

// The irradiance of a surface that faces a quarter of a rectangle of light with the radiance 1; negative
// behind the light.
fn sss_area_light(area: mat3x3f, way: vec4f) -> f32 {
    let quarter = cross(area[1], area[2]);
    return dot(quarter, way.xyz) * min(way.w * way.w, 6.2831855 / max(length(quarter), 1.0e-6));
}

// The direction of \`x\`; of a zero vector, 0.
fn sss_safe_normalize_vec3(x: vec3f) -> vec3f {
    return x * select(0.0, inverseSqrt(dot(x, x)), dot(x, x) > 1.0e-30);
}

// The tangent, the bitangent and the normal as columns. \`tangent\` is that of the mesh, with the handedness as
// w; where it is 0, both come from the derivatives of \`uv\`, and the longer one has the length 1.
fn sss_tangent_frame(P: vec3f, V: vec3f, N: vec3f, side: f32, uv: vec2f, tangent: vec4f) -> mat3x3f {
    let across = dpdx(P);
    let up = dpdy(P);
    let uv_across = dpdx(uv);
    let uv_up = dpdy(uv);
    // the rows of some render targets count downwards
    let upwards = select(1.0, -1.0, dot(cross(across, up), V) < 0.0);
    let first = cross(up, N) * upwards;
    let second = cross(N, across) * upwards;
    var T = first * uv_across.x + second * uv_up.x;
    var B = first * uv_across.y + second * uv_up.y;
    let scale = inverseSqrt(max(max(dot(T, T), dot(B, B)), 1.0e-30));
    T *= scale;
    B *= scale;
    if (dot(tangent.xyz, tangent.xyz) > 0.0) {
        T = sss_safe_normalize_vec3(tangent.xyz);
        B = cross(N * side, T) * tangent.w;
    }
    return mat3x3f(T, B, N);
}

// How far light travelled inside a box that contains the body: from where it entered the box to a point \`at\`
// of the body, in lengths of \`towards\`, which points to the light.
fn sss_way_out_of_box(at: vec3f, towards: vec3f, box_min: vec3f, box_max: vec3f) -> f32 {
    // a component of 0 never leaves the box
    let slopes = max(abs(towards), vec3f(1.0e-12));
    let side = select(at - box_min, box_max - at, towards > vec3f(0.0));
    let ways = max(side, vec3f(0.0)) / slopes;
    return min(min(ways.x, ways.y), ways.z);
}

// Where the light that reaches \`P\` entered a box around the body, in world space: there an engine's shadow
// map says what lies between the light and the body.
fn sss_light_entry(P: vec3f, L: vec3f, nearness: f32, P_object: vec3f, to_object: mat3x3f, box_min: vec3f,
    box_max: vec3f) -> vec3f {
    // A shadow is read over some texels. While these are within the margin, none of them has a part of the
    // body before this place, also where light grazes a side of the box.
    let margin = 0.02 * distance(box_min, box_max);
    var way = sss_way_out_of_box(P_object, L * to_object, box_min - margin, box_max + margin);
    // to world space: a matrix of cofactors is the inverse times a determinant, whose square it has
    way *= sqrt(abs(determinant(to_object)));
    // before the light, where no shadow map begins
    return P + L * min(way, select(way, 0.99 / max(nearness, 1.0e-20), nearness > 0.0));
}

// The direction of \`x\`; of a zero vector, 0.
fn sss_safe_normalize_vec2(x: vec2f) -> vec2f {
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
    *through = *through * smoothstep(0.0, 0.1, 1.0 - covered);
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

/** What goes into PlayCanvas's shaders: in GLSL, and in WGSL. */
const SHELLS = [{
  functions: GLSL,
  vertex: `
sss_P_object = vertex_position.xyz;
sss_row_x = cross(dModelMatrix[1].xyz, dModelMatrix[2].xyz);
sss_row_y = cross(dModelMatrix[2].xyz, dModelMatrix[0].xyz);
sss_row_z = cross(dModelMatrix[0].xyz, dModelMatrix[1].xyz);
if (dot(dModelMatrix[0].xyz, sss_row_x) < 0.0) { sss_row_x *= -1.0; sss_row_y *= -1.0; sss_row_z *= -1.0; }
sss_tangent = vec4((dModelMatrix * vec4(sss_tangent.xyz, 0.0)).xyz, sss_tangent.w);
sss_tangent.w *= sign(dot(dModelMatrix[0].xyz, cross(dModelMatrix[1].xyz, dModelMatrix[2].xyz)));
`,
  begin: `
sss_side = 1.0;
#if defined(FORWARD_PASS) && defined(LIT_TWO_SIDED_LIGHTING)
sss_side = gl_FrontFacing ? 1.0 : -1.0;
#endif
#ifdef FORWARD_PASS
sss_N = dVertexNormalW;
#else
sss_N = sss_safe_normalize(cross(dFdx(vPositionW), dFdy(vPositionW)));
#endif
#ifdef FORWARD_PASS
sss_V = dViewDirW;
sss_eye_position = view_position;
#else
sss_V = sss_N;
sss_eye_position = vPositionW + sss_V;
#endif
sss_frame = sss_tangent_frame(vPositionW, sss_V, sss_N, sss_side, sss_uv, sss_tangent);
sss_to_object = mat3(sss_row_x, sss_row_y, sss_row_z);
sss_surface = sss_evaluate_surface(sss_uv, sss_time, sss_surroundings(-sss_N), sss_variation,
            sss_cell_count, sss_thickness_factor, sss_bevel, sss_attenuation_distance,
            sss_tint, sss_base_color_texture, sss_metalness, sss_surface_roughness,
            sss_relief, sss_uv_per_unit, sss_cover, sss_cover_texture, sss_packed_texture,
            sss_red_speed, sss_green_speed, sss_blue_speed, sss_vein_color, sss_spark_color,
            sss_texel_size, sss_edge, sss_erosion, sss_erosion_texture, sss_edge_height,
            sss_subsurface_color, sss_attenuation, sss_scale, sss_ambient, sss_power);
`,
  translucency: `sss_evaluate_translucency(sss_surface, sss_V, litArgs_worldNormal, sss_L,
            sss_distortion, sss_subsurface_color, sss_attenuation, sss_scale, sss_ambient,
            sss_power)`,
  lighting: `sss_evaluate_lighting(sss_surface, litArgs_worldNormal, sss_V, sss_L, sss_light_color)`,
  entry: `
sss_entry = sss_light_entry(vPositionW, sss_L, sss_light_nearness,
  sss_P_object, sss_to_object, sss_body_min, sss_body_max);
`,
  places: {
    front: `
litArgs_albedo *= sss_surface.albedo;
litArgs_worldNormal = sss_safe_normalize(sss_frame * vec3(sss_surface.normal.xy * sss_side, sss_surface.normal.z));
litArgs_metalness = sss_surface.metallic;
litArgs_gloss = 1.0 - sss_surface.roughness + 1e-7;
litArgs_emission += sss_surface.emission;
`,
    opacity: `
dAlpha *= sss_surface.alpha;
`,
    ambient: `
dDiffuseLight *= sss_surface.albedo;
`,
  },
}, {
  functions: WGSL,
  vertex: `
output.sss_P_object = vertex_position.xyz;
output.sss_row_x = cross(dModelMatrix[1].xyz, dModelMatrix[2].xyz);
output.sss_row_y = cross(dModelMatrix[2].xyz, dModelMatrix[0].xyz);
output.sss_row_z = cross(dModelMatrix[0].xyz, dModelMatrix[1].xyz);
if (dot(dModelMatrix[0].xyz, output.sss_row_x) < 0.0) { output.sss_row_x *= -1.0; output.sss_row_y *= -1.0; output.sss_row_z *= -1.0; }
output.sss_tangent = vec4f((dModelMatrix * vec4f(output.sss_tangent.xyz, 0.0)).xyz, output.sss_tangent.w);
output.sss_tangent.w *= sign(dot(dModelMatrix[0].xyz, cross(dModelMatrix[1].xyz, dModelMatrix[2].xyz)));
`,
  begin: `
sss_side = 1.0;
#if defined(FORWARD_PASS) && defined(LIT_TWO_SIDED_LIGHTING)
sss_side = select(-1.0, 1.0, pcFrontFacing);
#endif
#ifdef FORWARD_PASS
sss_N = dVertexNormalW;
#else
sss_N = sss_safe_normalize_vec3(cross(dpdx(vPositionW), -dpdy(vPositionW)));
#endif
#ifdef FORWARD_PASS
sss_V = dViewDirW;
sss_eye_position = uniform.view_position;
#else
sss_V = sss_N;
sss_eye_position = vPositionW + sss_V;
#endif
sss_frame = sss_tangent_frame(vPositionW, sss_V, sss_N, sss_side, sss_uv, sss_tangent);
sss_to_object = mat3x3f(sss_row_x, sss_row_y, sss_row_z);
sss_surface = sss_evaluate_surface(sss_uv, uniform.sss_time, sss_surroundings(-sss_N),
            uniform.sss_variation, uniform.sss_cell_count, uniform.sss_thickness_factor,
            uniform.sss_bevel, uniform.sss_attenuation_distance, uniform.sss_tint,
            sss_base_color_texture, sss_base_color_texture_sampler, uniform.sss_metalness,
            uniform.sss_surface_roughness, uniform.sss_relief, uniform.sss_uv_per_unit,
            uniform.sss_cover, sss_cover_texture, sss_cover_texture_sampler,
            sss_packed_texture, sss_packed_texture_sampler, uniform.sss_red_speed,
            uniform.sss_green_speed, uniform.sss_blue_speed, uniform.sss_vein_color,
            uniform.sss_spark_color, uniform.sss_texel_size, uniform.sss_edge,
            uniform.sss_erosion, sss_erosion_texture, sss_erosion_texture_sampler,
            uniform.sss_edge_height, uniform.sss_subsurface_color, uniform.sss_attenuation,
            uniform.sss_scale, uniform.sss_ambient, uniform.sss_power);
`,
  translucency: `sss_evaluate_translucency(sss_surface, sss_V, litArgs_worldNormal, sss_L,
            uniform.sss_distortion, uniform.sss_subsurface_color, uniform.sss_attenuation,
            uniform.sss_scale, uniform.sss_ambient, uniform.sss_power)`,
  lighting: `sss_evaluate_lighting(sss_surface, litArgs_worldNormal, sss_V, sss_L, sss_light_color)`,
  entry: `
sss_entry = sss_light_entry(vPositionW, sss_L, sss_light_nearness,
  sss_P_object, sss_to_object, uniform.sss_body_min, uniform.sss_body_max);
`,
  places: {
    front: `
litArgs_albedo *= sss_surface.albedo;
litArgs_worldNormal = sss_safe_normalize_vec3(sss_frame * vec3(sss_surface.normal.xy * sss_side, sss_surface.normal.z));
litArgs_metalness = sss_surface.metallic;
litArgs_gloss = 1.0 - sss_surface.roughness + 1e-7;
litArgs_emission += sss_surface.emission;
`,
    opacity: `
dAlpha *= sss_surface.alpha;
`,
    ambient: `
dDiffuseLight *= sss_surface.albedo;
`,
  },
}];

/** Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes that melt into it. */
export class IceMaterial extends materialClass({
  name: 'ice', version: 1, lit: true, alphaMode: 'mask',
  fields: ['albedo', 'alpha', 'normal', 'metallic', 'roughness', 'emission', 'transmittance'],
  area: { towards: 'sss_towards_area', light: 'sss_area_light' },
  inputs: ['irradiance_behind', 'L', 'light_color', 'N', 'time', 'uv', 'V'],
  varyings: {
    sss_uv: { type: 'vec2', attribute: 'vertex_texCoord0', semantic: 'TEXCOORD0', define: 'UV0', default: 0 },
    sss_tangent: { type: 'vec4', attribute: 'vertex_tangent', semantic: 'TANGENT', define: 'TANGENTS', default: 0 },
    sss_P_object: { type: 'vec3' },
    sss_row_x: { type: 'vec3' }, sss_row_y: { type: 'vec3' }, sss_row_z: { type: 'vec3' },
  },
  variables: {
    sss_surface: 'sss_Surface',
    sss_side: 'float',
    sss_N: 'vec3',
    sss_V: 'vec3',
    sss_eye_position: 'vec3',
    sss_frame: 'mat3',
    sss_to_object: 'mat3',
    sss_entry: 'vec3', sss_shadow_place: 'vec3',
  },
  parameters, textures, shells: SHELLS,
}) {}

/** The material. `values` are its parameters, its textures, and the properties of StandardMaterial. */
export function createMaterial(device, values = {}) {
  return new IceMaterial(device, values);
}
