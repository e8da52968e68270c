// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Metal. Change the material and emit it again rather than this file.
// Entry points: vertex_main and fragment_main. Buffers: 1 camera, 2 lights, 3 object, 4 material; 0 is for the vertices.
// Compile it with fast math off (-fno-fast-math): fast math may remove guards and reorder sums.
#include <metal_stdlib>

using namespace metal;

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

constant float JITTER = 0.6;
constant float OPAQUE_DISTANCE = 1.0e-6;
constant float ENDLESS = 10000.0;
constant float OPAQUE_DEPTH = 80.0;
constant int MAX_LIGHTS = 4;

struct Material {
    float variation;  // How much the levels of the cells differ: 0 = all are equal
    float cell_count;  // Number of cells along one unit of texture coordinate
    float thickness_factor;  // Thickness of a cell of level 1
    float bevel;  // Width of the slope next to an edge, in cells
    float attenuation_distance;  // The length after which 1/e (37 %) of the light remains; 0 = opaque
    float4 tint;  // Multiplies the texture
    float metalness;  // 0 = not a metal, 1 = metal
    float surface_roughness;  // 0 = smooth as a mirror, 1 = rough as chalk
    float relief;  // Height of the thickest cells above their edges
    float2 uv_per_unit;  // Change of the texture coordinates per world unit along T and along B
    float cover;  // Multiplies the texture
    float2 red_speed;  // Velocity of the red layer
    float2 green_speed;  // Velocity of the green layer
    float2 blue_speed;  // Velocity of the blue layer
    float3 vein_color;  // Colour of the light in the red and green layers, where both are bright
    float3 spark_color;  // Colour of the light in the blue layer
    float texel_size;  // The length, in texture coordinates, over which slopes are measured: about one texel
    float edge;  // Width of the soft edge, in the texture's values
    float erosion;  // How much is eroded: 0 = nothing, 1 = everything
    float edge_height;  // Height of the step in the surface at the edge
    float distortion;  // How far the normal bends the light's direction inside the body: 0 ignores the shape
    float3 subsurface_color;  // Colour of the transmitted light
    float attenuation;  // Factor on the whole result
    float scale;  // Strength of the glow towards the light
    float ambient;  // Glow that does not depend on the direction
    float power;  // How narrow the glow around the light is: the larger, the smaller the spot
};

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
    float2 nearest = float2(4.0);
    float2 second = float2(4.0);
    // their squared lengths
    float first_square = 32.0;
    float second_square = 32.0;
    uint owner = 0u;
    // relative to the cell's corner, so that precision does not depend on the distance from the origin
    float2 home = floor(p);
    float2 within = p - home;
    for (int j = -1; j <= 1; j++) {
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
    return Cell{nearest, second, level};
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
void base_color(float2 uv, thread float3& albedo, thread float& alpha, float4 tint,
    texture2d<float> base_color_texture, sampler base_color_texture_sampler) {
    float4 texel = tint * base_color_texture.sample(base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void pbr_constants(thread float& metallic, thread float& roughness, float metalness,
    float surface_roughness) {
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
void voronoi_normal(float2 uv, thread float3& normal, float variation, float cell_count, float bevel,
    float relief, float2 uv_per_unit) {
    Cell cell = cell_at(uv * cell_count, variation);
    float x = clamp(to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    float2 slope = relief * uv_per_unit * cell_count * steepness * from_edge(cell);
    normal = blend_normals(normal, normal_of_slope(slope));
}

// Only the bare ice transmits light.
void ice_mask(float2 uv, thread float& through, float cover, texture2d<float> cover_texture,
    sampler cover_texture_sampler) {
    float covered = cover * cover_texture.sample(cover_texture_sampler, uv).r;
    through = through * smoothstep(0.0, 0.1, 1.0 - covered);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
float4 layer(float2 uv, float2 speed, float time, texture2d<float> packed_texture,
    sampler packed_texture_sampler) {
    return packed_texture.sample(packed_texture_sampler, uv + fract(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void packed_scroll(float2 uv, float time, thread float3& emission, texture2d<float> packed_texture,
    sampler packed_texture_sampler, float2 red_speed, float2 green_speed, float2 blue_speed,
    float3 vein_color, float3 spark_color) {
    float veins = layer(uv, red_speed, time, packed_texture, packed_texture_sampler).x
        * layer(uv, green_speed, time, packed_texture, packed_texture_sampler).y;
    float sparks = layer(uv, blue_speed, time, packed_texture, packed_texture_sampler).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), float3(65504.0));
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
float left_at(float2 uv, float edge, float erosion, texture2d<float> erosion_texture,
    sampler erosion_texture_sampler) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = mix(-edge, 1.0, erosion);
    return clamp((erosion_texture.sample(erosion_texture_sampler, uv).r - threshold) / edge, 0.0, 1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void alpha_erosion(float2 uv, thread float& alpha, thread float3& normal, float2 uv_per_unit,
    float texel_size, float edge, float erosion, texture2d<float> erosion_texture,
    sampler erosion_texture_sampler, float edge_height) {
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
    float3 F0 = mix(float3(0.04), min(albedo, float3(1.0)), float3(metallic));
    // what reflects less than 2 % from the front is no mirror from the side
    float F90 = min(max(dot(F0, float3(17.0)), metallic), 1.0);
    float3 F = F0 + (F90 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    float3 diffuse = albedo * (1.0 - metallic) * (1.0 - F);
    float3 reflected = (diffuse + facets * visible * F) * NoL;
    return reflected * light_color;
}

// The values of the surface that do not depend on a light.
Surface evaluate_surface(float2 uv, float time, float3 irradiance_behind, float variation, float cell_count,
    float thickness_factor, float bevel, float attenuation_distance, float4 tint,
    texture2d<float> base_color_texture, sampler base_color_texture_sampler, float metalness,
    float surface_roughness, float relief, float2 uv_per_unit, float cover, texture2d<float> cover_texture,
    sampler cover_texture_sampler, texture2d<float> packed_texture, sampler packed_texture_sampler,
    float2 red_speed, float2 green_speed, float2 blue_speed, float3 vein_color, float3 spark_color,
    float texel_size, float edge, float erosion, texture2d<float> erosion_texture,
    sampler erosion_texture_sampler, float edge_height, float3 subsurface_color, float attenuation,
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
    float3 emission = float3(0.0);
    packed_scroll(uv, time, emission, packed_texture, packed_texture_sampler, red_speed, green_speed,
        blue_speed, vein_color, spark_color);
    alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        erosion_texture_sampler, edge_height);
    emission += lobe_normalized_surroundings(transmittance, irradiance_behind, subsurface_color, attenuation,
        scale, ambient, power);
    return Surface{albedo, alpha, normal, metallic, roughness, emission, transmittance};
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

struct Camera {
    float4x4 view_projection;
    float4x4 inverse_view_projection;
    float3 position;
    float time;  // s
};

struct Lights {
    float3 ambient;
    int count;
    float4 positions[4];  // w = 1: where the light is; w = 0: the direction towards it
    float4 colors[4];
};

struct Object {
    float4x4 model;
    float4x4 inverse_model;
};

struct VertexInput {
    float3 position [[attribute(0)]];
    float3 normal [[attribute(1)]];
    float4 tangent [[attribute(2)]];  // w: handedness, +1 or -1
    float2 uv [[attribute(3)]];
};

struct Varyings {
    float4 clip_position [[position]];
    float3 position;
    float3 normal;
    float4 tangent;
    float2 uv;
};

vertex Varyings vertex_main(
    VertexInput mesh [[stage_in]],
    constant Camera& camera [[buffer(1)]],
    constant Object& object [[buffer(3)]]
) {
    Varyings output;
    float4 world_position = object.model * float4(mesh.position, 1.0);
    output.clip_position = camera.view_projection * world_position;
    output.position = world_position.xyz;
    output.normal = (float4(mesh.normal, 0.0) * object.inverse_model).xyz;
    float mirrored = sign(determinant(float3x3(object.model[0].xyz, object.model[1].xyz, object.model[2].xyz)));
    output.tangent = float4((object.model * float4(mesh.tangent.xyz, 0.0)).xyz, mesh.tangent.w * mirrored);
    output.uv = mesh.uv;
    return output;
}

fragment float4 fragment_main(
    Varyings input [[stage_in]],
    constant Camera& camera [[buffer(1)]],
    constant Lights& lights [[buffer(2)]],
    constant Material& material [[buffer(4)]],
    texture2d<float> base_color_texture [[texture(0)]],
    sampler base_color_texture_sampler [[sampler(0)]],
    texture2d<float> cover_texture [[texture(1)]],
    sampler cover_texture_sampler [[sampler(1)]],
    texture2d<float> packed_texture [[texture(2)]],
    sampler packed_texture_sampler [[sampler(2)]],
    texture2d<float> erosion_texture [[texture(3)]],
    sampler erosion_texture_sampler [[sampler(3)]]
) {
    float3 V = safe_normalize(camera.position - input.position);
    float3 N = safe_normalize(input.normal);
    float3 T = safe_normalize(input.tangent.xyz);
    float3 B = cross(N, T) * input.tangent.w;
    Surface surface = evaluate_surface(input.uv, camera.time, lights.ambient, material.variation,
        material.cell_count, material.thickness_factor, material.bevel, material.attenuation_distance,
        material.tint, base_color_texture, base_color_texture_sampler, material.metalness,
        material.surface_roughness, material.relief, material.uv_per_unit, material.cover, cover_texture,
        cover_texture_sampler, packed_texture, packed_texture_sampler, material.red_speed, material.green_speed,
        material.blue_speed, material.vein_color, material.spark_color, material.texel_size, material.edge,
        material.erosion, erosion_texture, erosion_texture_sampler, material.edge_height,
        material.subsurface_color, material.attenuation, material.scale, material.ambient, material.power);
    float3 across = T * surface.normal.x + B * surface.normal.y;
    N = safe_normalize(across + N * surface.normal.z);
    float3 color = lights.ambient * surface.albedo + surface.emission;
    for (int i = 0; i < min(lights.count, MAX_LIGHTS); i++) {
        float near = lights.positions[i].w;
        float3 to_light = lights.positions[i].xyz - input.position * near;
        float distance_squared = max(dot(to_light, to_light), 0.0001);
        float3 L = to_light * rsqrt(distance_squared);
        float3 light_color = lights.colors[i].xyz * mix(1.0, 1.0 / distance_squared, near);
        color += evaluate_lighting(surface, N, V, L, light_color);
        color += evaluate_translucency(surface, V, N, L, material.distortion, material.subsurface_color,
            material.attenuation, material.scale, material.ambient, material.power) * light_color;
    }
    if (surface.alpha < 0.5) {
        discard_fragment();
    }
    return float4(color, surface.alpha);
}
