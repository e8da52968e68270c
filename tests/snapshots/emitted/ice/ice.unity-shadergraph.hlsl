// Ice: Cracked ice in facets: back light, moving veins below the surface, a cover of snow, and holes
// that melt into it.
// Made by sssgen for Unity Shader Graph, Custom Function. Change the material and emit it again rather than this file.
// ice.unity-shadergraph.shadersubgraph has a Custom Function node of this file, with all ports connected.
// By hand: a Custom Function node of Type "File": Name Ice, Source this file, and these ports in this order.
//   uv: UV
//   P: Position, Absolute World
//   N: Normal Vector, World
//   T: Tangent Vector, World
//   B: Bitangent Vector, World
//   V: View Direction, World
//   time: Time
// The rest are properties of the graph. The _half entry has the same ports and computes in float.
#ifndef ICE_UNITY_SHADERGRAPH_INCLUDED
#define ICE_UNITY_SHADERGRAPH_INCLUDED

struct ice_Cell {
    float2 nearest;
    float2 second;
    float level;
};

struct ice_Surface {
    float3 albedo;
    float alpha;
    float3 normal;
    float metallic;
    float roughness;
    float3 emission;
    float transmittance;
};

static const float ice_JITTER = 0.6;
static const float ice_OPAQUE_DISTANCE = 1.0e-6;
static const float ice_ENDLESS = 10000.0;
static const float ice_OPAQUE_DEPTH = 80.0;

// The direction of `x`; of a zero vector, 0.
float2 ice_safe_normalize(float2 x) {
    return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
}

// The direction of `x`; of a zero vector, 0.
float3 ice_safe_normalize(float3 x) {
    return x * (dot(x, x) > 1.0e-30 ? rsqrt(dot(x, x)) : 0.0);
}

// Scrambles the bits of `x`; 0 stays 0.
uint ice_hash_bits(uint x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A number in [0, 1) from 24 bits of the hash of `x`.
float ice_hash_unit(uint x) {
    return float(ice_hash_bits(x) >> 8u) * 5.9604645e-8;
}

// The cell at `p`.
ice_Cell ice_cell_at(float2 p, float variation) {
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
            uint seed = ice_hash_bits(uint(int(corner.x)) + ice_hash_bits(uint(int(corner.y)) + 1u));
            float2 shift = float2(ice_hash_unit(seed + 1u), ice_hash_unit(seed + 2u)) - 0.5;
            float2 to_site = offset + 0.5 + ice_JITTER * shift - within;
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
    float level = 1.0 - variation * ice_hash_unit(owner + 3u);
    ice_Cell cell = { nearest, second, level };
    return cell;
}

// How much farther the second nearest site is than the nearest one: 0 on the edges.
float ice_to_edge(ice_Cell cell) {
    return length(cell.second) - length(cell.nearest);
}

// Thickness in Voronoi cells: facets with thin edges between them, as in cracked ice.
float ice_voronoi_thickness(float2 uv, float variation, float cell_count, float thickness_factor,
    float bevel) {
    ice_Cell cell = ice_cell_at(uv * cell_count, variation);
    return thickness_factor * cell.level * smoothstep(0.0, bevel, ice_to_edge(cell));
}

// The thickness `d` in mean free paths, 0 or more.
float ice_optical_depth(float d, float mean_free_path) {
    float path = max(mean_free_path, ice_OPAQUE_DISTANCE);
    return clamp(d, 0.0, ice_ENDLESS * path) / path;
}

// Thickness to transmittance: the part of the light that absorption leaves.
float ice_beer_lambert(float d, float attenuation_distance) {
    return exp(-min(ice_optical_depth(d, attenuation_distance), ice_OPAQUE_DEPTH));
}

// Colour and opacity from a texture and a tint.
void ice_base_color(float2 uv, out float3 albedo, out float alpha, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler) {
    float4 texel = tint * SAMPLE_TEXTURE2D(base_color_texture, base_color_texture_sampler, uv);
    albedo = texel.xyz;
    alpha = texel.w;
}

// The same metalness and roughness everywhere.
void ice_pbr_constants(out float metallic, out float roughness, float metalness, float surface_roughness) {
    metallic = metalness;
    roughness = surface_roughness;
}

// The gradient of to_edge.
float2 ice_from_edge(ice_Cell cell) {
    // the nearest site may be exactly here, the second one cannot: they are at least 0.4 apart
    return ice_safe_normalize(cell.nearest) - normalize(cell.second);
}

// Adds `detail` to `base`: x and y are added, z is multiplied; for small slopes this adds the slopes.
float3 ice_blend_normals(float3 base, float3 detail) {
    return ice_safe_normalize(float3(base.xy + detail.xy, base.z * detail.z));
}

// The normal of a height field; `slope` is the increase in height per unit of length along T and B.
float3 ice_normal_of_slope(float2 slope) {
    return normalize(float3(-slope, 1.0));
}

// The normal of the Voronoi cells, so that reflected light agrees with transmitted light.
void ice_voronoi_normal(float2 uv, inout float3 normal, float variation, float cell_count, float bevel,
    float relief, float2 uv_per_unit) {
    ice_Cell cell = ice_cell_at(uv * cell_count, variation);
    float x = clamp(ice_to_edge(cell) / bevel, 0.0, 1.0);
    // the derivative of the smoothstep
    float steepness = cell.level * 6.0 * x * (1.0 - x) / bevel;
    float2 slope = relief * uv_per_unit * cell_count * steepness * ice_from_edge(cell);
    normal = ice_blend_normals(normal, ice_normal_of_slope(slope));
}

// Only the bare ice transmits light.
void ice_ice_mask(float2 uv, inout float through, float cover, UnityTexture2D cover_texture,
    UnitySamplerState cover_texture_sampler) {
    float covered = cover * SAMPLE_TEXTURE2D(cover_texture, cover_texture_sampler, uv).r;
    through = through * smoothstep(0.0, 0.1, 1.0 - covered);
}

// One moving layer; the offset stays below 1, so that precision does not decrease with time.
float4 ice_layer(float2 uv, float2 speed, float time, UnityTexture2D packed_texture,
    UnitySamplerState packed_texture_sampler) {
    return SAMPLE_TEXTURE2D(packed_texture, packed_texture_sampler, uv + frac(speed * time));
}

// Moving light below the surface, from the channels of one texture, each of which scrolls separately.
void ice_packed_scroll(float2 uv, float time, inout float3 emission, UnityTexture2D packed_texture,
    UnitySamplerState packed_texture_sampler, float2 red_speed, float2 green_speed, float2 blue_speed,
    float3 vein_color, float3 spark_color) {
    float veins = ice_layer(uv, red_speed, time, packed_texture, packed_texture_sampler).x
        * ice_layer(uv, green_speed, time, packed_texture, packed_texture_sampler).y;
    float sparks = ice_layer(uv, blue_speed, time, packed_texture, packed_texture_sampler).z;
    emission = min(emission + (vein_color * veins + spark_color * sparks), 65504.0);
}

// The part of the surface that remains at `uv`: 1 = all, 0 = none.
float ice_left_at(float2 uv, float edge, float erosion, UnityTexture2D erosion_texture,
    UnitySamplerState erosion_texture_sampler) {
    // the threshold goes from below black to white, so that erosion 0 keeps and erosion 1 removes everything
    float threshold = lerp(-edge, 1.0, erosion);
    return clamp((SAMPLE_TEXTURE2D(erosion_texture, erosion_texture_sampler, uv).r - threshold) / edge, 0.0,
        1.0);
}

// Erodes the surface, dark parts of a mask first, with a bevelled normal at the edge.
void ice_alpha_erosion(float2 uv, inout float alpha, inout float3 normal, float2 uv_per_unit,
    float texel_size, float edge, float erosion, UnityTexture2D erosion_texture,
    UnitySamplerState erosion_texture_sampler, float edge_height) {
    float2 e = float2(texel_size, 0.0);
    float across = ice_left_at(uv + e, edge, erosion, erosion_texture, erosion_texture_sampler)
        - ice_left_at(uv - e, edge, erosion, erosion_texture, erosion_texture_sampler);
    float up = ice_left_at(uv + e.yx, edge, erosion, erosion_texture, erosion_texture_sampler)
        - ice_left_at(uv - e.yx, edge, erosion, erosion_texture, erosion_texture_sampler);
    float2 slope = edge_height * uv_per_unit * float2(across, up) / (2.0 * texel_size);
    normal = ice_blend_normals(normal, ice_normal_of_slope(slope));
    alpha *= ice_left_at(uv, edge, erosion, erosion_texture, erosion_texture_sampler);
}

// The transmitted light for a lobe value of 0..1 and a transmittance.
float3 ice_glow(float lobe, float through, float3 subsurface_color, float attenuation, float scale,
    float ambient) {
    return subsurface_color * (attenuation * (lobe * scale + ambient) * through);
}

// The back-light lobe with a unit half vector: the lobe of Alisavakis and Unity ice, corrected.
float3 ice_lobe_normalized(float3 V, float3 N, float3 L, float through, float distortion,
    float3 subsurface_color, float attenuation, float scale, float ambient, float power) {
    float3 bent = ice_safe_normalize(L + N * distortion);
    return ice_glow(pow(clamp(dot(V, -bent), 0.0, 1.0), power), through, subsurface_color, attenuation,
        scale, ambient);
}

// The values of the surface that do not depend on a light.
ice_Surface ice_evaluate_surface(float2 uv, float time, float variation, float cell_count,
    float thickness_factor, float bevel, float attenuation_distance, float4 tint,
    UnityTexture2D base_color_texture, UnitySamplerState base_color_texture_sampler, float metalness,
    float surface_roughness, float relief, float2 uv_per_unit, float cover, UnityTexture2D cover_texture,
    UnitySamplerState cover_texture_sampler, UnityTexture2D packed_texture,
    UnitySamplerState packed_texture_sampler, float2 red_speed, float2 green_speed, float2 blue_speed,
    float3 vein_color, float3 spark_color, float texel_size, float edge, float erosion,
    UnityTexture2D erosion_texture, UnitySamplerState erosion_texture_sampler, float edge_height) {
    float thickness = ice_voronoi_thickness(uv, variation, cell_count, thickness_factor, bevel);
    float transmittance = ice_beer_lambert(thickness, attenuation_distance);
    float3 albedo;
    float alpha;
    ice_base_color(uv, albedo, alpha, tint, base_color_texture, base_color_texture_sampler);
    float metallic;
    float roughness;
    ice_pbr_constants(metallic, roughness, metalness, surface_roughness);
    float3 normal = float3(0.0, 0.0, 1.0);
    ice_voronoi_normal(uv, normal, variation, cell_count, bevel, relief, uv_per_unit);
    ice_ice_mask(uv, transmittance, cover, cover_texture, cover_texture_sampler);
    float3 emission = (float3)0.0;
    ice_packed_scroll(uv, time, emission, packed_texture, packed_texture_sampler, red_speed, green_speed,
        blue_speed, vein_color, spark_color);
    ice_alpha_erosion(uv, alpha, normal, uv_per_unit, texel_size, edge, erosion, erosion_texture,
        erosion_texture_sampler, edge_height);
    ice_Surface surface = { albedo, alpha, normal, metallic, roughness, emission, transmittance };
    return surface;
}

// The transmitted light of one light, as a factor on its colour.
float3 ice_evaluate_translucency(ice_Surface surface, float3 V, float3 N, float3 L, float distortion,
    float3 subsurface_color, float attenuation, float scale, float ambient, float power) {
    return ice_lobe_normalized(V, N, L, surface.transmittance, distortion, subsurface_color, attenuation,
        scale, ambient, power);
}

#ifndef SSSGEN_IN_LAYERS
#define SSSGEN_IN_LAYERS
// 1 for a light of the object's rendering layers, else 0.
float in_layers(uint light_layers) {
#if defined(_LIGHT_LAYERS)
#if UNITY_VERSION >= 202220
    uint layers = GetMeshRenderingLayer();
#else
    uint layers = GetMeshRenderingLightLayer();
#endif
    return IsMatchingLightLayer(light_layers, layers) ? 1.0 : 0.0;
#else
    return 1.0;
#endif
}
#endif

void Ice_float(
    float2 uv,
    float3 P,
    float3 N,
    float3 T,
    float3 B,
    float3 V,
    float time,
    float variation,
    float cell_count,
    float thickness_factor,
    float bevel,
    float attenuation_distance,
    float4 tint,
    float metalness,
    float surface_roughness,
    float relief,
    float2 uv_per_unit,
    float cover,
    float2 red_speed,
    float2 green_speed,
    float2 blue_speed,
    float3 vein_color,
    float3 spark_color,
    float texel_size,
    float edge,
    float erosion,
    float edge_height,
    float distortion,
    float3 subsurface_color,
    float attenuation,
    float scale,
    float ambient,
    float power,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    UnityTexture2D cover_texture,
    UnitySamplerState cover_texture_sampler,
    UnityTexture2D packed_texture,
    UnitySamplerState packed_texture_sampler,
    UnityTexture2D erosion_texture,
    UnitySamplerState erosion_texture_sampler,
    out float3 BaseColor,
    out float3 NormalTS,
    out float Metallic,
    out float Smoothness,
    out float Occlusion,
    out float3 Emission,
    out float Alpha,
    out float Transmittance) {
    V = ice_safe_normalize(V);
    N = ice_safe_normalize(N);
    ice_Surface surface = ice_evaluate_surface(uv, time, variation, cell_count, thickness_factor, bevel,
            attenuation_distance, tint, base_color_texture, base_color_texture_sampler,
            metalness, surface_roughness, relief, uv_per_unit, cover, cover_texture,
            cover_texture_sampler, packed_texture, packed_texture_sampler, red_speed,
            green_speed, blue_speed, vein_color, spark_color, texel_size, edge, erosion,
            erosion_texture, erosion_texture_sampler, edge_height);
    BaseColor = surface.albedo;
    Alpha = surface.alpha;
    NormalTS = surface.normal;
    Smoothness = 1.0 - surface.roughness;
    Occlusion = 1.0;
    Emission = surface.emission;
    Metallic = surface.metallic;
    Transmittance = surface.transmittance;

    // Goes to Emission, and in URP only: in HDRP a graph does not see lights.
    N = ice_safe_normalize(T * surface.normal.x + B * surface.normal.y + N * surface.normal.z);
#if defined(SHADERGRAPH_PREVIEW)
    float3 light_color = 1.0;
    float3 L = normalize(float3(0.5, 0.5, -0.5));
    Emission += ice_evaluate_translucency(surface, V, N, L, distortion, subsurface_color,
            attenuation, scale, ambient, power) * light_color;
#elif defined(UNIVERSAL_LIGHTING_INCLUDED)
    InputData inputData = (InputData)0;
    inputData.positionWS = P;
    inputData.normalizedScreenSpaceUV = ComputeNormalizedDeviceCoordinates(P, GetWorldToHClipMatrix());
    // Without the object's own shadow: light that comes through entered on the far side.
    Light light = GetMainLight(TransformWorldToShadowCoord(P), P, half4(1.0, 1.0, 1.0, 1.0));  // with its cookie
    float3 light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
    float3 L = light.direction;
    Emission += ice_evaluate_translucency(surface, V, N, L, distortion, subsurface_color,
                attenuation, scale, ambient, power) * light_color;
#if defined(_ADDITIONAL_LIGHTS)
#if USE_CLUSTER_LIGHT_LOOP || USE_FORWARD_PLUS || USE_CLUSTERED_LIGHTING
    // The loop below has the lights near this part of the screen; directional ones come first in the array.
#if USE_CLUSTERED_LIGHTING
    uint directional_count = min(_AdditionalLightsDirectionalCount, MAX_VISIBLE_LIGHTS);
#else
    uint directional_count = min(URP_FP_DIRECTIONAL_LIGHTS_COUNT, MAX_VISIBLE_LIGHTS);
#endif
    for (uint number = 0u; number < directional_count; number++) {
        light = GetAdditionalLight(number, P, half4(1.0, 1.0, 1.0, 1.0));
        light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
        L = light.direction;
        Emission += ice_evaluate_translucency(surface, V, N, L, distortion, subsurface_color,
                    attenuation, scale, ambient, power) * light_color;
    }
#endif
    uint light_count = GetAdditionalLightsCount();
    LIGHT_LOOP_BEGIN(light_count)
        light = GetAdditionalLight(lightIndex, P, half4(1.0, 1.0, 1.0, 1.0));
        light_color = light.color * (light.distanceAttenuation * in_layers(light.layerMask));
        L = light.direction;
        Emission += ice_evaluate_translucency(surface, V, N, L, distortion, subsurface_color,
                    attenuation, scale, ambient, power) * light_color;
    LIGHT_LOOP_END
#endif
#endif
}

void Ice_half(
    half2 uv,
    half3 P,
    half3 N,
    half3 T,
    half3 B,
    half3 V,
    half time,
    half variation,
    half cell_count,
    half thickness_factor,
    half bevel,
    half attenuation_distance,
    half4 tint,
    half metalness,
    half surface_roughness,
    half relief,
    half2 uv_per_unit,
    half cover,
    half2 red_speed,
    half2 green_speed,
    half2 blue_speed,
    half3 vein_color,
    half3 spark_color,
    half texel_size,
    half edge,
    half erosion,
    half edge_height,
    half distortion,
    half3 subsurface_color,
    half attenuation,
    half scale,
    half ambient,
    half power,
    UnityTexture2D base_color_texture,
    UnitySamplerState base_color_texture_sampler,
    UnityTexture2D cover_texture,
    UnitySamplerState cover_texture_sampler,
    UnityTexture2D packed_texture,
    UnitySamplerState packed_texture_sampler,
    UnityTexture2D erosion_texture,
    UnitySamplerState erosion_texture_sampler,
    out half3 BaseColor,
    out half3 NormalTS,
    out half Metallic,
    out half Smoothness,
    out half Occlusion,
    out half3 Emission,
    out half Alpha,
    out half Transmittance) {
    Ice_float(uv, P, N, T, B, V, time, variation, cell_count, thickness_factor, bevel, attenuation_distance, tint, metalness, surface_roughness, relief, uv_per_unit, cover, red_speed, green_speed, blue_speed, vein_color, spark_color, texel_size, edge, erosion, edge_height, distortion, subsurface_color, attenuation, scale, ambient, power, base_color_texture, base_color_texture_sampler, cover_texture, cover_texture_sampler, packed_texture, packed_texture_sampler, erosion_texture, erosion_texture_sampler, BaseColor, NormalTS, Metallic, Smoothness, Occlusion, Emission, Alpha, Transmittance);
}

#endif
