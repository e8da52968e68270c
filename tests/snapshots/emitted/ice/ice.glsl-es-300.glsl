// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for GLSL ES 3.00 (WebGL 2, OpenGL ES 3.0). Change the material and emit it again rather than this file.
// Paste it below the #version and precision of your own shader.

precision highp sampler2D;

struct Cell {
    vec2 nearest;
    vec2 second;
    float level;
};

struct Surface {
    vec3 albedo;
    float alpha;
    vec3 normal;
    float metallic;
    float roughness;
    vec3 emission;
    float transmittance;
};

const float JITTER = 0.6;
const float OPAQUE_DISTANCE = 1.0e-6;
const float ENDLESS = 10000.0;
const float OPAQUE_DEPTH = 80.0;

// The direction of `x`; of a zero vector, 0.
vec2 safe_normalize(vec2 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// The direction of `x`; of a zero vector, 0.
vec3 safe_normalize(vec3 x) {
    return x * (dot(x, x) > 1.0e-30 ? inversesqrt(dot(x, x)) : 0.0);
}

// Scrambles the bits of `x`; 0 stays 0.
uint hash_bits(uint x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of `x`.
float hash_unit(uint x) {
    return float(hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at `p`.
Cell cell_at(vec2 p, float variation) {
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
            uint seed = hash_bits(uint(int(corner.x)) + hash_bits(uint(int(corner.y)) + 1u));
            vec2 shift = vec2(hash_unit(seed + 1u), hash_unit(seed + 2u)) - 0.5;
            vec2 to_site = offset + 0.5 + JITTER * shift - within;
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
    float level = 1.0 - variation * hash_unit(owner + 3u);
    return Cell(nearest, second, level);
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
float to_edge(Cell cell) {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
float voronoi_thickness(vec2 uv, float variation, float cell_count, float thickness_factor, float bevel) {
    Cell cell = cell_at(uv * cell_count, variation);
    return thickness_factor * cell.level * smoothstep(0.0, bevel, to_edge(cell));
}

// The thickness `d` in mean free paths, 0 or more.
float optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, OPAQUE_DISTANCE);
    return clamp(d, 0.0, ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
float beer_lambert(float d, float attenuation_distance) {
    return exp(-min(optical_depth(d, attenuation_distance), OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
void base_color(vec2 uv, out vec3 albedo, out float alpha, vec4 tint, sampler2D base_color_texture) {
    vec4 texel = tint * texture(base_color_texture, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The gradient of to_edge.
vec2 from_edge(Cell cell) {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize(cell.nearest) - normalize(cell.second);
}

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
vec3 blend_normals(vec3 base, vec3 detail) {
    return safe_normalize(vec3(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
vec3 normal_of_slope(vec2 slope) {
    return normalize(vec3(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
void voronoi_normal(vec2 uv, inout vec3 normal, float variation, float cell_count, float bevel, float relief,
    vec2 uv_per_unit) {
    Cell cell = cell_at(uv * cell_count, variation);
    float x = clamp(to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    vec2 slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell);
    normal = blend_normals(normal, normal_of_slope(slope));
}

// Only the bare ice transmits light.
void ice_mask(vec2 uv, inout float through, float cover, sampler2D cover_texture) {
    float covered = cover * texture(cover_texture, uv).r;
    through = clamp(through * smoothstep(0.0, 0.1, 1.0 - covered), 0.0, 1.0);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
vec4 layer(vec2 uv, vec2 speed, float time, sampler2D packed_texture) {
    return texture(packed_texture, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void packed_scroll(vec2 uv, float time, inout vec3 emission, sampler2D packed_texture, vec2 red_speed,
    vec2 green_speed, vec2 blue_speed, vec3 vein_color, vec3 spark_color) {
    float veins = layer(uv, red_speed, time, packed_texture).x
        * layer(uv, green_speed, time, packed_texture).y;
    float sparks = layer(uv, blue_speed, time, packed_texture).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0);
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
float left_at(vec2 uv, float edge, float erosion, sampler2D erosion_texture) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = mix(-edge, 1.0, erosion);
    return clamp((texture(erosion_texture, uv).r - threshold) / edge, 0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void alpha_erosion(vec2 uv, inout float alpha, inout vec3 normal, vec2 uv_per_unit, float texel_size,
    float edge, float erosion, sampler2D erosion_texture, float edge_height) {
    vec2 e = vec2(texel_size, 0.0);
    float across = left_at(uv + e, edge, erosion, erosion_texture)
        - left_at(uv - e, edge, erosion, erosion_texture);
    float up = left_at(uv + e.yx, edge, erosion, erosion_texture)
        - left_at(uv - e.yx, edge, erosion, erosion_texture);
    vec2 slope = edge_height * uv_per_unit * vec2(across, up) / (2.0 * texel_size);
    normal = blend_normals(normal, normal_of_slope(slope));
    alpha *= left_at(uv, edge, erosion, erosion_texture);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
vec3 glow(float lobe, float through, vec3 subsurface_color, float attenuation, float scale, float ambient) {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
vec3 lobe_normalized(vec3 V, vec3 N, vec3 L, float through, float distortion, vec3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    vec3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation, scale,
        ambient);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
vec3 lobe_surroundings(float mean_lobe, float through, vec3 irradiance_behind, vec3 subsurface_color,
    float attenuation, float scale, float ambient) {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through, subsurface_color, attenuation, scale, ambient) * irradiance_behind;
}

// The light of the surroundings that comes through.
vec3 lobe_normalized_surroundings(float through, vec3 irradiance_behind, vec3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    return lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind, subsurface_color, attenuation,
        scale, ambient);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
vec3 standard(vec3 N, vec3 V, vec3 L, vec3 albedo, float metallic, float roughness, vec3 light_color) {
    vec3 H = safe_normalize(V + L);
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
Surface evaluate_surface(vec2 uv, float time, vec3 irradiance_behind, float variation, float cell_count,
    float thickness_factor, float bevel, float attenuation_distance, vec4 tint, sampler2D base_color_texture,
    float metalness, float surface_roughness, float relief, vec2 uv_per_unit, float cover,
    sampler2D cover_texture, sampler2D packed_texture, vec2 red_speed, vec2 green_speed, vec2 blue_speed,
    vec3 vein_color, vec3 spark_color, float texel_size, float edge, float erosion,
    sampler2D erosion_texture, float edge_height, vec3 subsurface_color, float attenuation, float scale,
    float ambient, float power) {
    float thickness = voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel);
    float transmittance = beer_lambert(thickness, attenuation_distance);
    vec3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit);
    ice_mask(uv, transmittance, cover, cover_texture);
    vec3 emission = vec3(0.0);
    packed_scroll(uv, time, emission, packed_texture, red_speed, green_speed, blue_speed, vein_color,
        spark_color);
    alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture, edge_height);
    emission += lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color, attenuation,
        scale, ambient, power);
    return Surface(albedo, alpha, normal, metallic, roughness, emission, transmittance);
}

// The transmitted light of one light, as a factor on its colour.
vec3 evaluate_translucency(Surface surface, vec3 V, vec3 N, vec3 L, float distortion, vec3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation, scale,
        ambient, power);
}

// The reflected light of one light.
vec3 evaluate_lighting(Surface surface, vec3 N, vec3 V, vec3 L, vec3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}
