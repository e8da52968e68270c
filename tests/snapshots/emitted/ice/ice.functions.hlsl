// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the material and emit it again rather than this file.
#ifndef ICE_HLSL_INCLUDED
#define ICE_HLSL_INCLUDED

struct Cell {
    float2 nearest;
    float2 second;
    float level;
};

struct Surface {
    float3 albedo;
    float alpha;
    float3 normal;
    float metallic;
    float roughness;
    float3 emission;
    float transmittance;
};

static const float JITTER = 0.6;
static const float OPAQUE_DISTANCE = 1.0e-6;
static const float ENDLESS = 10000.0;
static const float OPAQUE_DEPTH = 80.0;

// The direction of `x`; of a zero vector, 0.
float2 safe_normalize(float2 x) {
    return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
}

// The direction of `x`; of a zero vector, 0.
float3 safe_normalize(float3 x) {
    return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
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
Cell cell_at(float2 p, float variation) {
    float2 nearest = (float2)4.0;
    float2 second = (float2)4.0;
    // their squared lengths
    float first_square = 32.0;
    float second_square = 32.0;
    uint owner = 0u;
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    float2 home = floor(p);
    float2 within = p - home;
    [unroll]
    for (int j = -1; j <= 1; j++) {
        [unroll]
        for (int i = -1; i <= 1; i++) {
            float2 offset = float2(float(i), float(j));
            float2 corner = home + offset;
            uint seed = hash_bits(uint(int(corner.x)) + hash_bits(uint(int(corner.y)) + 1u));
            float2 shift = float2(hash_unit(seed + 1u), hash_unit(seed + 2u)) - 0.5;
            float2 to_site = offset + 0.5 + JITTER * shift - within;
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
    Cell cell = { nearest, second, level };
    return cell;
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
float to_edge(Cell cell) {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
float voronoi_thickness(float2 uv, float variation, float cell_count, float thickness_factor, float bevel) {
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
void base_color(float2 uv, out float3 albedo, out float alpha, float4 tint, Texture2D base_color_texture,
    SamplerState base_color_texture_sampler) {
    float4 texel = tint * base_color_texture.Sample(base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The gradient of to_edge.
float2 from_edge(Cell cell) {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return safe_normalize(cell.nearest) - normalize(cell.second);
}

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
float3 blend_normals(float3 base, float3 detail) {
    return safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
float3 normal_of_slope(float2 slope) {
    return normalize(float3(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
void voronoi_normal(float2 uv, inout float3 normal, float variation, float cell_count, float bevel,
    float relief, float2 uv_per_unit) {
    Cell cell = cell_at(uv * cell_count, variation);
    float x = clamp(to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    float2 slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell);
    normal = blend_normals(normal, normal_of_slope(slope));
}

// Only the bare ice transmits light.
void ice_mask(float2 uv, inout float through, float cover, Texture2D cover_texture,
    SamplerState cover_texture_sampler) {
    float covered = cover * cover_texture.Sample(cover_texture_sampler, uv).r;
    through = clamp(through * smoothstep(0.0, 0.1, 1.0 - covered), 0.0, 1.0);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
float4 layer(float2 uv, float2 speed, float time, Texture2D packed_texture,
    SamplerState packed_texture_sampler) {
    return packed_texture.Sample(packed_texture_sampler, uv + frac(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void packed_scroll(float2 uv, float time, inout float3 emission, Texture2D packed_texture,
    SamplerState packed_texture_sampler, float2 red_speed, float2 green_speed, float2 blue_speed,
    float3 vein_color, float3 spark_color) {
    float veins = layer(uv, red_speed, time, packed_texture, packed_texture_sampler).x
        * layer(uv, green_speed, time, packed_texture, packed_texture_sampler).y;
    float sparks = layer(uv, blue_speed, time, packed_texture, packed_texture_sampler).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0);
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
float left_at(float2 uv, float edge, float erosion, Texture2D erosion_texture,
    SamplerState erosion_texture_sampler) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = lerp(-edge, 1.0, erosion);
    return clamp((erosion_texture.Sample(erosion_texture_sampler, uv).r - threshold) / edge, 0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void alpha_erosion(float2 uv, inout float alpha, inout float3 normal, float2 uv_per_unit, float texel_size,
    float edge, float erosion, Texture2D erosion_texture, SamplerState erosion_texture_sampler,
    float edge_height) {
    float2 e = float2(texel_size, 0.0);
    float across = left_at(uv + e, edge, erosion, erosion_texture, erosion_texture_sampler)
        - left_at(uv - e, edge, erosion, erosion_texture, erosion_texture_sampler);
    float up = left_at(uv + e.yx, edge, erosion, erosion_texture, erosion_texture_sampler)
        - left_at(uv - e.yx, edge, erosion, erosion_texture, erosion_texture_sampler);
    float2 slope = edge_height * uv_per_unit * float2(across, up) / (2.0 * texel_size);
    normal = blend_normals(normal, normal_of_slope(slope));
    alpha *= left_at(uv, edge, erosion, erosion_texture, erosion_texture_sampler);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
float3 glow(float lobe, float through, float3 subsurface_color, float attenuation, float scale,
    float ambient) {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
float3 lobe_normalized(float3 V, float3 N, float3 L, float through, float distortion,
    float3 subsurface_color, float attenuation, float scale, float ambient, float power) {
    float3 bent = safe_normalize(L + N * distortion);
    return glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation, scale,
        ambient);
}

// The light of the surroundings that comes through, for the mean of a lobe over the directions behind the
// body.
float3 lobe_surroundings(float mean_lobe, float through, float3 irradiance_behind, float3 subsurface_color,
    float attenuation, float scale, float ambient) {
    // the light of half a sphere is 2 where the irradiance is 1
    return 2.0 * glow(mean_lobe, through, subsurface_color, attenuation, scale, ambient) * irradiance_behind;
}

// The light of the surroundings that comes through.
float3 lobe_normalized_surroundings(float through, float3 irradiance_behind, float3 subsurface_color,
    float attenuation, float scale, float ambient, float power) {
    return lobe_surroundings(1.0 / (power + 1.0), through, irradiance_behind, subsurface_color, attenuation,
        scale, ambient);
}

// The standard lighting of targets without an engine: Lambert and GGX with metallic and roughness, for one
// light.
float3 standard(float3 N, float3 V, float3 L, float3 albedo, float metallic, float roughness,
    float3 light_color) {
    float3 H = safe_normalize(V + L);
    float NoL = max(dot(N, L), 0.0);
    float NoV = max(dot(N, V), 0.0001);
    float NoH = clamp(dot(N, H), 0.0, 1.0);
    float a = max(roughness, 0.045) * max(roughness, 0.045);
    // (a^2 - 1) dot(N, H)^2 + 1, but accurate at the peak, where N and H nearly coincide; never below a^2
    float3 across = cross(N, H);
    float spread = NoH > 0.0 ? max(dot(across, across) + NoH * NoH * (a * a), a * a) : 1.0;
    // D times pi
    float facets = a * a / (spread * spread);
    // masking and shadowing, divided by 4 dot(N, L) dot(N, V)
    float visible = 0.5 / (2.0 * NoL * NoV * (1.0 - a) + (NoL + NoV) * a);
    // a surface reflects at most all light
    float3 F0 = lerp((float3)0.04, min(albedo, 1.0), metallic);
    // what reflects less than 2 % from the front is no mirror from the side
    float F90 = min(max(dot(F0, (float3)17.0), metallic), 1.0);
    float3 F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    float3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    float3 reflected = (diffuse + facets * visible * F) * NoL;
    return reflected * light_color;
}

// The values of the surface that do not depend on a light.
Surface evaluate_surface(float2 uv, float time, float3 irradiance_behind, float variation, float cell_count,
    float thickness_factor, float bevel, float attenuation_distance, float4 tint,
    Texture2D base_color_texture, SamplerState base_color_texture_sampler, float metalness,
    float surface_roughness, float relief, float2 uv_per_unit, float cover, Texture2D cover_texture,
    SamplerState cover_texture_sampler, Texture2D packed_texture, SamplerState packed_texture_sampler,
    float2 red_speed, float2 green_speed, float2 blue_speed, float3 vein_color, float3 spark_color,
    float texel_size, float edge, float erosion, Texture2D erosion_texture,
    SamplerState erosion_texture_sampler, float edge_height, float3 subsurface_color, float attenuation,
    float scale, float ambient, float power) {
    float thickness = voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel);
    float transmittance = beer_lambert(thickness, attenuation_distance);
    float3 albedo;
    float alpha;
    base_color(uv, albedo, alpha, tint, base_color_texture, base_color_texture_sampler);
    float metallic;
    float roughness;
    pbr_constants(metallic, roughness, metalness, surface_roughness);
    float3 normal = float3(0.0, 0.0, 1.0);
    voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit);
    ice_mask(uv, transmittance, cover, cover_texture, cover_texture_sampler);
    float3 emission = (float3)0.0;
    packed_scroll(uv, time, emission, packed_texture, packed_texture_sampler, red_speed, green_speed,
        blue_speed, vein_color, spark_color);
    alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        erosion_texture_sampler, edge_height);
    emission += lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color, attenuation,
        scale, ambient, power);
    Surface surface = { albedo, alpha, normal, metallic, roughness, emission, transmittance };
    return surface;
}

// The transmitted light of one light, as a factor on its colour.
float3 evaluate_translucency(Surface surface, float3 V, float3 N, float3 L, float distortion,
    float3 subsurface_color, float attenuation, float scale, float ambient, float power) {
    return lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation, scale,
        ambient, power);
}

// The reflected light of one light.
float3 evaluate_lighting(Surface surface, float3 N, float3 V, float3 L, float3 light_color) {
    return standard(N, V, L, surface.albedo, surface.metallic, surface.roughness, light_color);
}

#endif
